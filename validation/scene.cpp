#include <signorini/validation/input_error.h>
#include <signorini/validation/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <stdexcept>

namespace signorini::validation {
namespace {

bool can_touch(const Scene& scene, const collision::Collider& a, const collision::Collider& b) {
  if (a.body == b.body) return false;
  if (!scene.bodies[a.body].is_dynamic() && !scene.bodies[b.body].is_dynamic()) return false;
  return !std::binary_search(scene.never_collide.begin(), scene.never_collide.end(),
                             std::minmax({a.body, b.body}));
}

void require(bool good, const Scene& scene, const std::string& what) {
  if (!good) throw InputError(scene.source + ": " + what);
}

std::string text_of(const Material& material) {
  std::string text =
      fmt::format("friction {}, restitution {}", material.friction, material.restitution);
  if (material.friction_ratio != 1.0) {
    text += fmt::format(", friction {} across fdir1 (Bullet: {} in every direction)",
                        material.friction * material.friction_ratio, material.friction);
  }
  if (material.resists_turning()) {
    text += fmt::format(", rolling friction {} m, spinning friction {} m",
                        material.rolling_friction, material.spinning_friction);
  }
  return text;
}

}  // namespace

std::span<const std::string_view> scene_kinds() {
  static constexpr std::array<std::string_view, 4> kKinds = {"stands", "slides", "bounces", "free"};
  return kKinds;
}

long Scene::step_count() const {
  return std::max(1L, std::lround(duration / step));
}

int Scene::body(const std::string& body_name) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].name == body_name) return static_cast<int>(i);
  }
  throw std::out_of_range("scene " + name + ": no body '" + body_name + "'");
}

void validate(const Scene& scene) {
  require(std::isfinite(scene.step) && scene.step > 0.0, scene,
          fmt::format("<max_step_size>: must be finite and > 0 s, got {}", scene.step));
  require(std::isfinite(scene.duration) && scene.duration > 0.0, scene,
          fmt::format("duration: must be finite and > 0 s, got {}", scene.duration));
  require(scene.gravity.allFinite(), scene, "<gravity>: must be finite");
  require(scene.stepper == Stepper::kTime || scene.joints.empty(), scene,
          "<signorini:stepper>: the event-driven stepper takes no joints");
  try {
    for (const Body& body : scene.bodies) signorini::validate(body);
    signorini::validate(scene.bodies, scene.state);
    signorini::validate(scene.joints, scene.bodies);
    const int count = static_cast<int>(scene.bodies.size());
    for (const collision::Collider& collider : scene.colliders) {
      collision::validate(collider, count);
    }
  } catch (const std::invalid_argument& error) {
    throw InputError(scene.source + ": " + error.what());
  }
}

std::vector<std::string> describe_pairs(const Scene& scene) {
  // Distinct values, each with its first pair and how many others share it.
  struct Use {
    std::string first;
    int count = 0;
  };
  std::map<std::string, Use> uses;
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    for (std::size_t j = i + 1; j < scene.colliders.size(); ++j) {
      const collision::Collider& a = scene.colliders[i];
      const collision::Collider& b = scene.colliders[j];
      if (!can_touch(scene, a, b)) continue;
      const Material material = pair(a.material, b.material, scene.rule);
      Use& use = uses[text_of(material)];
      if (use.count++ == 0) use.first = a.name + " / " + b.name;
    }
  }
  std::vector<std::string> lines;
  for (const auto& [values, use] : uses) {
    const std::string more = use.count > 1 ? fmt::format(", and {} more pairs", use.count - 1) : "";
    lines.push_back(fmt::format("pair {} ({}{})", values, use.first, more));
  }
  return lines;
}

std::string to_string(PairingRule rule) {
  switch (rule) {
    case PairingRule::kMultiply: return "multiply";
    case PairingRule::kMinimum: return "minimum";
    case PairingRule::kMaximum: return "maximum";
    case PairingRule::kMean: return "mean";
  }
  throw std::invalid_argument("pairing rule: not one of the four rules");
}

std::string to_string(Stepper stepper) {
  switch (stepper) {
    case Stepper::kTime: return "time-stepping";
    case Stepper::kEvents: return "event-driven";
  }
  throw std::invalid_argument("stepper: not one of the two");
}

}  // namespace signorini::validation
