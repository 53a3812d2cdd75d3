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
struct RayVerdict {
  Status status = Status::kRayUnproven;  ///< kInfeasible, kNoSolutionBelow or kRayUnproven
  double bound = 0.0;                    ///< Z, rounded down; +infinity when infeasible; 0 unproven
};

/// Judges a ray from the caller's data.
///
/// kInfeasible is returned only if q.y < 0 and M^T y <= 0 hold exactly: in rational arithmetic over
/// the doubles given (with GMP; without GMP only where every product and sum is exact in long
/// double, which is checked). kNoSolutionBelow is returned with a Z that is a true bound, rounding
/// errors of its own evaluation included. Everything else is kRayUnproven.
///
/// @param problem an LCP (is_lcp()), shapes checked. @param y n numbers; anything negative or not
/// finite is unproven.
[[nodiscard]] RayVerdict judge_ray(const Problem& problem, const VectorRef& y);

}  // namespace signorini::lcp
