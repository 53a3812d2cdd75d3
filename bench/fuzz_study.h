#pragma once

#include <signorini/lcp/solver.h>

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace signorini::bench {

/// "Never a lie": solvers on random and adversarial problems (fuzz_problems.h), every claim judged
/// (claim_judge.h: intervals in long double where they decide, else rationals), in child processes
/// with a watchdog, so that hangs and crashes are counted and named. Needs GMP.
struct FuzzOptions {
  std::int64_t first = 0;           ///< >= 0; problem k of a seed is the same in every range
  std::int64_t problems = 1000000;  ///< >= 0, for each solver; those it refuses are counted apart
  std::uint64_t seed = 1;
  std::string solver = "all";  ///< a name that make_solver() knows, or all of them
  double tolerance = 1e-8;     ///< of the solvers and of the judge
  int max_iterations = 1000;   ///< of every solver: pivots, sweeps, iterations
  /// Every so many problems, LCPs of at most 12 rows are also solved by exact Lemke (at most 500
  /// pivots): no proof may contradict a solution. > 0
  std::int64_t truth_every = 100;
  /// Every problem is solved a second time, judged and counted as well, from the first answer with
  /// noise: of 1e-10, 1e-6, 1 % and all of its size in turn.
  bool warm = false;
  double hang_seconds = 20.0;  ///< a problem that takes longer is a hang, > 0
  bool in_children = true;     ///< false: in this process, for debuggers; a crash is then a crash
};

/// What was counted for one solver.
struct FuzzRow {
  std::string solver;
  std::int64_t judged = 0;            ///< solves of problems that it took
  std::int64_t refused = 0;           ///< problems that it does not take
  std::int64_t solved = 0;            ///< solved and solved to rounding
  std::int64_t proofs = 0;            ///< infeasible and no solution below Z
  std::int64_t invalid = 0;           ///< invalid input
  std::int64_t others = 0;            ///< no claim
  std::int64_t by_rationals = 0;      ///< claims that intervals did not decide
  std::int64_t with_solution = 0;     ///< of the sample: exact Lemke found a solution
  std::int64_t without_solution = 0;  ///< of the sample: exact Lemke proved that there is none
  std::int64_t sample_solved = 0;     ///< of with_solution: solved by this solver
  std::int64_t wrong_solved = 0;      ///< must be 0, as all that follow
  std::int64_t wrong_proofs = 0;
  std::int64_t wrong_others = 0;  ///< a malformed result, or bad input not called so
  std::int64_t hangs = 0;
  std::int64_t crashes = 0;  ///< signals and exceptions
  double seconds = 0.0;      ///< wall time, judging included

  [[nodiscard]] std::int64_t wrong() const {
    return wrong_solved + wrong_proofs + wrong_others + hangs + crashes;
  }
};

struct FuzzCounts {
  std::vector<FuzzRow> rows;
  /// Everything wrong, with seed, index and recipe; 20 a solver at most.
  std::vector<std::string> complaints;
  bool is_interrupted = false;

  [[nodiscard]] std::int64_t wrong() const;
  /// The rows, one a line, with a header line; RFC 4180.
  [[nodiscard]] std::string to_csv() const;
};

/// A solver under test.
struct FuzzSolver {
  std::string name;
  std::function<std::unique_ptr<lcp::Solver>(const lcp::SolverSettings&)> make;
};

/// Those that make_solver() knows.
[[nodiscard]] std::vector<FuzzSolver> registered_solvers();

/// Prints a line a solver, then the complaints, to out; progress to stderr when that is a terminal.
/// @throws std::invalid_argument for options out of range or a solver that is not among `solvers`
FuzzCounts run_fuzz_study(const FuzzOptions& options, std::ostream& out,
                          const std::vector<FuzzSolver>& solvers = registered_solvers());

}  // namespace signorini::bench
