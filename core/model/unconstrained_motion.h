#pragma once

#include <signorini/core/model/body.h>

#include <cstdint>

namespace signorini {

/// How the orientation is integrated (notes, section 2).
enum class OrientationScheme : std::uint8_t {
  kQuaternion,      ///< q' = 1/2 w q, then q / |q|
  kRotationMatrix,  ///< R' = Skew(w) R, then Gram-Schmidt
};

enum class Integrator : std::uint8_t {
  kSemiImplicit,  ///< p, L first, then x and orientation with the new v and w; first order,
                  ///< symplectic in x
  kRungeKutta4,   ///< classical RK4 on the whole state; fourth order
  /// x and p as kSemiImplicit; the rotation by free_rotation.h between two halves of the torque:
  /// without torque L and the energy are kept to rounding; fourth order in the rotation.
  kEnergyMomentum,
};

/// The state with its orientation as a matrix that is not forced to be a rotation: R = [U0 U1 U2].
struct MatrixState {
  Vec3 x = Vec3::Zero();      ///< m
  Mat3 R = Mat3::Identity();  ///< body axes to world axes
  Vec3 p = Vec3::Zero();      ///< as in BodyState
  Vec3 L = Vec3::Zero();      ///< as in BodyState
};

/// The same state with R = R(q).
[[nodiscard]] MatrixState matrix_state(const BodyState& state);

/// One step of S' = [p/m, 1/2 w q (or Skew(w) R), F, tau] with w = R J_body^-1 R^T L.
///
/// Semi-implicit: p+ = p + h F, L+ = L + h tau, x+ = x + h p+/m, and an Euler step of the
/// orientation with w = J^-1(R) L+. Under a constant force x_n = x_0 + n h v_0 + h^2 (F/m)
/// n(n+1)/2, which is h/2 t F/m ahead of the parabola. RK4: classical, exact for x and p. Energy
/// and momentum: x, p as semi-implicit, L + h tau/2, free_rotation(), L + h tau/2 (kinematic
/// bodies: the exact turn by h w). All leave L exactly as it is when tau = 0 (no bit changes). The
/// quaternion is normalised here; the matrix is NOT orthonormalised here: see gram_schmidt().
///
/// @param force, torque constant during the step, world axes, N and N m about the centre of mass.
/// Only dynamic bodies feel them; kinematic bodies keep their velocity; fixed ones do nothing
/// @param step h, s, finite and >= 0
/// @throws std::invalid_argument naming field, value and bound if the step or a load is not finite
/// or the step is negative; state is then unchanged
void integrate_free(const Body& body, const Vec3& force, const Vec3& torque, double step,
                    Integrator integrator, BodyState& state);
void integrate_free(const Body& body, const Vec3& force, const Vec3& torque, double step,
                    Integrator integrator, MatrixState& state);

/// The same with the scheme chosen: kRotationMatrix takes R from q, makes the step, applies
/// Gram-Schmidt and goes back to q.
void integrate_free(const Body& body, const Vec3& force, const Vec3& torque, double step,
                    Integrator integrator, OrientationScheme scheme, BodyState& state);

/// U0 <- U0/|U0|; U1 <- (U1 - (U1.U0) U0)/|...|; U2 <- U0 x U1.
/// @throws std::invalid_argument if U0 is zero, or U1 is parallel to it, or not finite; R is then
/// unchanged
void gram_schmidt(Mat3& R);

/// max |R^T R - I| over the entries: the drift that Gram-Schmidt removes.
[[nodiscard]] double orthogonality_error(const Mat3& R);

/// T = 1/2 p.v + 1/2 L.w with w = R J_body^-1 R^T L; zero unless dynamic. J.
[[nodiscard]] double kinetic_energy(const Body& body, const MatrixState& state);

}  // namespace signorini
