#pragma once

#include <signorini/lcp/boxed_lcp.h>

#include <dart/constraint/BoxedLcpSolver.hpp>
#include <string>
#include <utility>

/// (The folder is called dart; a namespace signorini::dart would hide DART's own.)
namespace signorini::dartsim {

/// Solves DART's boxed LCPs, in place of its Dantzig and projected Gauss-Seidel:
///
///     auto lcp = std::make_shared<signorini::dartsim::BoxedLcpSolver>();
///     world->setConstraintSolver(
///         std::make_unique<dart::constraint::BoxedLcpConstraintSolver>(lcp));
///
/// DART makes one problem of every group of bodies that touch or are joined, in each step:
/// w = A x - b, lo <= x <= hi, friction coupled to the normal impulse (lcp/boxed_lcp.h has the
/// equations; its pyramid |x_i| <= mu x_n has four sides). A in 1/kg, b in m/s, x in N s, or in
/// the units of a joint's rows.
///
/// Nothing is silent: the status of every problem is counted, the last result kept, and
/// set_not_solved() names who is told at once. DART does not look at what solve() returns unless it
/// has a second solver: it then applies the best iterate. With a second solver (the two-argument
/// constructor) it discards our iterate and runs that one where we return false.
///
/// Not for two threads at once.
class BoxedLcpSolver : public ::dart::constraint::BoxedLcpSolver {
 public:
  /// How many problems ended how.
  using Counters = lcp::BoxedLcpSolver::Counters;
  /// Who is told of a problem that was not solved.
  using NotSolved = lcp::BoxedLcpSolver::NotSolved;

  /// Problems are handed to the solver `auto`. @throws std::invalid_argument for a setting out of
  /// its range.
  explicit BoxedLcpSolver(const lcp::SolverSettings& settings = {}) : solver_(settings) {}

  /// "SignoriniBoxedLcpSolver"
  const std::string& getType() const override { return getStaticType(); }
  static const std::string& getStaticType();

  /// As DART calls it; A, b, lo, hi and findex are left as they are.
  ///
  /// @param n rows
  /// @param A n rows, each padded to a multiple of four numbers (n = 1: not padded)
  /// @param x where to start from, if anything in it is not zero; receives the answer, or the best
  /// iterate; 0 after kInvalidInput
  /// @param nub the first nub rows are unbounded, whatever lo and hi say
  /// @param lo,hi bounds, -+infinity allowed; with a findex hi is mu, and lo must be -mu
  /// @param findex the normal row of a friction row; negative or the row itself: none
  /// @param early_termination not used: every problem is solved as far as it can be
  /// @return true only if last_result() is solved: the certificate of x, recomputed from A, b, lo,
  /// hi and findex, meets the tolerance. Data that make no problem (see lcp::BoxedLcpSolver) end as
  /// kInvalidInput, detail names the row.
  bool solve(int n, double* A, double* x, double* b, int nub, double* lo, double* hi, int* findex,
             bool early_termination = false) override;

  /// Every A can be tried. DART declares this in its debug builds alone, last of its virtual
  /// functions, and Debian's library is one: declared in every build of ours, it has that place in
  /// the table of either.
  virtual bool canSolve(int /*n*/, const double* /*A*/) { return true; }

  /// Of the last problem, which is one group of a step: status, certificate, statistics, z.
  [[nodiscard]] const lcp::Result& last_result() const { return solver_.last_result(); }
  /// Sums since the solver was made: one a group and step.
  [[nodiscard]] const Counters& counters() const { return solver_.counters(); }
  /// Is called for every problem that was not solved, before DART applies x. null: nobody.
  void set_not_solved(NotSolved visitor) { solver_.set_not_solved(std::move(visitor)); }

 private:
  lcp::BoxedLcpSolver solver_;
  lcp::BoxedLcp rows_;
};

}  // namespace signorini::dartsim
