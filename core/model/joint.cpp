#include <signorini/core/model/joint.h>
#include <signorini/core/model/number_text.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace signorini {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kUnitAxis = 1e-9;
constexpr double kUnitQuaternion = 1e-6;

class JointCheck {
 public:
  JointCheck(const Joint& joint, std::size_t number, const Bodies& bodies)
      : joint_(joint), number_(number), bodies_(bodies) {}

  void run() const {
    check_bodies();
    check_frames();
    check_limits();
    check_motor();
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    const std::string name = joint_.name.empty() ? "" : " ('" + joint_.name + "')";
    throw std::invalid_argument("joint " + std::to_string(number_) + name + ": " + what);
  }

  void check_body(const char* field, int body) const {
    const int count = static_cast<int>(bodies_.size());
    if (body < 0 || body >= count) {
      refuse(std::string(field) + ": must be in [0, " + std::to_string(count) + "), got " +
             std::to_string(body));
    }
  }

  void check_bodies() const {
    if (joint_.kind > JointKind::kDistance) {
      refuse("kind: must be one of the five kinds, got " +
             std::to_string(static_cast<int>(joint_.kind)));
    }
    check_body("body_a", joint_.body_a);
    check_body("body_b", joint_.body_b);
    if (joint_.body_a == joint_.body_b) {
      refuse("body_b: must differ from body_a, both are " + std::to_string(joint_.body_a));
    }
    if (!bodies_[joint_.body_a].is_dynamic() && !bodies_[joint_.body_b].is_dynamic()) {
      refuse("body_a " + std::to_string(joint_.body_a) + " and body_b " +
             std::to_string(joint_.body_b) + ": at least one must be dynamic");
    }
  }

  void check_anchor(const char* field, const Vec3& anchor) const {
    if (!anchor.allFinite()) {
      refuse(std::string(field) + ": must be finite, got " + number_text(anchor) + " m");
    }
  }

  void check_frames() const {
    check_anchor("anchor_a", joint_.anchor_a);
    check_anchor("anchor_b", joint_.anchor_b);
    if (joint_.axis.isZero(0.0)) {
      refuse("axis: must be a unit vector, got the zero vector");
    }
    if (!(std::abs(joint_.axis.norm() - 1.0) <= kUnitAxis)) {
      refuse("axis: must be a unit vector to 1e-9, got " + number_text(joint_.axis) +
             " of length " + number_text(joint_.axis.norm()));
    }
    if (!(std::abs(joint_.reference.norm() - 1.0) <= kUnitQuaternion)) {
      refuse("reference: must be a unit quaternion to 1e-6, its norm is " +
             number_text(joint_.reference.norm()));
    }
  }

  void check_limits() const {
    const auto [lower, upper] = joint_.limits;
    const std::string got = "got lower = " + number_text(lower) + ", upper = " + number_text(upper);
    if (!(lower <= upper)) {
      refuse("limits: lower <= upper must hold, " + got);
    }
    const bool finite = std::isfinite(lower) || std::isfinite(upper);
    if (finite && !joint_.has_coordinate()) {
      refuse("limits: a " + std::string(to_string(joint_.kind)) + " joint has none, " + got);
    }
    if (lower == upper && !finite) {
      refuse("limits: equal ones must be finite, " + got);
    }
    if (joint_.kind == JointKind::kHinge && finite && !(upper - lower < 2.0 * kPi)) {
      refuse("limits: of a hinge, both finite and less than 2 pi apart, " + got + " rad");
    }
    if (joint_.kind == JointKind::kDistance && !(upper > 0.0)) {
      refuse("limits: upper: of a distance, must be > 0, " + got + " m");
    }
  }

  void check_motor() const {
    const auto [speed, force] = joint_.motor;
    if (!std::isfinite(speed)) {
      refuse("motor.speed: must be finite, got " + number_text(speed));
    }
    if (!(force >= 0.0)) {
      refuse("motor.max_force: must be >= 0, got " + number_text(force));
    }
    if (force > 0.0 && !joint_.has_coordinate()) {
      refuse("motor.max_force: a " + std::string(to_string(joint_.kind)) +
             " joint has no motor: must be 0, got " + number_text(force));
    }
    const bool limited = std::isfinite(joint_.limits.lower) || std::isfinite(joint_.limits.upper);
    if (std::isinf(force) && limited) {
      refuse("motor.max_force: must be finite beside finite limits, got " + number_text(force));
    }
  }

  const Joint& joint_;
  std::size_t number_;
  const Bodies& bodies_;
};

/// R_A R_0^-1 R_B^-1: how A is turned out of its reference, world axes.
Quat turn(const Joint& joint, const State& state) {
  return state[joint.body_a].q * joint.reference.conjugate() * state[joint.body_b].q.conjugate();
}

Vec3 rotation_vector(Quat turn) {
  if (turn.w() < 0.0) {
    turn.coeffs() = -turn.coeffs();
  }
  const double sine = turn.vec().norm();
  const double factor = sine > 0.0 ? 2.0 * std::atan2(sine, turn.w()) / sine : 2.0;
  return factor * turn.vec();
}

double hinge_angle(const Joint& joint, const State& state) {
  const Vec3 axis = state[joint.body_b].q * joint.axis;
  const Quat turned = turn(joint, state);
  const auto [lower, upper] = joint.limits;
  const double middle = std::isfinite(lower) ? 0.5 * (lower + upper) : 0.0;
  double angle = 2.0 * std::atan2(turned.vec().dot(axis), turned.w());
  angle -= 2.0 * kPi * std::ceil((angle - middle - kPi) / (2.0 * kPi));
  return angle;
}

int body_in(int body, const char* field, const State& state) {
  if (body < 0 || body >= static_cast<int>(state.size())) {
    throw std::invalid_argument(std::string("joint: ") + field + ": must be in [0, " +
                                std::to_string(state.size()) + "), got " + std::to_string(body));
  }
  return body;
}

}  // namespace

std::string_view to_string(JointKind kind) {
  switch (kind) {
    case JointKind::kFixed: return "fixed";
    case JointKind::kBall: return "ball";
    case JointKind::kHinge: return "hinge";
    case JointKind::kSlider: return "slider";
    case JointKind::kDistance: return "distance";
  }
  return "unknown joint";
}

Joint joint_at(JointKind kind, int body_a, int body_b, const State& state, const Vec3& point,
               const Vec3& axis) {
  const BodyState& a = state[body_in(body_a, "body_a", state)];
  const BodyState& b = state[body_in(body_b, "body_b", state)];
  const double length = axis.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw std::invalid_argument("joint: axis: must be finite and not zero, got " +
                                number_text(axis));
  }
  Joint joint;
  joint.kind = kind;
  joint.body_a = body_a;
  joint.body_b = body_b;
  joint.reference = (b.q.conjugate() * a.q).normalized();
  joint.axis = (b.q.conjugate() * (axis / length)).normalized();
  if (kind == JointKind::kDistance) {
    joint.limits.lower = joint.limits.upper = (a.x - b.x).norm();
  } else {
    joint.anchor_a = a.pose().inverse() * point;
    joint.anchor_b = b.pose().inverse() * point;
  }
  return joint;
}

void validate(const Joints& joints, const Bodies& bodies) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    JointCheck(joints[i], i, bodies).run();
  }
}

double joint_coordinate(const Joint& joint, const State& state) {
  switch (joint.kind) {
    case JointKind::kHinge: return hinge_angle(joint, state);
    case JointKind::kSlider:
      return (state[joint.body_b].q * joint.axis)
          .dot(anchor_a(joint, state) - anchor_b(joint, state));
    case JointKind::kDistance: return (anchor_a(joint, state) - anchor_b(joint, state)).norm();
    default: return 0.0;
  }
}

JointError joint_error(const Joint& joint, const State& state) {
  const Vec3 apart = anchor_a(joint, state) - anchor_b(joint, state);
  const Vec3 axis = state[joint.body_b].q * joint.axis;
  switch (joint.kind) {
    case JointKind::kFixed: return {apart, rotation_vector(turn(joint, state))};
    case JointKind::kBall: return {apart, Vec3::Zero()};
    case JointKind::kHinge: {
      // a x a_A = |sin| of the angle between the axes, about what turns a to a_A.
      const Vec3 axis_a = state[joint.body_a].q * (joint.reference.conjugate() * joint.axis);
      const Vec3 across = axis.cross(axis_a);
      const double sine = across.norm();
      const double angle = std::atan2(sine, axis.dot(axis_a));
      if (sine > 0.0) {
        return {apart, angle / sine * across};
      }
      return {apart, angle * axis.unitOrthogonal()};  // 0, or half a turn about anything across
    }
    case JointKind::kSlider:
      return {apart - axis.dot(apart) * axis, rotation_vector(turn(joint, state))};
    case JointKind::kDistance: return {};
  }
  return {};
}

}  // namespace signorini
