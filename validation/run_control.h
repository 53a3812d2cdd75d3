#pragma once

#include <atomic>

namespace signorini::validation {

/// Set by a signal handler; runners look at it once a step and stop.
using StopFlag = std::atomic<bool>;

}  // namespace signorini::validation
