#pragma once

#include <signorini/core/response/joint_rows.h>

#include <vector>

namespace signorini {

/// h^2 times the stiffness of a body's joints, and its longest arm.
struct JointLoad {
  Mat3 stiffness = Mat3::Zero();
  double arm_squared = 0.0;
};

/// Light links under a heavy load, kept from whipping: the geometric stiffness of balls and hinges,
/// implicit in the orientation (Tournier, Nesme, Gilles, Faure, Stable constrained dynamics, ACM
/// Transactions on Graphics 34, 2015; body by body as Andrews, Teichmann, Kry, Geometric stiffness
/// for real-time constrained multibody dynamics, Computer Graphics Forum 36, 2017).
///
/// A joint that pulls a body with the force F at the arm r turns it back by K dtheta when it is
/// turned by dtheta, K = (F.r) I - (F r^T + r F^T)/2. The rows of a step know F's direction at its
/// start alone: where h^2 K exceeds the body's inertia J + m |r|^2, as for links under a load of
/// many times their mass, the link overshoots by more than it was off, and a taut chain crumples.
/// There the change of the torque is taken at the step's end,
///
///     (J + S) w+ = J w* + sum of the moments,    S = (sum h^2 K - J - m |r|^2)_+
///
/// (F of the step before; the positive part of a symmetric matrix; |r| the longest arm). S adds no
/// energy: T+ - T* <= -1/2 w+.S w+. Angular momentum is what it costs: S w+ has no counterpart.
/// Where S = 0 nothing changes; a single pendulum, whatever it weighs, has S = 0 while h^2 g < r.
///
/// @param state of the step's start. @param before one a joint: what joints did in the step before
/// @param step h, s
/// @param stiff receives the bodies with J + S (body axes) in the place of J, where there is one
/// with S != 0; else it is left as it is
/// @param loads memory
/// @return how many have S != 0
int stiffen(const Bodies& bodies, const State& state, const Joints& joints,
            const std::vector<JointReport>& before, double step, std::vector<JointLoad>& loads,
            Bodies& stiff);

}  // namespace signorini
