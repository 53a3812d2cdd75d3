#pragma once

#include <signorini/core/response/assembly.h>

#include <vector>

namespace signorini {

/// Two tangents of a contact: t1, t2, N are perpendicular to each other, t2 along N x t1. Unit, but
/// for t2 of anisotropic friction.
struct TangentFrame {
  Vec3 t1 = Vec3::UnitX();
  Vec3 t2 = Vec3::UnitY();
};

/// Slower slip than this does not align the frame, m/s.
inline constexpr double kAligningSlip = 1e-9;

/// The frame of a contact's tangential rows. t1 points along the slip where the slip is at least
/// kAligningSlip, so that with a friction pyramid a sliding point is braked by exactly mu f_n
/// against its slip, and a point about to slip is held by all of mu f_n, whatever the number of
/// sides; elsewhere t1 is fixed by N alone (Eigen's unitOrthogonal).
/// @param normal N, unit. @param slip any vector; its tangential part counts, m/s
[[nodiscard]] TangentFrame tangent_frame(const Vec3& normal, const Vec3& slip);

/// The frame of a contact: tangent_frame(); where mu differs (friction_ratio), t1 is along the
/// friction direction and t2 = ratio N x t1. Over the velocities along these and the impulses
/// z = (z_1, z_2) along them, friction is isotropic with mu: |z| <= mu f is the ellipse
/// (F_1/mu_1)^2 + (F_2/mu_2)^2 <= f^2 of the force F = z_1 t1 + z_2 t2, and where it slides
/// z = -mu f u_z/|u_z|, that is F_k = -f mu_k^2 u_k / |(mu_1 u_1, mu_2 u_2)|: of all forces in the
/// ellipse the one that takes most energy from the slip u.
[[nodiscard]] TangentFrame friction_frame(const Contact& contact, const Vec3& slip);

/// The point at which friction acts on both bodies, so that it has no moment on the pair:
/// (P_A + P_B)/2.
[[nodiscard]] Vec3 friction_point(const Contact& contact);

/// u_A - u_B at friction_point(), m/s, its normal part included.
[[nodiscard]] Vec3 slip_velocity(const std::vector<Velocity>& velocities, const State& state,
                                 const Contact& contact);
[[nodiscard]] Vec3 slip_velocity(const Bodies& bodies, const State& state, const Contact& contact);

/// Adds the row [t, r_A x t, -t, -(r_B x t)] at friction_point() to A; rows.d_dot is left alone.
void add_tangent_row(const State& state, const Contact& contact, const Vec3& tangent,
                     NormalRows& rows);

/// Gives every contact's impulse to its dynamic bodies, at friction_point().
/// @param impulses on A, world axes, N s, one a contact
void apply_contact_impulses(const Bodies& bodies, const ContactSet& contacts,
                            const std::vector<Vec3>& impulses, State& state);

}  // namespace signorini
