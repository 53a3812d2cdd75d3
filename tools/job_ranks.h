#pragma once

#include "tools/job_crew.h"

#include <memory>
#include <vector>

namespace signorini::tools {

/// All ranks as one crew, each with one worker. The worker is forked before MPI_Init() and knows
/// nothing of MPI; the rank itself only passes messages on. The first rank leads: to it the others
/// are hands. Leaving it is MPI_Finalize().
class RankCrew : public JobCrew {
 public:
  [[nodiscard]] virtual bool leads() const = 0;
  /// On the other ranks: passes jobs to the worker until the first rank has no more.
  virtual void serve() = 0;
};

/// Call once a process. @throws std::invalid_argument in a build without MPI
[[nodiscard]] std::unique_ptr<RankCrew> join_ranks(const std::vector<Job>& jobs);

}  // namespace signorini::tools
