#pragma once

#include <signorini/validation/report.h>

#include <string>
#include <string_view>

namespace signorini::validation {

/// A scene's report as bytes, from one process of this program to another, and back.
[[nodiscard]] std::string scene_report_bytes(const SceneReport& report);
/// @throws std::runtime_error if these are no such bytes.
[[nodiscard]] SceneReport scene_report_from_bytes(std::string_view bytes);

}  // namespace signorini::validation
