#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of BlockPivoting. All are dimensionless.
struct BlockPivotingSettings : SolverSettings {
  /// delta, the weight of the proximal term, of an M whose diagonal is scaled to 1. In [1e-13,
  /// 1e-2].
  /// Larger: redundant rows are pivoted on with better conditioned factors, but more proximal steps
  /// are needed; smaller: rounding of size eps / delta moves the z of redundant rows about.
  double proximal = 1e-10;
  /// How many block exchanges in a row may leave as many wrong rows as the best set had before
  /// single exchanges take over, >= 0; 10 in the source. 0: Murty's method alone after the first
  /// failure.
  int block_trials = 10;
  /// Proximal rounds at most, >= 1.
  int proximal_steps = 100;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Block principal pivoting for an LCP with or without bounds,
///
///     w = M z + q,   lower <= z <= upper,   w_i >= 0 at lower_i, <= 0 at upper_i, 0 in between,
///
/// with Murty's least-index method behind it. For a set C of basic rows z_C solves w_C = 0 while
/// the others stay at their bounds; all rows whose sign is then wrong change sides at once
/// (Kostreva, Block pivot methods for solving the complementarity problem, Linear Algebra Appl. 21,
/// 1978). Where block_trials such exchanges did not lessen the number of wrong rows, only the wrong
/// row of least index changes (Murty, Note on a Bard-type scheme, Opsearch 11, 1974), until the
/// number falls below its least so far (Júdice and Pires, A block principal pivoting algorithm for
/// large-scale strictly monotone linear complementarity problems, Computers Ops Res. 21, 1994). For
/// a P-matrix that ends, in exact arithmetic, after finitely many sets; with bounds, too, by the
/// same induction: with the rows before it solved, w_i is a strictly increasing function of z_i, so
/// that row i changes sides at most twice before a later row changes.
///
/// **Redundant rows.** A semidefinite M is not a P-matrix, and a basic set may have no z_C. So each
/// round of pivoting solves, from the set of the one before,
///
///     w = M z + q + delta (z - c),
///
/// whose matrix is a P-matrix where M is one or is semidefinite (symmetric or not); c is the answer
/// of the round before: the proximal point method (Rockafellar 1976), which converges to a solution
/// of the problem itself wherever there is one; delta is no regularisation of the answer. Where
/// more than 10 + n / 20 single exchanges are needed delta is raised a hundredfold, to at most 1e-2
/// (where Murty's method has no limit), and lowered again from round to round; after a round that
/// did not help it is lowered further, to 1e-13. The certificate judges z for the M that was given,
/// and Result::detail says how many rounds there were, with the least and the largest delta. On an
/// infeasible problem z runs away along a direction that is offered as the ray (Result::ray; an LCP
/// only).
///
/// A factored M is pivoted in body space and never formed (BodySpaceSystem), a given one by a
/// sparse Cholesky or LU. A warm start gives the first set (z strictly between its bounds) and c.
///
/// Endings besides solved: kRayUnproven with a ray, kIterationLimit (max_iterations counts sets, of
/// at most one factorisation each; default 1000 + 20 n), kTimeLimit, kStalled (the rounds no longer
/// help), kNumericalBreakdown (a set could not be factored, or numbers are not finite).
///
/// Cost: one factorisation a set; some 5 to 20 sets for contact problems, 2^n at worst. A solve
/// with a factored M allocates nothing that one of equal size has used before; taking over a given
/// M does.
class BlockPivoting : public Solver {
 public:
  /// @throws std::invalid_argument for settings out of range.
  explicit BlockPivoting(const BlockPivotingSettings& settings = {});
  ~BlockPivoting() override;

  [[nodiscard]] std::string_view name() const override { return "block-pivoting"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;

  BlockPivotingSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
