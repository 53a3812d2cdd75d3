#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of the interior-point solver.
struct InteriorPointSettings : SolverSettings {
  /// Iterations when max_iterations is -1; each is one factorisation. Contact problems need 6
  /// to 60.
  static constexpr int kDefaultIterations = 150;

  /// delta of D = x / (y + (C + delta) x), dimensionless, >= 0: a proximal term, which changes the
  /// path and not the answer. 0 breaks down on redundant contacts; 1e-8 stalls at mass ratios of
  /// 1e6.
  double proximal = 1e-12;
  /// Fraction of the way to the boundary that a step goes, in (0, 1).
  double step_fraction = 0.99;
  /// Proximal parameter of the Newton polish, dimensionless, > 0. Smaller converges in fewer outer
  /// steps and needs a more exact inner solve.
  double polish_proximal = 1e-6;
  /// Outer steps of the polish, >= 0; it stops by itself when the residual no longer halves.
  int max_polish_steps = 6;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Interior point and Newton polish for 0 <= f ⊥ A f + q >= 0 with A = J W J^T + c (symmetric
/// positive semidefinite), in body space: the matrix that is factored is H = I + G^T D G, one block
/// a body, never A (whitened_rows.h). Redundant contacts cost nothing and disturb nothing.
///
/// 1. Mehrotra's predictor-corrector on x = S f, y = w / S, x.y -> 0: with r = A x + g - y,
///    (A + Y/X) dx = -r + r_c / X is solved as du = H^-1 G^T D h, dx = D (h - G du). (Mehrotra,
///    SIAM J. Optim. 2, 1992; Wright, Primal-Dual Interior-Point Methods, 1997, chapter 8.)
/// 2. Polish: proximal-point steps x <- argmin_{x >= 0} 1/2 x.A x + g.x + delta/2 |x - x_k|^2, each
/// by
///    semismooth Newton on its dual, the convex piecewise quadratic phi(u) = 1/2 |u|^2 + delta/2
///    |max(0, x_k - (G u + g) / delta)|^2 with an exact line search (Rockafellar 1976; Li, Sun, Toh
///    2018). The last digits come from here, and a solution with exact zeros.
///
/// Takes factored LCPs. Statuses beside solved: kIterationLimit, kTimeLimit, kStalled, and
/// kNumericalBreakdown if a factorisation failed; z is the best iterate that was looked at.
/// An infeasible problem ends as kStalled or kIterationLimit: it proves nothing.
/// Cost: one sparse factorisation of H an iteration (statistics.factorizations), whose analysis is
/// done once.
class InteriorPoint : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit InteriorPoint(const InteriorPointSettings& settings = {});
  ~InteriorPoint() override;

  [[nodiscard]] std::string_view name() const override { return "interior-point"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;
  InteriorPointSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
