#pragma once

#include "bench/peer_runner.h"
#include "tools/byte_archive.h"

#include <vector>

namespace signorini::bench {

/// What a solver in another program is asked to do: the problem, M formed, and how it is run.
struct PeerTask {
  std::vector<double> M;  ///< n x n, by columns
  std::vector<double> q;
  std::vector<double> lower;  ///< n, or empty: 0
  std::vector<double> upper;  ///< n, or empty: infinity
  std::vector<lcp::CoupledLimit> coupled;
  PeerSettings settings;
  RunLimits limits;
};
void visit_fields(auto& archive, tools::Reflects<PeerTask> auto& task) {
  archive(task.M, task.q, task.lower, task.upper, task.coupled, task.settings, task.limits);
}

/// @throws std::invalid_argument for friction cones. Cost: n^2 numbers.
[[nodiscard]] PeerTask peer_task(const lcp::Problem& problem, const PeerSettings& settings,
                                 const RunLimits& limits);
/// The problem of a task. @throws std::invalid_argument if its sizes differ
[[nodiscard]] lcp::Problem problem_of(const PeerTask& task);

}  // namespace signorini::bench
