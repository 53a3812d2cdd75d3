#include "tools/file_state.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <link.h>
#include <system_error>
#include <vector>

namespace signorini::tools {

std::string file_state(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) {
    return file.string() + " absent";
  }
  const auto time = std::filesystem::last_write_time(file, error);
  return fmt::format("{} {} {}", file.string(), size, time.time_since_epoch().count());
}

std::string library_states() {
  std::vector<std::string> states;
  ::dl_iterate_phdr(
      [](dl_phdr_info* library, std::size_t, void* all) {
        const std::string name = library->dlpi_name;  // empty: the program; no file: the kernel's
        if (!name.empty() && std::filesystem::exists(name)) {
          static_cast<std::vector<std::string>*>(all)->push_back(file_state(name));
        }
        return 0;
      },
      &states);
  std::sort(states.begin(), states.end());
  return fmt::format("{}", fmt::join(states, "\n"));
}

}  // namespace signorini::tools
