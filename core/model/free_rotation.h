#pragma once

#include <signorini/core/model/body.h>

namespace signorini {

/// The torque-free rotation of a body over a step h, as the quaternion c that turns its axes: q+ =
/// q c (R+ = R C), L unchanged.
///
/// Implicit midpoint in the body frame, Pi = R^T L, J the body's inertia tensor:
///
///     Pi+ - Pi = h Pi_m x J^-1 Pi_m,   Pi_m = (Pi + Pi+)/2,   C = cay(h J^-1 Pi_m),
///
/// c = (1, h/2 J^-1 Pi_m) normalised. The midpoint rule keeps quadratic invariants, so |Pi| and the
/// energy 1/2 Pi.J^-1 Pi are exact; Pi+ = C^T Pi, so R+ Pi+ = L is exact too (Austin,
/// Krishnaprasad, Wang, Almost Poisson integration of rigid body systems, Journal of Computational
/// Physics 107, 1993; Simo and Wong, Unconditionally stable algorithms for rigid body dynamics that
/// exactly preserve energy and momentum, International Journal for Numerical Methods in Engineering
/// 31, 1991). Second order; five such steps of lengths a, a, (1 - 4a), a, a times h with a = 1/(4 -
/// 4^(1/3)) make it fourth order (Suzuki, Physics Letters A 146, 1990) and keep the same
/// invariants.
///
/// Steps that turn the body by more than kMostTurn are divided, kMostParts times at most (a body
/// that turns faster keeps L, but its energy only as far as the iteration converges). Cost: 5
/// Newton solves of order 3 for every kMostTurn.
/// @param inertia J_body, symmetric positive definite. @param Pi angular momentum, body axes
/// @param step h, s
[[nodiscard]] Quat free_rotation(const Mat3& inertia, const Vec3& Pi, double step);

inline constexpr double kMostTurn = 0.5;     ///< rad
inline constexpr double kMostParts = 10000;  ///< of one step

}  // namespace signorini
