#pragma once

#include <signorini/validation/playback.h>

#include <nlohmann/json_fwd.hpp>

namespace signorini::validation {

/// The "playback" of a scene in report.json, docs/report-schema.md: poses and contacts quantised to
/// 16 bits, packed as base64.
[[nodiscard]] nlohmann::ordered_json playback_json(const Playback& playback);

}  // namespace signorini::validation
