#pragma once

#include <signorini/core/response/island_solver.h>
#include <signorini/lcp/thread_team.h>

#include <exception>
#include <functional>
#include <memory>
#include <vector>

namespace signorini {

/// Threads that solve islands, each with an IslandSolver of its own: the same bits for any number
/// of threads, since what an island's answer is depends on the island alone. The team is
/// lcp::ThreadTeam, which wakes in microseconds, needs no library, and keeps its threads to itself.
class IslandThreads {
 public:
  /// @param threads >= 1; 1: the caller's alone
  IslandThreads(const IslandSettings& settings, int threads);
  IslandThreads(IslandThreads&&) noexcept;
  ~IslandThreads();

  /// Calls solve(island, solver) once for every island, the largest first, and returns when all are
  /// done. What it threw for the island of the lowest number is thrown again.
  /// @param sizes one an island: only when which is taken depends on it
  /// @param solve std::ref() of a lambda costs no allocation
  void run(const std::vector<int>& sizes,
           const std::function<void(int island, IslandSolver& solver)>& solve);

 private:
  std::vector<IslandSolver> solvers_;  // one a thread
  std::unique_ptr<lcp::ThreadTeam> team_;
  std::vector<int> order_;
  std::vector<std::exception_ptr> thrown_;
};

}  // namespace signorini
