#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace signorini::testing {

/// What a fuzzer found worth keeping: the files of tests/fuzz/corpus/NAME, by name; none is empty.
inline std::vector<std::vector<std::uint8_t>> kept_inputs(const std::string& name) {
  const std::filesystem::directory_iterator folder(std::filesystem::path(SIGNORINI_SOURCE_DIR) /
                                                   "tests" / "fuzz" / "corpus" / name);
  const std::set<std::filesystem::path> paths(begin(folder), end(folder));
  EXPECT_FALSE(paths.empty()) << name;
  std::vector<std::vector<std::uint8_t>> inputs;
  for (const std::filesystem::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    EXPECT_FALSE(inputs.back().empty()) << path;
  }
  return inputs;
}

}  // namespace signorini::testing
