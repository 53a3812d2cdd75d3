// The fuzzer's target on the kept scenes, whole, cut short, and with single bytes changed.
#include "kept_inputs.h"
#include "sdf_bytes.h"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace signorini::testing {
namespace {

TEST(FuzzReplay, Sdf) {
  std::mt19937 random(20240901);  // NOLINT: fixed, so that a failure comes again
  for (const auto& bytes : kept_inputs("sdf")) {
    judge_sdf_bytes(bytes.data(), bytes.size());
    for (int k = 0; k < 8; ++k) {
      std::vector<std::uint8_t> changed = bytes;
      changed[random() % changed.size()] = static_cast<std::uint8_t>(random() % 96 + 32);
      judge_sdf_bytes(changed.data(), changed.size());
    }
    judge_sdf_bytes(bytes.data(), random() % bytes.size());
  }
  judge_sdf_bytes(nullptr, 0);
}

}  // namespace
}  // namespace signorini::testing
