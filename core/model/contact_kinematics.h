#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>

#include <cstdint>

namespace signorini {

/// How the gap of a contact moves. d = N.(P_A - P_B); notes, section 3; design, section 4.7.
struct GapKinematics {
  double d = 0.0;                  ///< gap, m (as the contact says)
  double d_dot = 0.0;              ///< N.(u_A - u_B), m/s: < 0 approaching
  Vec3 normal_dot = Vec3::Zero();  ///< N', 1/s
  /// d'' minus N.(a_A - a_B): what the turning of N and the wandering of the contact point on
  /// curved surfaces add to the material accelerations a of the points, m/s^2.
  double curvature_acceleration = 0.0;
  Vec3 wander_a = Vec3::Zero();  ///< s_A: at which the contact point wanders over A, m/s
  Vec3 wander_b = Vec3::Zero();  ///< s_B
  /// The features do not determine N': parallel edges given as edge-edge, a sharp feature on a
  /// sharp feature at zero gap, principal directions along N. The part of N' that they determine
  /// is kept, what they contradict is met in the least-squares sense, and the rest is zero.
  bool degenerate = false;
};

/// d, d', N' of a contact and the second-order term of d''.
///
/// With n = N', n_X = w_X x N, the matrix rho_X of the radii of curvature of surface X in the
/// tangent plane (LocalSurface), u_T the tangential part of u_A - u_B, and s_X the velocity at
/// which the contact point wanders over X:
///
///     s_A = rho_A (n_A - n),   s_B = rho_B (n - n_B)     (the outward normals are -N and N)
///     u_T + s_A - s_B = d n                              (P_A - P_B = d N)
///     d'' = N.(a_A - a_B) + n.u_T - s_A.n_A + s_B.n_B
///
/// where a_X = v_X' + w_X' x r_X + w_X x (w_X x r_X). An infinite radius along t reads
/// n.t = n_X.t instead, with s_X.t left to the second equation. By owner:
///
/// - kFaceA, kFaceB: n = n_X of the owner; the other body's radii give its s, an infinite one
///   counting as 0 there: its contact point is then a point of the material, as the end of an edge
///   is. A vertex: d'' = N.(a_A - a_B) + 2 n.u_T - d |n|^2. A ball of radius R rolling on a plane,
///   however fast: d'' = N.a of its centre.
/// - kEdgeEdge: both surfaces are edges along their `direction`, whatever their radii say;
///   n.e_A = n_A.e_A, n.e_B = n_B.e_B. Nearly parallel edges have a true, and huge, d''.
/// - kCurved: as the surfaces say, sharp, rounded and flat directions mixed.
///
/// Derivation: the first two are the time derivatives of "the normals are opposite" and of the
/// closest points; d' = N.(u_A - u_B) holds because s_X lies in the tangent plane, and its
/// derivative along the wandering points gives the third.
///
/// @param contact as validate(ContactSet) wants it
/// @param a, velocity_a of body_a; b, velocity_b of body_b
/// Cost: face owners some 100 flops; else one orthogonal factorisation of order 2 to 6.
[[nodiscard]] GapKinematics gap_kinematics(const Contact& contact, const BodyState& a,
                                           const Velocity& velocity_a, const BodyState& b,
                                           const Velocity& velocity_b);

enum class ContactClass : std::uint8_t { kColliding, kResting, kSeparating };

/// d' < -threshold: colliding; |d'| <= threshold: resting; else separating. (Notes, section 3; in
/// floating point "= 0" needs a threshold, m/s, >= 0.)
[[nodiscard]] ContactClass classify(double d_dot, double threshold);

}  // namespace signorini
