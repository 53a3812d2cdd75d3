#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>

namespace signorini::tools {

/// Seconds since it was made: wall time, or this process's CPU time where that is less, because
/// others had the processor meanwhile. (The CPU clock is slow to read, so that wall time is the
/// lesser one of what takes microseconds.) For work on one thread.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
    return std::min(wall.count(), cpu_seconds() - cpu_start_);
  }

 private:
  static double cpu_seconds() {
    timespec time = {};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double cpu_start_ = cpu_seconds();
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace signorini::tools
