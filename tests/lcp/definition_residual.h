#pragma once

#include <signorini/lcp/problem.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {

/// How far z is from a solution by the words of Problem, in long double; shares nothing with the
/// certificate. Of the rows that are in no cone, with w = M z + q, the most of
///
///     lower - z, z - upper,   min(w, z - lower) where w > 0,   min(-w, upper - z) where w < 0
///
/// divided by 1 + |q|_inf; infinite if a number is not finite.
inline double definition_residual(const Problem& problem, const Vector& z) {
  const Matrix M = to_dense(problem.M);
  const Index n = problem.size();
  if (z.size() != n || !z.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  long double worst = 0.0L;
  for (Index i = 0; i < n; ++i) {
    const bool in_cone = std::ranges::any_of(problem.cones, [&](const FrictionCone& cone) {
      return cone.normal_row <= i && i < cone.normal_row + cone.dimension;
    });
    if (in_cone) {
      continue;
    }
    long double w = problem.q[i];
    for (Index j = 0; j < n; ++j) {
      w += static_cast<long double>(M(i, j)) * z[j];
    }
    long double lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    long double upper =
        problem.upper.size() > 0 ? problem.upper[i] : std::numeric_limits<double>::infinity();
    for (const CoupledLimit& limit : problem.limits) {
      if (limit.row == i) {
        upper = static_cast<long double>(limit.coefficient) * std::max(z[limit.normal_row], 0.0);
        lower = -upper;
      }
    }
    const long double free_to_move =
        w > 0.0L ? std::min(w, z[i] - lower) : std::min(-w, upper - z[i]);
    worst = std::max({worst, lower - z[i], z[i] - upper, free_to_move});
  }
  const double q = n > 0 ? problem.q.cwiseAbs().maxCoeff() : 0.0;
  return static_cast<double>(worst / (1.0L + q));
}

}  // namespace signorini::lcp
