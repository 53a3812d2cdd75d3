#pragma once

#include <span>
#include <string_view>

namespace signorini::validation {

/// A scene file that travels inside the program.
struct EmbeddedScene {
  std::string_view name;  ///< the file's name without .sdf
  std::string_view text;
};

/// validation/scenes/*.sdf, in alphabetical order.
[[nodiscard]] std::span<const EmbeddedScene> embedded_scenes();

}  // namespace signorini::validation
