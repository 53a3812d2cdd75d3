#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace signorini::tools {

/// What work in a child process may use. Times are CPU times, so that a busy machine does not end
/// anyone early; a child that waits without computing ends after kWallTimes as much wall time.
struct ChildLimits {
  double seconds = 60.0;          ///< from the first report to the answer, > 0
  double loading_seconds = 60.0;  ///< up to the first report, > 0
  /// Address space on top of what the parent uses; kAnyMemory: no limit. Not enforced under the
  /// sanitizers, whose shadow memory is larger than any limit.
  std::size_t bytes = std::size_t{4} << 30;
};
inline constexpr std::size_t kAnyMemory = std::numeric_limits<std::size_t>::max();
inline constexpr double kWallTimes = 5.0;

/// How a child ended.
enum class ChildEnd : unsigned char {
  kAnswered,     ///< the work returned; its answer is here
  kTimedOut,     ///< killed at the time limit
  kCrashed,      ///< a signal, an exit without an answer, or an exception
  kInterrupted,  ///< this process was told to stop, see stop_children()
};

struct ChildAnswer {
  ChildEnd end = ChildEnd::kCrashed;
  std::string answer;      ///< what the work returned, kAnswered only
  std::string reason;      ///< of kTimedOut and kCrashed: "signal 11 (Segmentation fault)"
  bool is_loaded = false;  ///< the work had called its `loaded` argument
};

/// Work for a child: returns the answer, any bytes; calls `loaded` once what it needs is in place,
/// from when the time limit counts.
using ChildWork = std::function<std::string(const std::function<void()>& loaded)>;

/// Forks, runs the work in the child with the limits, and brings its answer back through a pipe.
/// Whatever the work does (crash, hang, print, exit, exhaust memory), this process goes on: the
/// child is killed at its limit and dies with its parent; its standard output and error are closed.
/// Call from a process with one thread. Cost: one fork.
///
/// @throws std::system_error if there is no pipe or no process to be had.
[[nodiscard]] ChildAnswer run_in_child(const ChildWork& work, const ChildLimits& limits);

/// Another program as the child, under the same limits: `input` is its standard input, what it
/// prints is the answer, an exit other than 0 a crash whose reason is what it printed. All of its
/// time counts against `seconds`; it dies with its parent.
/// @param command the program's file, then its arguments
/// @throws std::system_error as run_in_child()
[[nodiscard]] ChildAnswer run_program(const std::vector<std::string>& command,
                                      std::string_view input, const ChildLimits& limits);

/// Ends the running child, and every later one at once, with kInterrupted. Safe in a signal
/// handler.
void stop_children();
/// True after stop_children().
[[nodiscard]] bool children_are_stopped();

}  // namespace signorini::tools
