#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of projected Gauss-Seidel.
struct PgsSettings : SolverSettings {
  /// Sweeps when max_iterations is -1. A row costs some 10 to 20 ns a sweep; piles of boxes with
  /// equal masses need 1e2 to 1e4 sweeps to 1e-8, tall towers and mass ratios far more.
  static constexpr int kDefaultSweeps = 10000;

  /// omega, dimensionless, in (0, 2): each step is multiplied by it (projected SOR). 1 is
  /// Gauss-Seidel, the safest; for symmetric positive semidefinite M the objective falls with every
  /// value in the range. Larger is sometimes faster and amplifies rounding.
  double relaxation = 1.0;
  /// Sweeps between two looks at the residual, >= 1. A look costs about two sweeps and also
  /// recomputes the kept velocity; larger spends less on looking and overshoots more. The first
  /// looks come earlier, at sweeps 0, 1, 2, 4, ...
  int check_period = 16;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Projected Gauss-Seidel: sweeps over the rows, each time setting
///
///     z_i <- clamp(z_i - omega w_i / M_ii, lower_i, upper_i),   w = M z + q,
///
/// with the newest z of the rows before it (Cottle, Pang, Stone, The Linear Complementarity
/// Problem, 1992, section 5.2, there for symmetric M; in games: Catto, Iterative Dynamics with
/// Temporal Coherence, 2005). Coupled rows use the bounds -+ mu z_n of the current z_n; free rows
/// are not clamped. Takes every problem of problem.h.
///
/// Matrix-free over a factored M: the body-space velocity v = W J^T z is kept, w_i = J_i v + c_i
/// z_i
/// + q_i, and a step adds W J_i^T dz_i to v. Over a dense or sparse M, w itself is kept and a step
/// adds a column of M; a row whose z_i does not change costs O(1). What is kept drifts by rounding
/// and is recomputed from z at every look at the residual.
///
/// Rows without a usable diagonal (M_ii <= 0, or 1 / M_ii overflows): the row's own one-dimensional
/// problem is solved by the bound w_i points to (lower_i where w_i > 0, upper_i where w_i < 0);
/// where that bound is infinite no step exists and z_i is kept. Result::detail then says so.
///
/// Converges for symmetric positive semidefinite M with M_ii > 0 if the problem has a solution,
/// slowly where M is badly conditioned; no promise for other M or with coupled limits.
///
/// Endings beside solved (which certify() and judge() alone can give): kIterationLimit, kTimeLimit,
/// kStalled only if the iterate repeats itself bit for bit, so that more sweeps are proven useless,
/// kNumericalBreakdown if a number overflowed or the residual grew by 1 / eps (M is then not
/// positive semidefinite). z is the iterate with the smallest residual that was looked at.
///
/// Cost: a sweep is O(entries of J) or at most O(entries of M). Deterministic but for time_limit.
class Pgs : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit Pgs(const PgsSettings& settings = {});
  ~Pgs() override;

  [[nodiscard]] std::string_view name() const override { return "pgs"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;
  PgsSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
