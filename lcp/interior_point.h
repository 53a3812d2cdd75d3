#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of the interior-point solver.
struct InteriorPointSettings : SolverSettings {
  /// Iterations when max_iterations is -1; each is one factorisation. Contact problems need 6
  /// to 60.
  static constexpr int kDefaultIterations = 150;

  /// Added to the diagonal of the scaled matrix, dimensionless, >= 0: a proximal term, which
  /// changes the path and not the answer. 0 breaks down on redundant contacts; 1e-8 stalls at mass
  /// ratios of 1e6. Where a factorisation fails it is raised, at most to 1e-6, and the result says
  /// so.
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

/// Interior point and Newton polish for problems with bounds and free rows,
///
///     w = M z + q,   lower <= z <= upper,   w_i >= 0 at lower, <= 0 at upper, = 0 in between.
///
/// In scaled coordinates (shifted_system.h: A with unit diagonal, x = S z, g = q / S):
/// 1. Mehrotra's predictor-corrector with a barrier for every bound, s = x - lower with multiplier
///    y, t = upper - x with multiplier v: with r = A x + g - y + v,
///    (A + Y/S + V/T + proximal) dx = -r + c_s / s - c_t / t. (Mehrotra, SIAM J. Optim. 2, 1992;
///    Wright, Primal-Dual Interior-Point Methods, 1997, chapter 8.) Free rows have no barrier: the
///    proximal term moves them by exact Newton steps on w_i = 0.
///    Where contacts of bodies have no upper bounds, forces add up from contact to contact to a
///    size that nobody knows beforehand: the cold start is ten times as large as q asks of one
///    contact alone (a hundred times where masses are not within 1 to 100), and a hundred times
///    larger again as long as the first step all but stands still.
/// 2. As soon as the iterate is no longer far away (a residual of 0.3, or a start that just had to
///    grow) and the active set that it points at has settled (0.5 % of the rows and three at most
///    changed), Newton on that set (active_set_newton.h): usually one to three factorisations to
///    the last digits.
/// 3. Where the set does not settle (degenerate contacts): proximal Newton from the interior
///    (proximal_newton.h; factored M only).
///
/// A factored M, A = J W J^T + c, is never formed: what is factored is H = I + G^T D G, one block a
/// body (whitened_rows.h). Redundant contacts cost nothing and disturb nothing. A given M may be
/// nonsymmetric; the method is made for semidefinite M, whatever else it solves.
///
/// A warm start is tried as an active set first; if that fails, M is symmetric and the best
/// residual so far is below 0.3, by smoothing from there (smoothing_newton.h: 14 factorisations at
/// most, and 6 of proximal Newton, each at most max_iterations); not after sweeps. Where contacts
/// of bodies have no upper bounds and masses within 1 to 100, two things are tried besides. If a
/// factorisation costs much beside a sweep (by its flops a row: piles, whose graph of bodies has
/// large separators), 200 sweeps of Nncg, or 60 from a warm start, find the contacts that press to
/// within a few; their set is mostly settled by one to three factorisations, and the result says
/// so. Else, without a warm start, the set of all rows: at rest nearly all contacts press, and one
/// or two factorisations are all; if not, that costs one to three more.
///
/// Takes no coupled limits and no cones. Statuses beside solved: kIterationLimit, kTimeLimit,
/// kStalled, and kNumericalBreakdown if a factorisation failed; z is the best iterate that was
/// looked at. An infeasible problem ends as kStalled or kIterationLimit: it proves nothing.
/// Cost: one sparse factorisation an iteration (statistics.factorizations), whose analysis is done
/// once, and not at all when the last problem had the same pattern.
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
