#include "bench/write_csv.h"

#include <signorini/lcp/io/whole_file.h>

#include <filesystem>
#include <fmt/format.h>

namespace signorini::bench {

void write_csv(const std::string& folder, const std::string& name, const std::string& csv) {
  if (folder.empty()) {
    return;
  }
  const std::filesystem::path file = std::filesystem::path(folder) / (name + ".csv");
  lcp::write_whole_file(file, csv);
  fmt::print("written: {}\n", file.string());
}

}  // namespace signorini::bench
