// The fuzzer's target on the kept scenes, whole, cut short, and with single bytes changed.
#include "sdf_bytes.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <random>
#include <vector>

namespace signorini::testing {
namespace {

TEST(FuzzReplay, Sdf) {
  std::mt19937 random(20240901);  // NOLINT: fixed, so that a failure comes again
  int judged = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(SIGNORINI_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / "sdf")) {
    std::ifstream file(entry.path(), std::ios::binary);
    std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    judge_sdf_bytes(bytes.data(), bytes.size());
    for (int k = 0; k < 8; ++k) {
      std::vector<std::uint8_t> changed = bytes;
      changed[random() % changed.size()] = static_cast<std::uint8_t>(random() % 96 + 32);
      judge_sdf_bytes(changed.data(), changed.size());
    }
    judge_sdf_bytes(bytes.data(), random() % bytes.size());
    ++judged;
  }
  EXPECT_GT(judged, 0);
  judge_sdf_bytes(nullptr, 0);
}

}  // namespace
}  // namespace signorini::testing
