#include <signorini/core/model/body.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_joints.h>
#include <signorini/validation/sdf_survey.h>
#include <signorini/validation/xml_check.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <sdf/Param.hh>
#include <stdexcept>
#include <string_view>

namespace signorini::validation {
namespace {

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 21> kWithoutPhysics = {"visual",
                                                              "sensor",
                                                              "plugin",
                                                              "gui",
                                                              "light",
                                                              "scene",
                                                              "state",
                                                              "audio",
                                                              "actor",
                                                              "atmosphere",
                                                              "road",
                                                              "projector",
                                                              "magnetic_field",
                                                              "frame",
                                                              "spherical_coordinates",
                                                              "battery",
                                                              "laser_retro",
                                                              "audio_source",
                                                              "audio_sink",
                                                              "particle_emitter",
                                                              "real_time_update_rate"};

/// Containers whose children are walked.
constexpr std::array<std::string_view, 14> kStructure = {
    "sdf",     "world",    "model",    "link",  "collision", "surface", "bounce",
    "physics", "friction", "inertial", "joint", "axis",      "limit",   "dynamics"};

/// Used by the reader, or without meaning for a single run.
constexpr std::array<std::string_view, 16> kUsed = {"pose",
                                                    "static",
                                                    "gravity",
                                                    "max_step_size",
                                                    "self_collide",
                                                    "mu",
                                                    "mu2",
                                                    "fdir1",
                                                    "mass",
                                                    "inertia",
                                                    "restitution_coefficient",
                                                    "name",
                                                    "geometry",
                                                    "density",
                                                    "real_time_factor",
                                                    "allow_auto_disable"};

/// Of joints: read by sdf_joints.h, which says what it leaves out.
constexpr std::array<std::string_view, 7> kUsedOfJoints = {
    "parent", "child", "xyz", "lower", "upper", "damping", "spring_stiffness"};

constexpr std::array<std::string_view, 8> kWorldExtensions = {
    "signorini:title",       "signorini:description", "signorini:duration", "signorini:pairing",
    "signorini:error_scale", "signorini:error",       "signorini:kind",     "signorini:stepper"};
constexpr std::array<std::string_view, 2> kLinkExtensions = {"signorini:linear_velocity",
                                                             "signorini:angular_velocity"};

std::string parent_name(const sdf::Element& element) {
  return element.GetParent() == nullptr ? "" : element.GetParent()->GetName();
}

bool has_default_value(const sdf::Element& element) {
  const sdf::ParamPtr value = element.GetValue();
  return value == nullptr || value->GetAsString() == value->GetDefaultAsString();
}

/// Read, though what they are in is not.
bool is_used_below_an_unused(const sdf::Element& element) {
  const std::string& name = element.GetName();
  const std::string parent = parent_name(element);
  return name == "collide_bitmask" || (name == "rolling_friction" && parent == "bullet") ||
         (parent == "torsional" && (name == "coefficient" || name == "patch_radius" ||
                                    (name == "use_patch_radius" && element.Get<bool>())));
}

/// "surface/contact/ode/kp": from the nearest named element down.
std::string path_of(const sdf::Element& element) {
  std::string path = element.GetName();
  for (sdf::ElementPtr up = element.GetParent(); up != nullptr; up = up->GetParent()) {
    const std::string& name = up->GetName();
    if (name == "collision" || name == "link" || name == "model" || name == "world") break;
    path = name + "/" + path;
  }
  return path;
}

bool is_in_static_model(const sdf::Element& element) {
  for (sdf::ElementPtr up = element.GetParent(); up != nullptr; up = up->GetParent()) {
    if (up->GetName() == "model" && up->Get<bool>("static", false).first) return true;
  }
  return false;
}

std::string text(double value) {
  return fmt::format("{:g}", value);
}

}  // namespace

void SdfSurvey::walk(const sdf::ElementPtr& element) {
  const std::string& name = element->GetName();
  if (const std::string reason = unsupported(element); !reason.empty()) {
    const std::string what = locate(*element) + ": " + reason;
    if (!skip_unsupported_) throw InputError(what);
    skipped_.push_back("skipped: " + what);
    if (name == "collision") links_with_skips_.push_back(locate(*element->GetParent()));
    element->RemoveFromParent();
    return;
  }
  if (contains(kWithoutPhysics, name)) {
    if (name != "frame") ++without_physics_[name];
    return;
  }
  const std::string parent = parent_name(*element);
  if (name.starts_with("signorini:")) {
    const bool known = (parent == "world" && contains(kWorldExtensions, name)) ||
                       (parent == "link" && contains(kLinkExtensions, name));
    if (!known) {
      throw InputError(fmt::format("{}: <{}>: not an element that <{}> can have", locate(*element),
                                   name, parent));
    }
    return;
  }
  if (name == "inertial") check_inertial(element);
  if (name == "ode" && parent == "friction") check_friction(element);
  if (contains(kStructure, name) || (name == "ode" && parent == "friction")) {
    walk_children(element);
  } else if (!contains(kUsed, name) && !contains(kUsedOfJoints, name)) {
    mention_ignored(element);
  }
}

void SdfSurvey::walk_children(const sdf::ElementPtr& element) {
  for (sdf::ElementPtr child = element->GetFirstElement(); child != nullptr;) {
    const sdf::ElementPtr next = child->GetNextElement("");
    if (child->GetExplicitlySetInFile()) walk(child);
    child = next;
  }
}

void SdfSurvey::mention_ignored(const sdf::ElementPtr& element) {
  if (element->GetFirstElement() == nullptr) {
    if (element->GetValue() == nullptr || has_default_value(*element)) return;
    if (is_used_below_an_unused(*element)) return;
    Mention& mention = ignored_physics_[path_of(*element)];
    if (mention.count++ == 0) mention.first = locate(*element);
    return;
  }
  for (sdf::ElementPtr child = element->GetFirstElement(); child != nullptr;
       child = child->GetNextElement("")) {
    if (child->GetExplicitlySetInFile()) mention_ignored(child);
  }
}

std::string SdfSurvey::unsupported(const sdf::ElementPtr& element) const {
  const std::string& name = element->GetName();
  const std::string parent = parent_name(*element);
  if (name == "collision") {
    const sdf::ElementPtr geometry = element->FindElement("geometry");
    const sdf::ElementPtr shape = geometry == nullptr ? nullptr : geometry->GetFirstElement();
    const std::string kind = shape == nullptr ? "empty" : shape->GetName();
    if (kind == "plane" && !is_in_static_model(*element)) {
      return "collision shape <plane> is supported in static models only";
    }
    if (const std::string reason = unsupported_shape(kind, SceneFormat::kSdf); !reason.empty()) {
      return reason;
    }
  }
  if (name == "joint") {
    return unsupported_joint(
        element->HasAttribute("type") ? element->GetAttribute("type")->GetAsString() : "");
  }
  if (name == "gripper" || name == "population") {
    return fmt::format("<{}> is not supported", name);
  }
  if (name == "kinematic" && parent == "link" && element->Get<bool>()) {
    return "<kinematic>true</kinematic> is not supported";
  }
  return "";
}

void SdfSurvey::check_inertial(const sdf::ElementPtr& inertial) const {
  Body body;
  body.mass = inertial->Get<double>("mass", 1.0).first;
  if (const sdf::ElementPtr inertia = inertial->FindElement("inertia"); inertia != nullptr) {
    const auto entry = [&](const char* key, double otherwise) {
      return inertia->Get<double>(key, otherwise).first;
    };
    const double ixy = entry("ixy", 0.0);
    const double ixz = entry("ixz", 0.0);
    const double iyz = entry("iyz", 0.0);
    body.inertia << entry("ixx", 1.0), ixy, ixz, ixy, entry("iyy", 1.0), iyz, ixz, iyz,
        entry("izz", 1.0);
  }
  try {
    validate(body);
  } catch (const std::invalid_argument& error) {
    throw InputError(locate(*inertial) + ": <inertial>: " + error.what());
  }
}

bool is_anisotropic(const sdf::Element& ode) {
  const double mu = ode.Get<double>("mu", 1.0).first;
  const double mu2 = ode.Get<double>("mu2", 1.0).first;
  const auto direction = ode.Get<ignition::math::Vector3d>("fdir1", {}).first;
  return mu != mu2 && mu > 0.0 && mu2 > 0.0 && direction.Length() > 0.0;
}

void SdfSurvey::check_friction(const sdf::ElementPtr& ode) {
  const double mu = ode->Get<double>("mu", 1.0).first;
  const double mu2 = ode->Get<double>("mu2", 1.0).first;
  if (mu == mu2 || is_anisotropic(*ode)) return;
  Mention& mention = ignored_physics_[fmt::format(
      "surface/friction/ode/mu2 = {} beside mu = {} (without fdir1, or with a 0, friction is "
      "isotropic, mu)",
      text(mu2), text(mu))];
  if (mention.count++ == 0) mention.first = locate(*ode);
}

bool SdfSurvey::was_emptied(const sdf::Element& link) const {
  if (link.FindElement("collision") != nullptr) return false;
  return std::find(links_with_skips_.begin(), links_with_skips_.end(), locate(link)) !=
         links_with_skips_.end();
}

std::vector<std::string> SdfSurvey::notices() const {
  std::vector<std::string> lines = skipped_;
  std::string line;
  for (const auto& [name, count] : without_physics_) {
    line += fmt::format("{}{} ({})", line.empty() ? "" : ", ", name, count);
  }
  if (!line.empty()) lines.push_back("ignored, without effect on the motion: " + line);
  line.clear();
  for (const auto& [path, mention] : ignored_physics_) {
    line += fmt::format("{}{} ({}x, first at {})", line.empty() ? "" : "; ", path, mention.count,
                        mention.first);
  }
  if (!line.empty()) lines.push_back("ignored physics: " + line);
  return lines;
}

std::string SdfSurvey::path(const sdf::Element& element) {
  std::string path;
  const auto add = [&path](const sdf::Element& part) {
    const std::string& kind = part.GetName();
    if (!part.HasAttribute("name")) return;
    if (kind != "model" && kind != "link" && kind != "collision" && kind != "joint") return;
    path = fmt::format("{} '{}'{}{}", kind, part.GetAttribute("name")->GetAsString(),
                       path.empty() ? "" : ", ", path);
  };
  add(element);
  for (sdf::ElementPtr up = element.GetParent(); up != nullptr; up = up->GetParent()) add(*up);
  return path;
}

std::string SdfSurvey::locate(const sdf::Element& element) const {
  const std::string path = SdfSurvey::path(element);
  // Text that came from no file has libsdformat's own name for it.
  const bool in_file = !element.FilePath().empty() && !element.FilePath().starts_with('<');
  const std::string file = in_file ? element.FilePath() : source_;
  const std::string line =
      element.LineNumber().has_value() ? fmt::format(":{}", *element.LineNumber()) : "";
  return fmt::format("{}{}{}{}", file, line, path.empty() ? "" : ": ", path);
}

}  // namespace signorini::validation
