#pragma once

#include <signorini/lcp/io/input_error.h>
#include <signorini/lcp/problem.h>
#include <signorini/lcp/solver.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace signorini::lcp {

/// A problem file with what a dump left beside the problem (dump_recorder.h), for a replay.
struct RecordedSolve {
  Problem problem;
  Vector warm_start;   ///< what the solve started from; empty: cold, or not known
  std::string solver;  ///< the name make_solver() knows; empty: not known
  SolverSettings settings;
  std::string status;  ///< its text; empty: not known
  int work = -1;       ///< pivots or iterations, the larger counter; -1: not known
  double seconds = -1.0;
  std::vector<std::string> notes;  ///< FclibProblem::notes
};

/// Reads a problem folder with warm_start.txt and record.json where they exist, or an FCLIB HDF5
/// file (.hdf5, .h5) with its first guess. @throws InputError
[[nodiscard]] RecordedSolve read_recorded_solve(const std::filesystem::path& path);

/// The problem folders and HDF5 files in a folder, in the order of their names. A folder that is
/// itself a problem is the only one. @throws InputError if there is none, or no such folder
[[nodiscard]] std::vector<std::filesystem::path> list_problems(const std::filesystem::path& folder);

/// Reads one number a line: z.txt, warm_start.txt. @param size how many there must be
/// @throws InputError
[[nodiscard]] Vector read_numbers(const std::filesystem::path& file, Index size);

}  // namespace signorini::lcp
