#pragma once

#include <signorini/lcp/exact_solution.h>
#include <signorini/lcp/problem.h>
#include <signorini/lcp/result.h>

#include <gmpxx.h>
#include <string>

namespace signorini::bench {

/// The residuals and floors of certificate.h of the doubles z, for every kind of row: rationals;
/// in cones, where norms are irrational, with 2048 bits. The scales D are the certificate's
/// doubles (of a cone: its largest eigenvalue from our own eigenvalue solver, in double).
struct ExactResiduals {
  mpq_class natural;
  mpq_class natural_floor;
  mpq_class unit_free;  ///< with q = 0: the numerator alone, which must be 0
  mpq_class unit_free_floor;
};
[[nodiscard]] ExactResiduals exact_residuals(const lcp::Problem& problem, const lcp::Vector& z);

/// True if interval arithmetic in long double (outward rounding; lcp/interval.h) shows that both
/// residuals of z are at most the tolerance. False says nothing.
[[nodiscard]] bool surely_within(const lcp::Problem& problem, const lcp::Vector& z,
                                 double tolerance);

/// How a claim was judged.
struct Verdict {
  std::string wrong;          ///< what is wrong with the claim; empty: nothing
  bool by_rationals = false;  ///< intervals did not decide it
};

/// Judges what a result claims, without knowing whether a solution exists:
/// - kSolved: both residuals are <= tolerance, recomputed without rounding, but for a relative 1e-9
///   (the scales D are rounded). With q = 0 the numerator of the unit-free one must be 0, as the
///   certificate says (of cones: to 2^-1000). kSolvedToRounding: each is <= max(tolerance, min(4
///   floors, 1e-5)).
/// - kInfeasible: an LCP, perhaps with cones, ray >= 0, q.ray < 0, M^T ray <= 0 (cones:
///   rational_judge.h). kNoSolutionBelow: Z is at most the exact bound of the ray.
/// - kInvalidInput exactly where find_bad_value() finds something; then z is NaN. In every other
///   case z and w have n finite numbers.
[[nodiscard]] Verdict judge_claim(const lcp::Problem& problem, const lcp::Result& result,
                                  double tolerance);

}  // namespace signorini::bench
