#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>

namespace signorini {

/// How the gap of a contact moves. d = N.(P_A - P_B); notes, section 3; design, section 4.7.
struct GapKinematics {
  double d = 0.0;                  ///< gap, m
  double d_dot = 0.0;              ///< N.(u_A - u_B), m/s: < 0 approaching
  Vec3 normal_dot = Vec3::Zero();  ///< N', 1/s
  /// d'' minus N.(a_A - a_B): what the turning of N and the wandering of the contact point on
  /// curved surfaces add to the material accelerations a of the points, m/s^2.
  double curvature_acceleration = 0.0;
};

/// d, d', N' of a contact and the second-order term of d''.
///
/// With n_X = w_X x N, local radii matrices rho_X in the tangent plane (LocalSurface), u_T the
/// tangential part of u_A - u_B:
///
///     (rho_A + rho_B + d I) N' = u_T + rho_A n_A + rho_B n_B      (N' = n_X where rho_X is
///     infinite) s_A = rho_A (n_A - N'),  s_B = rho_B (N' - n_B),  u_T + s_A - s_B = d N' d'' =
///     N.(a_A - a_B) + N'.u_T - s_A.n_A + s_B.n_B
///
/// where s_X is the velocity at which the contact point wanders over X. A face owner fixes
/// N' = w x N of its body. A vertex on a face: d'' = N.(a_A - a_B) + 2 N'.(u_A - u_B) - d |N'|^2.
/// A ball rolling on a plane: d'' = N.a of its centre, however fast it rolls.
[[nodiscard]] GapKinematics gap_kinematics(const Contact& contact, const BodyState& a,
                                           const Velocity& velocity_a, const BodyState& b,
                                           const Velocity& velocity_b);

enum class ContactClass : std::uint8_t { kColliding, kResting, kSeparating };

/// d' < -threshold: colliding; |d'| <= threshold: resting; else separating. (Notes, section 3; in
/// floating point "= 0" needs a threshold, m/s, >= 0.)
[[nodiscard]] ContactClass classify(double d_dot, double threshold);

}  // namespace signorini
