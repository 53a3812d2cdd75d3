#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/result.h>

#include <string>
#include <string_view>

namespace signorini::lcp {

struct SolverSettings;

/// One finished solve, as its recorder sees it. References end with the call.
struct SolveRecord {
  std::string_view solver;  ///< the name make_solver() knows
  const SolverSettings& settings;
  const Problem& problem;
  const Vector* warm_start;  ///< null: a cold start
  const Result& result;
};

/// Is told of every solve of the solvers whose settings name it; io writes them to files with one
/// (io/dump_recorder.h). A solver that runs others tells of its own solve alone.
class SolveRecorder {
 public:
  virtual ~SolveRecorder() = default;

  /// Called at the end of Solver::solve(), also where the problem was not solved or not valid. Its
  /// time is no part of solve_seconds. Whatever it throws is caught and said in result.detail; it
  /// changes nothing else of the result.
  /// @return what there is to say about the recording, for result.detail; normally empty
  virtual std::string record(const SolveRecord& record) = 0;
};

}  // namespace signorini::lcp
