#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/status.h>

namespace signorini::lcp {

/// What a ray y >= 0 proves about 0 <= z, M z + q >= 0. For every feasible z,
/// -q.y <= (M^T y).z <= max_i (M^T y)_i+ |z|_1, hence with q.y < 0
///
///     |z|_1 >= Z := -q.y / max_i (M^T y)_i+ .
///
/// (Free columns would need (M^T y)_i = 0; they are refused.)
///
/// With friction cones (either law) y is a ray where its tangential rows are 0: every feasible w
/// has w_N >= 0, whatever friction does. With g = M^T y, z in K and |z_Tk| <= mu z_N, the g_i of a
/// cone's normal row becomes g_N + mu sum_k |g_Tk|, its tangential rows drop out, and Z bounds the
/// sum of the z_i that are not tangential.
struct RayVerdict {
  Status status = Status::kRayUnproven;  ///< kInfeasible, kNoSolutionBelow or kRayUnproven
  double bound = 0.0;                    ///< Z, rounded down; +infinity when infeasible; 0 unproven
  /// With kNoSolutionBelow: the largest (M^T y)_i+ as a part of what it is summed from, (|M|^T y)_i
  /// (of the factored form, |A_ij| <= (A_ii A_jj)^(1/2) instead of |A_ij|). Near 1e-16 the entries
  /// of M, changed by their own rounding, have no solution at all. 0 when infeasible.
  double defect = 0.0;
};

/// Judges a ray from the caller's data, over the doubles given, with no rounding in the verdict:
///
/// kInfeasible is returned only if q.y < 0 and M^T y <= 0 hold exactly. kNoSolutionBelow is
/// returned with a Z > 0 that is a true bound, at most a few units in the last place below the
/// exact one. Everything else is kRayUnproven.
///
/// Sums run in an exact fixed-point number (exact_sum.h); no build option changes the verdict. For
/// the factored form M^T y = J W p + c y, p = J^T y is exact, and W p runs in intervals, so that a
/// ray with p = 0, c y = 0 is judged exactly (and where W is positive definite no other y >= 0 can
/// have A y <= 0, for then y.A y = p.W p + y.c y > 0); the W judged is the one that
/// BlockMass::apply_inverse() applies.
///
/// So every ray that a solver ends on is judged, whatever n and whichever solver it was
/// (Solver::solve()).
///
/// Cost: about ten products with M^T.
/// @param problem shapes checked (check_shapes()). Anything with bounds other than 0 and +inf, with
/// coupled limits, or with a value that is not finite, is unproven.
/// @param y n numbers, the caller's units, any scale; anything negative or not finite, or not 0 on
/// a tangential row, is unproven.
///
/// Source: the Farkas argument above; rays of Lemke's method in Cottle, Pang, Stone, The Linear
/// Complementarity Problem (1992), theorem 4.4.9.
[[nodiscard]] RayVerdict judge_ray(const Problem& problem, const VectorRef& y);

}  // namespace signorini::lcp
