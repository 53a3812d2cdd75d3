// The fuzzer's target on bytes that every compiler makes, and on the kept corpus: a short run in
// the tests.
#include "collision_bytes.h"
#include "kept_inputs.h"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace signorini::collision::testing {
namespace {

TEST(CollisionBytes, KeepEveryPromise) {
  std::mt19937_64 random(20240901);  // NOLINT: fixed, so that a failure comes again
  std::vector<std::uint8_t> bytes;
  for (int k = 0; k < 500; ++k) {
    bytes.resize(static_cast<std::size_t>(random() % 160));
    const bool plain = k % 2 == 0;
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(plain ? random() : (random() % 4) * 64);
    }
    judge_bytes(bytes.data(), bytes.size());
  }
}

TEST(CollisionBytes, KeptInputsKeepThemToo) {
  for (const auto& bytes : signorini::testing::kept_inputs("collision")) {
    judge_bytes(bytes.data(), bytes.size());
  }
}

TEST(CollisionBytes, NothingAtAllIsAnInputToo) {
  judge_bytes(nullptr, 0);
}

}  // namespace
}  // namespace signorini::collision::testing
