#pragma once

#include <signorini/lcp/certificate.h>
#include <signorini/lcp/status.h>
#include <signorini/lcp/types.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace signorini::lcp {

/// What a solve cost. Counters start at -1: "this solver has no such thing".
struct Statistics {
  int iterations = -1;      ///< sweeps or outer iterations
  int pivots = -1;          ///< exchanges of one basic variable
  int factorizations = -1;  ///< of any matrix, from scratch
  int refinements = -1;     ///< iterative refinement steps
  /// Held by the back-end of a sparse factorisation, whose allocations are not ours.
  std::int64_t factor_bytes = -1;
  double solve_seconds = -1;  ///< wall time of solve(), certificate included
};

/// One solver's part in a solve that tried several.
struct Attempt {
  std::string_view solver;  ///< the name make_solver() knows
  std::string_view reason;  ///< why it was tried, one clause
  Status status = Status::kNotRun;
  double natural_residual = Certificate::kNaN;    ///< of its iterate, see Certificate
  double unit_free_residual = Certificate::kNaN;  ///< of its iterate, see Certificate
  Statistics statistics;
  std::string detail;  ///< Result::detail of the attempt
};

/// What a solve returns. Every member is written on every call.
struct Result {
  Status status = Status::kNotRun;
  std::string solver;  ///< the solver's name, with the variant that ended the solve
  std::string detail;  ///< why it ended so, one line, empty if there is nothing to add. Whatever
                       ///< was done to the problem (scaling apart) is said here.
  Vector z;            ///< n: the answer, or the best iterate, or NaN (see Status)
  Vector w;            ///< n: M z + q, recomputed from the caller's data
  Certificate certificate;  ///< of z; recomputed from the caller's data
  /// With SolverSettings::certify_islands the certificate of every island by itself, measured
  /// against its own |q|_inf, which the q of another island cannot hide; else empty. Islands are
  /// numbered by their first rows (Islands).
  std::vector<Certificate> island_certificates;
  std::vector<int> island_of_row;  ///< n, or empty as island_certificates
  Vector ray;                      ///< y of RayVerdict if the solve ended on a ray, else empty
  double ray_bound = 0.0;          ///< Z: every feasible z has |z|_1 >= Z. 0: nothing is known
  Statistics statistics;
  std::vector<Attempt> attempts;  ///< of a solver that tries others, in order; else empty
};

/// Makes it a result of n rows that was not run, z and w NaN; keeps the memory.
void start_result(Index n, Result& result);

}  // namespace signorini::lcp
