#pragma once

#include <filesystem>
#include <string>

namespace signorini::bench {

/// The file of a program that is installed, or was built, beside this one.
[[nodiscard]] std::filesystem::path sibling_program(const std::string& name);

}  // namespace signorini::bench
