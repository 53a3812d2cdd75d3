#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>

#include <vector>

namespace signorini {

/// Force and torque on a body, world axes: N, N m about the centre of mass.
struct Wrench {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
};

/// F = m gravity_scale g for every dynamic body, no torque.
[[nodiscard]] std::vector<Wrench> gravity_loads(const Bodies& bodies, const Vec3& gravity);

/// v' and w' of a body without contact forces, and its w.
struct BodyAcceleration {
  Vec3 linear = Vec3::Zero();   ///< m/s^2
  Vec3 angular = Vec3::Zero();  ///< rad/s^2
  Vec3 spin = Vec3::Zero();     ///< rad/s

  /// Of the point of the body at r from the centre: a = v' + w' x r + w x (w x r), m/s^2.
  [[nodiscard]] Vec3 at(const Vec3& r) const {
    return linear + angular.cross(r) + spin.cross(spin.cross(r));
  }
};

/// v' = F/m, w' = J^-1 (tau - w x L).
/// @param loads one a body: everything but contact forces, gravity included; only those of dynamic
/// bodies count
/// @param driven of kinematic bodies: v' in m/s^2 (force) and w' in rad/s^2 (torque) in the same
/// struct, one a body; empty: they move uniformly
/// @throws std::invalid_argument naming the field, body and value: a wrong number of entries, not
/// finite
[[nodiscard]] std::vector<BodyAcceleration> free_accelerations(const Bodies& bodies,
                                                               const State& state,
                                                               const std::vector<Wrench>& loads,
                                                               const std::vector<Wrench>& driven);

/// How a contact would accelerate without contact forces.
struct ContactAcceleration {
  double normal = 0.0;  ///< d'' = N.(a_A - a_B) + the curvature terms of gap_kinematics()
  /// u' of u = u_A - u_B, the velocity of the one body's material over the other's where they
  /// touch: a_A + w_A x s_A - a_B - w_B x s_B, s the velocity at which the contact point wanders
  /// over each (a ball that rolls has u' = 0 however fast). Its tangential part is how slip starts.
  Vec3 slip = Vec3::Zero();
  bool degenerate = false;  ///< as GapKinematics
};
[[nodiscard]] ContactAcceleration contact_acceleration(
    const Bodies& bodies, const State& state, const Contact& contact,
    const std::vector<BodyAcceleration>& accelerations);

}  // namespace signorini
