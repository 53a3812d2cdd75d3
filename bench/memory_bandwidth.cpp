#include "bench/memory_bandwidth.h"

#include <signorini/lcp/thread_team.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace signorini::bench {

double measure_memory_bandwidth(int threads) {
  constexpr std::size_t kNumbers = std::size_t{1} << 24;
  constexpr int kPasses = 5;
  std::vector<double> a(kNumbers, 0.0);
  const std::vector<double> b(kNumbers, 1.0);
  const std::vector<double> c(kNumbers, 2.0);
  lcp::ThreadTeam team(threads);
  double best = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const double scale = 1.0 + pass;
    auto work = [&](int member) {
      const std::size_t begin = kNumbers * member / threads;
      const std::size_t end = kNumbers * (member + 1) / threads;
      for (std::size_t i = begin; i < end; ++i) {
        a[i] = b[i] + scale * c[i];
      }
    };
    const auto start = std::chrono::steady_clock::now();
    team.run(work);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    best = std::max(best, 3.0 * sizeof(double) * kNumbers / spent.count());
  }
  volatile double seen = a[kNumbers / 2];  // so that no pass is left out
  static_cast<void>(seen);
  return best;
}

}  // namespace signorini::bench
