#pragma once

#include <filesystem>
#include <string_view>

namespace signorini::tools {

/// Write a file whole or not at all: the text goes to a new file beside it (the same name with
/// ".partial-" and the process id), which is renamed over the old one once all of it is written.
///
/// @throws std::runtime_error naming the file and the system's reason. The file is then as it was
///   before, and nothing is left beside it.
void write_whole_file(const std::filesystem::path& file, std::string_view text);

}  // namespace signorini::tools
