#pragma once

#include <filesystem>
#include <string>

namespace signorini::tools {

/// A file's path, size and time of its last change, as one line: whether it is still the same. Of a
/// file that is not there, path and "absent".
[[nodiscard]] std::string file_state(const std::filesystem::path& file);

/// That of every shared library of this process, a line each, sorted.
[[nodiscard]] std::string library_states();

}  // namespace signorini::tools
