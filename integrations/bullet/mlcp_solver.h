#pragma once

#include <signorini/lcp/boxed_lcp.h>

#include <BulletDynamics/MLCPSolvers/btMLCPSolverInterface.h>
#include <utility>

namespace signorini::bullet {

/// Solves the mixed LCP that btMLCPSolver forms, for whoever uses that already:
///
///     MlcpSolver mlcp;
///     btMLCPSolver solver(&mlcp);
///
/// Find x with w = A x - b and lo <= x <= hi; w_i >= 0 where x_i = lo_i, w_i <= 0 where x_i = hi_i,
/// w_i = 0 in between. A row with a limit dependency n has the bounds lo_i x_n and hi_i x_n with
/// x_n of the answer: friction is coupled to the normal impulse (Bullet's own Lemke ignores the
/// dependency). A: n x n, dense, 1/kg; b in m/s; x in N s. Bounds of 1e10 and more, which Bullet
/// writes for infinity, are infinite.
///
/// ConstraintSolver does the same without the dense matrix (n^2 numbers) and takes rolling
/// friction, per-row cfm and cones too: prefer it.
class MlcpSolver : public btMLCPSolverInterface {
 public:
  /// How many problems ended how.
  using Counters = lcp::BoxedLcpSolver::Counters;
  /// Who is told of a problem that was not solved.
  using NotSolved = lcp::BoxedLcpSolver::NotSolved;

  /// Problems are handed to the solver `auto`. @throws std::invalid_argument for a setting out of
  /// its range.
  explicit MlcpSolver(const lcp::SolverSettings& settings = {}) : solver_(settings) {}

  /// @param x where to start from, if anything in it is not zero; receives the answer, or the best
  /// iterate
  /// @param iteration_count,use_sparsity not used
  /// @return true only if last_result() is solved: the certificate of x, recomputed from A, b, lo,
  /// hi and the dependencies in double (before a float build rounds x), meets the tolerance.
  /// Otherwise btMLCPSolver falls back to sequential impulses and counts it in getNumFallbacks().
  /// Data that make no problem (sizes that differ, a dependency out of range or on a row that
  /// itself depends, coupled bounds other than -+mu) end as kInvalidInput, detail names the row.
  bool solveMLCP(const btMatrixXu& A, const btVectorXu& b, btVectorXu& x, const btVectorXu& lo,
                 const btVectorXu& hi, const btAlignedObjectArray<int>& limit_dependencies,
                 int iteration_count, bool use_sparsity = true) override;

  /// Of the last problem: status, certificate, statistics and, in double, z = x.
  [[nodiscard]] const lcp::Result& last_result() const { return solver_.last_result(); }
  /// Sums since the solver was made. (btMLCPSolver with split impulse asks twice a group.)
  [[nodiscard]] const Counters& counters() const { return solver_.counters(); }
  /// Is called for every problem that was not solved. null: nobody.
  void set_not_solved(NotSolved visitor) { solver_.set_not_solved(std::move(visitor)); }

 private:
  lcp::BoxedLcpSolver solver_;
  lcp::BoxedLcp rows_;
};

}  // namespace signorini::bullet
