#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace signorini::validation {

/// Set by a signal handler; runners look at it once a step and stop.
using StopFlag = std::atomic<bool>;

/// Told after every step: the engine, steps taken, steps in all.
using StepWatcher = std::function<void(const std::string& engine, long step, long steps)>;

}  // namespace signorini::validation
