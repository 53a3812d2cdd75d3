#pragma once

#include <cstdint>
#include <iosfwd>

namespace signorini::bench {

/// Solves random small LCPs whose data are exact in binary (small integers and dyadic fractions: PSD with
/// redundancy, P, copositive friction forms, infeasible, degenerate; n = 1..12) and judges every claim in
/// rational arithmetic: the residual of every `solved`, the ray of every `infeasible`.
struct ExactnessOptions {
  int problems = 100000;
  std::uint64_t seed = 1;
};

struct ExactnessCounts {
  int problems = 0;
  int wrong_solved = 0;      ///< residual above the tolerance in rational arithmetic: must be 0
  int wrong_infeasible = 0;  ///< ray that does not prove it: must be 0
};

/// Prints a table (family, status, count) to out; progress to stderr when that is a terminal.
ExactnessCounts run_exactness_study(const ExactnessOptions& options, std::ostream& out);

}  // namespace signorini::bench
