#pragma once

#include <ctime>

namespace signorini::bench {

/// Seconds of CPU time of the calling thread: what else runs on the machine does not count. For
/// work on one thread.
[[nodiscard]] inline double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace signorini::bench
