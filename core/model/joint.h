#pragma once

#include <signorini/core/model/body.h>

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace signorini {

/// What a joint leaves free between its bodies. Its coordinate c: see joint_coordinate().
enum class JointKind : std::uint8_t {
  kFixed,     ///< nothing
  kBall,      ///< every turn about the anchor
  kHinge,     ///< the turn about the axis: c, rad (revolute)
  kSlider,    ///< the way along the axis: c, m (prismatic)
  kDistance,  ///< all but the distance of the anchors: c, m (a rod where both limits are equal)
};

/// "fixed", "ball", "hinge", "slider", "distance" or "unknown joint".
[[nodiscard]] std::string_view to_string(JointKind kind);

/// lower <= c <= upper; rad for a hinge, m for a slider and a distance. Equal: c is held there.
/// A hinge's angle is known up to whole turns: with finite limits it is taken within half a turn of
/// their middle, so both must be finite and less than a turn apart.
struct JointLimits {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// Drives c' towards `speed` with at most `max_force`: at that speed the force is what it takes,
/// away from it all of it. speed = 0: dry friction of the joint.
struct JointMotor {
  double speed = 0.0;      ///< rad/s or m/s, of A against B along the axis; finite
  double max_force = 0.0;  ///< N m or N; >= 0 (0: no motor), infinite only without finite limits
};

/// Two bodies and what they cannot do. Anchors and axis do not move in their bodies.
///
/// P_A = x_A + R_A anchor_a, P_B = x_B + R_B anchor_b and a = R_B axis in world axes; R_A = R_B R_0
/// with R_0 = `reference` where nothing is turned.
///
///     ball       P_A = P_B
///     fixed      P_A = P_B,   R_A = R_B R_0
///     hinge      P_A = P_B,   R_A = R_B exp(c axis) R_0
///     slider     P_A = P_B + c a,   R_A = R_B R_0
///     distance   |P_A - P_B| = c
struct Joint {
  JointKind kind = JointKind::kFixed;
  int body_a = -1;                    ///< index into Bodies and State
  int body_b = -1;                    ///< one of the two may be fixed or driven, in either place
  Vec3 anchor_a = Vec3::Zero();       ///< from the centre of mass, body axes of A, m
  Vec3 anchor_b = Vec3::Zero();       ///< the same of B
  Vec3 axis = Vec3::UnitZ();          ///< body axes of B, unit; hinge and slider
  Quat reference = Quat::Identity();  ///< R_0: body axes of A in those of B, unit
  JointLimits limits;                 ///< hinge, slider, distance
  JointMotor motor;                   ///< hinge, slider, distance
  bool bodies_collide = false;        ///< false: contacts between A and B are not made
  std::string name;                   ///< for reports

  [[nodiscard]] bool has_coordinate() const {
    return kind != JointKind::kFixed && kind != JointKind::kBall;
  }
};

using Joints = std::vector<Joint>;

/// A joint of bodies as they stand, with c = 0 there (distance: both limits are the distance that
/// the bodies' centres of mass have; set anchors and limits afterwards for another).
/// @param point P_A = P_B, world, m (distance: not used)
/// @param axis world, finite and not zero; its length does not matter (hinge, slider)
/// @throws std::invalid_argument naming body or axis: a body that is not in `state`, a bad axis
[[nodiscard]] Joint joint_at(JointKind kind, int body_a, int body_b, const State& state,
                             const Vec3& point, const Vec3& axis = Vec3::UnitZ());

/// Checks joints. @throws std::invalid_argument naming the joint, the field, its value and the
/// bound: bodies in range, different, at least one dynamic; anchors finite; axis unit to 1e-9 (the
/// zero vector and NaN are named as such); |reference| within 1e-6 of 1; lower <= upper, neither
/// NaN; a distance: upper > 0 and not equal to lower unless finite; limits and motors only where
/// there is a coordinate; those of a hinge as JointLimits says; motor as JointMotor says.
void validate(const Joints& joints, const Bodies& bodies);

/// c of a joint: hinge, the angle from the reference in (m - pi, m + pi], m the middle of finite
/// limits, else 0; slider, a.(P_A - P_B); distance, |P_A - P_B|; 0 for the others.
[[nodiscard]] double joint_coordinate(const Joint& joint, const State& state);

/// P_A and P_B.
[[nodiscard]] inline Vec3 anchor_a(const Joint& joint, const State& state) {
  return state[joint.body_a].pose() * joint.anchor_a;
}
[[nodiscard]] inline Vec3 anchor_b(const Joint& joint, const State& state) {
  return state[joint.body_b].pose() * joint.anchor_b;
}

/// How far a joint is from holding, equality by equality: world axes, zero where it holds.
struct JointError {
  Vec3 position = Vec3::Zero();  ///< m; slider: across the axis; distance: zero (see limits)
  Vec3 angle = Vec3::Zero();     ///< rotation vector, rad; hinge: across the axis
};
[[nodiscard]] JointError joint_error(const Joint& joint, const State& state);

}  // namespace signorini
