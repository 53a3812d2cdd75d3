#pragma once

#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

/// Replays a sequence of problems, as SIGNORINI_DUMP leaves them (lcp/io/dump_recorder.h), in the
/// order of their names, with one solver object, every problem cold and warm. The warm start is the
/// recorded one; where none was recorded, the answer of the problem before, if that has as many
/// rows; else there is no warm solve.
struct SequenceOptions {
  std::filesystem::path folder;  ///< problem folders and .hdf5 files
  std::string solver = "lemke";  ///< a name that make_solver() knows, or "recorded": each record's
  lcp::SolverSettings lcp;
  int repeats = 1;  ///< >= 1; times are the least of so many solves
};

/// One solve of a problem.
struct SequenceSolve {
  bool ran = false;
  lcp::Status status = lcp::Status::kNotRun;
  int work = -1;  ///< pivots or iterations, the larger counter
  int factorizations = -1;
  double seconds = -1.0;
  double unit_free_residual = -1.0;
};

struct SequenceRow {
  std::string name;
  int rows = 0;
  std::string solver;
  std::string recorded_status;  ///< empty: not known
  double recorded_seconds = -1.0;
  SequenceSolve cold;
  SequenceSolve warm;
  std::string refused;  ///< why the solver does not take the problem; empty: it does
};

struct SequenceCounts {
  std::vector<SequenceRow> rows;
  /// Solves, cold and warm, that did not end solved or solved to rounding, refused ones included.
  [[nodiscard]] int unsolved() const;
  /// The rows, one a line, with a header line; RFC 4180.
  [[nodiscard]] std::string to_csv() const;
};

/// Prints a line a problem and the sums to out.
/// @throws InputError for a folder or problem that cannot be read, std::invalid_argument for
/// options out of range
SequenceCounts run_sequence_study(const SequenceOptions& options, std::ostream& out);

}  // namespace signorini::bench
