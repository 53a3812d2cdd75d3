#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of the accelerated projected gradient method.
struct ApgdSettings : SolverSettings {
  /// Iterations when max_iterations is -1. Piles of equal masses need 1e2 to 5e3 to 1e-8; towers
  /// and large mass ratios far more.
  static constexpr int kDefaultIterations = 20000;

  /// Power iterations that estimate the largest eigenvalue L of the scaled matrix, >= 1.
  int power_iterations = 40;
  /// The estimate is multiplied by this, >= 1; an underestimate is caught and L doubled.
  double lipschitz_margin = 1.3;
  /// Iterations between two looks at the residual, >= 1. A look costs about one iteration.
  int check_period = 10;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Accelerated projected gradient descent with adaptive restart on
///
///     min 1/2 x.(G G^T + C) x + g.x   over   lower <= x <= upper,   x = S z,
///
/// the quadratic programme whose optimality conditions are problem.h's for a symmetric positive
/// semidefinite factored M (whitened_rows.h). One iteration: a gradient step of length 1/L from the
/// extrapolated point, a projection, Nesterov's extrapolation; restarted when the step points
/// uphill (Nesterov 1983; O'Donoghue, Candes 2015, gradient scheme, eq. 13; for contacts Mazhar,
/// Heyn, Negrut, Tasora, ACM Trans. Graph. 34, 2015, algorithm 1, from which the Lipschitz estimate
/// differs: power iteration with a margin, doubled where f(x+) exceeds its quadratic model).
///
/// Takes factored problems with bounds and free rows, not coupled limits. Only products with G and
/// G^T: cheap to low accuracy, slow to high accuracy on towers and at large mass ratios. Statuses
/// beside solved: kIterationLimit, kTimeLimit, kNumericalBreakdown (overflow); z is the best
/// iterate that was looked at. Deterministic but for time_limit.
class Apgd : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit Apgd(const ApgdSettings& settings = {});
  ~Apgd() override;

  [[nodiscard]] std::string_view name() const override { return "apgd"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;
  ApgdSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
