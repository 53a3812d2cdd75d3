#pragma once

#include <signorini/lcp/solver.h>

namespace signorini::lcp {

/// max_iterations counts pivots, -1: no limit (the lexicographic rule ends every path, but 2^n
/// pivots are possible); time_limit is checked once a tableau row. tolerance only judges the
/// rounded answer.
struct ExactLemkeSettings : SolverSettings {
  /// Paths from other complementary bases at most, after a ray that proves nothing, >= 0.
  int restarts = 16;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Lemke's method over rational numbers, for small problems and as the oracle of the others: the
/// exact solution of the LCP that the doubles state, rounded once to doubles. The method, its
/// guarantees by matrix class, its cost, and what "the LCP that the doubles state" means for a
/// factored M: solve_exactly() in exact_solution.h, which also gives the rational numbers.
///
/// Takes an LCP (is_lcp()), any M. Statuses:
/// - kSolved, kSolvedToRounding: z is the rounded exact solution, and meets the certificate. Should
///   rounding alone spoil it more than that: kNumericalBreakdown, and detail says so.
/// - kInfeasible: the exact ray was written to result.ray as doubles (a positive multiple of it)
///   and judge_ray() proves it.
/// - kNoSolutionBelow, kRayUnproven: the path ended on a ray. Where the exact ray does prove
///   infeasibility but no multiple of it has double entries, result.ray is rounded, the status is
///   what the rounded ray proves, and detail says what the exact one did. z is the last basic
///   solution before the ray.
/// - kIterationLimit, kTimeLimit: z is the last basic solution (z >= 0, z.w = 0 with z0 > 0).
/// A warm start is ignored. The solver has no workspace: it allocates.
class ExactLemke : public Solver {
 public:
  /// @throws std::invalid_argument if settings.validate() does
  explicit ExactLemke(const ExactLemkeSettings& settings = {});

  [[nodiscard]] std::string_view name() const override { return "exact"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  ExactLemkeSettings settings_;
};

}  // namespace signorini::lcp
