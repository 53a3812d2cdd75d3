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
};

/// The state with its orientation as a matrix that is not forced to be a rotation: R = [U0 U1 U2].
struct MatrixState {
  Vec3 x = Vec3::Zero();
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();
  Vec3 L = Vec3::Zero();
};

/// S' = [p/m, 1/2 w q (or Skew(w) R), F, tau] integrated over one step of `step` seconds with force
/// and torque constant during the step (world axes, N and N m). Only dynamic bodies move by loads;
/// kinematic bodies keep their velocity; fixed ones do nothing. The quaternion is normalised and
/// the matrix is NOT orthonormalised here: see gram_schmidt().
void integrate_free(const Body& body, const Vec3& force, const Vec3& torque, double step,
                    Integrator integrator, BodyState& state);
void integrate_free(const Body& body, const Vec3& force, const Vec3& torque, double step,
                    Integrator integrator, MatrixState& state);

/// U0 <- U0/|U0|; U1 <- (U1 - (U1.U0) U0)/|...|; U2 <- U0 x U1.
void gram_schmidt(Mat3& R);

/// max |R^T R - I|, the drift that Gram-Schmidt removes.
[[nodiscard]] double orthogonality_error(const Mat3& R);

}  // namespace signorini
