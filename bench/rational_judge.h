#pragma once

#include <signorini/lcp/exact_solution.h>
#include <signorini/lcp/result.h>

#include <gmpxx.h>
#include <optional>
#include <string>
#include <vector>

namespace signorini::bench {

/// The residuals and floors of certificate.h for an LCP, of the doubles z, in rationals.
struct RationalResiduals {
  mpq_class natural;
  mpq_class natural_floor;
  mpq_class unit_free;  ///< with q = 0: the numerator alone, which must then be 0
  mpq_class unit_free_floor;
};
[[nodiscard]] RationalResiduals rational_residuals(const lcp::ExactProblem& problem,
                                                   const lcp::Vector& z);

/// Whether the problem has a solution, and how that is known.
enum class Existence {
  kSolution,  ///< `solution` is one
  kNone,      ///< proven: by the exact ray, or by enumeration of the complementary cones
  kUnknown,   ///< exact Lemke ended on a ray that proves nothing, and n is too large to enumerate
};
struct Truth {
  Existence existence = Existence::kUnknown;
  std::vector<mpq_class> solution;
  bool is_by_enumeration = false;  ///< exact Lemke alone did not decide it
};

/// The enumeration is left out above this (0.1 s at 8 rows, three times as long for each further).
inline constexpr int kMostRowsEnumerated = 8;
/// Decides with exact Lemke, and where that ends on a ray that proves nothing, by enumeration of
/// the complementary cones (complementary_cones.h).
[[nodiscard]] Truth find_truth(const lcp::Problem& problem, const lcp::ExactProblem& exact);

/// What is wrong with what a result claims, judged in rationals and against the truth, or empty:
/// - kSolved, kSolvedToRounding: the residuals (and floors) of z;
/// - kInfeasible: ray >= 0, q.ray < 0, M^T ray <= 0, and no solution is known (with friction cones:
///   the ray 0 on tangential rows, and (M^T ray)_N + mu sum_k |(M^T ray)_Tk| <= 0);
/// - kNoSolutionBelow: Z is at most the exact bound of the ray, and no known solution is below it.
/// The other statuses claim nothing.
[[nodiscard]] std::string find_wrong_claim(const lcp::ExactProblem& problem,
                                           const lcp::Result& result, double tolerance,
                                           const Truth& truth,
                                           const std::vector<lcp::FrictionCone>& cones = {});

}  // namespace signorini::bench
