#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_joints.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <optional>
#include <sdf/Joint.hh>
#include <sdf/JointAxis.hh>

namespace signorini::validation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoLimit = 1e16;  // SDFormat's default
constexpr const char* kWorldBody = "world";

Vec3 vector(const ignition::math::Vector3d& v) {
  return {v.X(), v.Y(), v.Z()};
}

JointKind kind_of(sdf::JointType type) {
  switch (type) {
    case sdf::JointType::BALL: return JointKind::kBall;
    case sdf::JointType::PRISMATIC: return JointKind::kSlider;
    case sdf::JointType::FIXED: return JointKind::kFixed;
    default: return JointKind::kHinge;
  }
}

/// The joints of one model.
class JointReader {
 public:
  JointReader(const sdf::Model& model, const Pose& model_pose, const std::string& name,
              const BodyOfLink& body_of_link, const SdfSurvey& survey, Scene& scene)
      : model_(model),
        model_pose_(model_pose),
        name_(name),
        body_of_link_(body_of_link),
        survey_(survey),
        scene_(scene) {}

  void read() {
    for (std::uint64_t i = 0; i < model_.JointCount(); ++i) read(*model_.JointByIndex(i));
  }

 private:
  void require(const sdf::Errors& errors, const std::string& field, const sdf::Joint& joint) const {
    if (errors.empty()) return;
    throw InputError(
        fmt::format("{}: {}: {}", survey_.locate(*joint.Element()), field, errors[0].Message()));
  }

  void notice(const sdf::Joint& joint, const std::string& text) {
    scene_.notices.push_back(survey_.locate(*joint.Element()) + ": " + text);
  }

  int world_body() {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      if (scene_.bodies[i].kind == BodyKind::kFixed && scene_.bodies[i].name == kWorldBody) {
        return static_cast<int>(i);
      }
    }
    Body body;
    body.kind = BodyKind::kFixed;
    body.name = kWorldBody;
    scene_.bodies.push_back(body);
    scene_.state.emplace_back();
    return static_cast<int>(scene_.bodies.size()) - 1;
  }

  /// @return nothing if the link was left out.
  std::optional<int> body_of(const std::string& link) {
    if (link == "world") return world_body();
    const auto found = body_of_link_.find(name_ + "::" + link);
    if (found == body_of_link_.end()) return std::nullopt;
    return found->second;
  }

  void read(const sdf::Joint& joint) {
    std::string child, parent;
    require(joint.ResolveChildLink(child), "<child>", joint);
    require(joint.ResolveParentLink(parent), "<parent>", joint);
    const std::optional<int> a = body_of(child);
    const std::optional<int> b = body_of(parent);
    if (!a || !b) {
      notice(joint, fmt::format("left out: link '{}' was left out", a ? parent : child));
      return;
    }
    if (!scene_.bodies[*a].is_dynamic() && !scene_.bodies[*b].is_dynamic()) {
      notice(joint, "left out: both bodies are fixed");
      return;
    }
    add(joint, *a, *b);
  }

  void add(const sdf::Joint& joint, int a, int b) {
    ignition::math::Pose3d raw;
    require(joint.SemanticPose().Resolve(raw, "__model__"), "<pose>", joint);
    const JointKind kind = kind_of(joint.Type());
    const sdf::JointAxis* axis = joint.Axis(0);
    Vec3 direction = Vec3::UnitZ();
    if (axis != nullptr) {
      ignition::math::Vector3d xyz;
      require(axis->ResolveXyz(xyz, "__model__"), "<axis><xyz>", joint);
      direction = model_pose_.orientation * vector(xyz);
    }
    try {
      Joint made = joint_at(kind, a, b, scene_.state, model_pose_ * vector(raw.Pos()), direction);
      made.name = name_ + "::" + joint.Name();
      if (axis != nullptr && made.has_coordinate()) {
        set_limits(joint, *axis, made);
        set_dynamics(joint, *axis, made);
      }
      signorini::validate({made}, scene_.bodies);
      scene_.joints.push_back(made);
    } catch (const std::invalid_argument& error) {
      throw InputError(survey_.locate(*joint.Element()) + ": " + error.what());
    }
    const std::pair<int, int> pair = std::minmax(a, b);
    if (std::find(scene_.never_collide.begin(), scene_.never_collide.end(), pair) ==
        scene_.never_collide.end()) {
      scene_.never_collide.push_back(pair);
    }
  }

  void set_limits(const sdf::Joint& joint, const sdf::JointAxis& axis, Joint& made) {
    if (joint.Type() == sdf::JointType::CONTINUOUS) return;
    const double lower = axis.Lower() <= -kNoLimit ? -kInfinity : axis.Lower();
    const double upper = axis.Upper() >= kNoLimit ? kInfinity : axis.Upper();
    const bool any = std::isfinite(lower) || std::isfinite(upper);
    if (made.kind == JointKind::kHinge && any && upper - lower >= 2.0 * std::numbers::pi) {
      notice(joint, fmt::format("<limit> {:g} .. {:g} rad left out: a hinge's angle is known up to "
                                "whole turns",
                                lower, upper));
      return;
    }
    made.limits = {lower, upper};
  }

  void set_dynamics(const sdf::Joint& joint, const sdf::JointAxis& axis, Joint& made) {
    if (axis.Friction() != 0.0) made.motor = {0.0, axis.Friction()};
    if (axis.Damping() != 0.0) {
      notice(joint, fmt::format("<damping> {:g} left out: not supported", axis.Damping()));
    }
    if (axis.SpringStiffness() != 0.0) {
      notice(joint, fmt::format("<spring_stiffness> {:g} left out: not supported",
                                axis.SpringStiffness()));
    }
  }

  const sdf::Model& model_;
  const Pose& model_pose_;
  const std::string& name_;
  const BodyOfLink& body_of_link_;
  const SdfSurvey& survey_;
  Scene& scene_;
};

}  // namespace

std::string unsupported_joint(std::string_view type) {
  constexpr std::array<std::string_view, 5> kSupported = {"revolute", "continuous", "prismatic",
                                                          "ball", "fixed"};
  if (std::find(kSupported.begin(), kSupported.end(), type) != kSupported.end()) return "";
  return fmt::format("<joint type=\"{}\"> is not supported", type);
}

void add_joints(const sdf::Model& model, const Pose& model_pose, const std::string& name,
                const BodyOfLink& body_of_link, const SdfSurvey& survey, Scene& scene) {
  JointReader(model, model_pose, name, body_of_link, survey, scene).read();
}

}  // namespace signorini::validation
