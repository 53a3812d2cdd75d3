#pragma once

#include <string>

namespace signorini::bench {

/// Writes folder/name.csv, whole or not at all, and says so; nothing where the folder is empty.
/// @throws std::runtime_error where it cannot be written
void write_csv(const std::string& folder, const std::string& name, const std::string& csv);

}  // namespace signorini::bench
