#pragma once

#include <signorini/validation/report.h>
#include <signorini/validation/scene_run.h>

#include <functional>
#include <string>
#include <vector>

namespace signorini::validation {

/// A report made again from its folder alone: the scenes' files and the arguments in report.json.
struct RepeatedReport {
  std::size_t scenes = 0;
  std::size_t numbers = 0;  ///< that were compared
  /// Where the two differ, "scenes[3].checks[0].value: 0.25, again 0.26".
  std::vector<std::string> differences;
};

/// Runs every scene of a report's folder again and compares each number and text with report.json,
/// bit by bit. Times, and what follows from times ("losses"), are left out, and so is `version`,
/// `engines` and `command`.
/// @param stop null, or a flag that ends it early
/// @param on_scene called before each scene with its number, how many there are, and its name
/// @throws InputError naming the file that is missing or that is no report of this schema version
/// @throws RunInterrupted
[[nodiscard]] RepeatedReport repeat_report(
    const std::string& folder, const StopFlag* stop,
    const std::function<void(std::size_t, std::size_t, const std::string&)>& on_scene);

}  // namespace signorini::validation
