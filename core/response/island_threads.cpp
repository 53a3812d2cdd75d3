#include <signorini/core/response/island_threads.h>

#include <algorithm>
#include <atomic>
#include <numeric>

namespace signorini {

IslandThreads::IslandThreads(const IslandSettings& settings, int threads) {
  for (int k = 0; k < threads; ++k) {
    solvers_.emplace_back(settings);
  }
  if (threads > 1) {
    team_ = std::make_unique<lcp::ThreadTeam>(threads);
  }
}

IslandThreads::IslandThreads(IslandThreads&&) noexcept = default;
IslandThreads::~IslandThreads() = default;

void IslandThreads::run(const std::vector<int>& sizes,
                        const std::function<void(int, IslandSolver&)>& solve) {
  const int count = static_cast<int>(sizes.size());
  if (team_ == nullptr || count < 2) {
    for (int k = 0; k < count; ++k) {
      solve(k, solvers_.front());
    }
    return;
  }
  order_.resize(sizes.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(),
            [&](int a, int b) { return sizes[a] != sizes[b] ? sizes[a] > sizes[b] : a < b; });
  thrown_.assign(sizes.size(), nullptr);
  std::atomic<int> next{0};
  auto work = [&](int member) {
    for (int k = next++; k < count; k = next++) {
      try {
        solve(order_[k], solvers_[member]);
      } catch (...) {
        thrown_[order_[k]] = std::current_exception();
      }
    }
  };
  team_->run(work);
  for (const std::exception_ptr& exception : thrown_) {
    if (exception != nullptr) {
      std::rethrow_exception(exception);
    }
  }
}

}  // namespace signorini
