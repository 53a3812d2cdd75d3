#pragma once

#include <signorini/lcp/solve_recorder.h>
#include <signorini/lcp/status.h>

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

/// Solves random small LCPs whose data are exact in binary (exactness_families.h: small integers
/// and dyadic fractions; PSD with redundancy, P, copositive friction forms, infeasible, degenerate;
/// n = 1..12) with every solver of make_solver() that takes them, and judges every claim in
/// rational arithmetic (rational_judge.h): the residual of every `solved`, the ray of every
/// `infeasible`, the bound of every `no solution below Z`. Needs GMP.
struct ExactnessOptions {
  int problems = 100000;    ///< >= 0; the families take turns
  std::uint64_t seed = 1;   ///< problem k of a seed is the same whatever `problems` is
  double tolerance = 1e-8;  ///< of the solvers, and what `solved` is judged by. Dimensionless, > 0
  int pgs_sweeps = 1000;    ///< PGS, PSOR, NNCG give up here; slow convergence costs time only
  lcp::SolveRecorder* recorder = nullptr;  ///< is told of every solve
};

/// One line of the table: how one solver ended on one family, and how often the problem had a
/// solution when it did.
struct ExactnessRow {
  std::string family;
  std::string solver;
  lcp::Status status = lcp::Status::kNotRun;
  int count = 0;
  int with_solution = 0;     ///< a solution exists
  int without_solution = 0;  ///< proven that none exists
  int undecided = 0;         ///< neither is known
};

/// What was counted.
struct ExactnessCounts {
  int problems = 0;
  int wrong_solved = 0;      ///< residual above the tolerance in rational arithmetic: must be 0
  int wrong_infeasible = 0;  ///< ray that does not prove it, or a solution exists: must be 0
  int wrong_bound = 0;       ///< Z above the ray's bound or above a solution: must be 0
  /// Exact Lemke neither solved nor disproved a problem where theory promises one: must be 0.
  int undecided_promises = 0;
  int ray_unproven = 0;  ///< endings of floating Lemke on a ray that proves nothing
  /// Lemke did not solve a problem that has a solution, where the theory of the family promises it.
  int broken_promises = 0;
  /// Lemke did not prove that there is no solution, where in exact arithmetic its ray would: it
  /// ended in `no solution below Z` or less, its ray in doubles not being one that proves it.
  int weaker_proofs = 0;
  /// Lemke did not solve a problem that has a solution; the theory promises nothing.
  int missed = 0;
  std::vector<ExactnessRow> rows;
  /// Every wrong claim, broken or undecided promise, with its problem, written out; 20 at most.
  std::vector<std::string> complaints;

  /// Claims of ours that are not true. Endings without a claim are no part of it.
  [[nodiscard]] int wrong() const { return wrong_solved + wrong_infeasible + wrong_bound; }
  /// The rows, one a line, with a header line; RFC 4180.
  [[nodiscard]] std::string to_csv() const;
};

/// Prints the table (family, solver, status, counts), the sums and the complaints to out; progress
/// to stderr when that is a terminal.
/// @throws std::invalid_argument for options out of range. Cost: about a millisecond a problem.
ExactnessCounts run_exactness_study(const ExactnessOptions& options, std::ostream& out);

}  // namespace signorini::bench
