#pragma once

#include "bench/peers_study.h"
#include "bench/tradeoff.h"
#include "tools/job_list.h"

#include <string>
#include <vector>

namespace signorini::bench {

/// Every solver on every series of problems, a job each, at every position of the dial. The jobs
/// give what run_peers_study() would, position by position.
class ProblemTrade {
 public:
  /// @param dial tolerances that the solvers are told
  /// @throws std::invalid_argument if options.solvers names an unknown one.
  ProblemTrade(const PeerProblemOptions& problems, const PeersOptions& options,
               std::vector<double> dial);
  [[nodiscard]] std::vector<tools::Job> jobs() const;
  /// The runs of the jobs that are done, problem by problem, all solvers of one together.
  /// @param results of the jobs, in their order
  [[nodiscard]] std::vector<DialRuns> runs(const std::vector<tools::JobResult>& results) const;
  [[nodiscard]] std::size_t problem_count() const { return problem_count_; }
  [[nodiscard]] std::size_t solver_count() const { return contestants_.size(); }

 private:
  struct Series {
    std::vector<PeerProblem> problems;
  };
  PeersOptions options_;
  std::vector<double> dial_;
  std::vector<PeersContestant> contestants_;
  std::vector<Series> series_;
  std::size_t problem_count_ = 0;
};

}  // namespace signorini::bench
