// The fuzzers' targets on bytes that every compiler makes, and on the kept corpus: a short run in
// the tests.
#include "kept_inputs.h"
#include "lcp_bytes.h"

#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

namespace signorini::testing {
namespace {

using Judge = void (*)(const std::uint8_t*, std::size_t);

/// Random bytes, every other time few different ones.
void judge_random(Judge judge, int times, std::size_t longest) {
  std::mt19937_64 random(20240901);  // NOLINT: fixed, so that a failure comes again
  std::vector<std::uint8_t> bytes;
  for (int k = 0; k < times; ++k) {
    bytes.resize(random() % longest);
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(k % 2 == 0 ? random() : (random() % 4) * 5);
    }
    judge(bytes.data(), bytes.size());
  }
  judge(nullptr, 0);
}

void judge_corpus(Judge judge, const std::string& name) {
  for (const auto& bytes : kept_inputs(name)) {
    judge(bytes.data(), bytes.size());
  }
}

TEST(FuzzReplay, Lemke) {
  judge_random(judge_lemke_bytes, 3000, 300);
  judge_corpus(judge_lemke_bytes, "lemke");
}

TEST(FuzzReplay, CApi) {
  judge_random(judge_c_bytes, 1000, 1500);
  judge_corpus(judge_c_bytes, "c");
}

#ifdef SIGNORINI_HAS_IO
TEST(FuzzReplay, ProblemFolder) {
  judge_random(judge_folder_bytes, 100, 500);
  judge_corpus(judge_folder_bytes, "folder");
}
#endif

#ifdef SIGNORINI_HAS_HDF5
TEST(FuzzReplay, Fclib) {
  judge_random(judge_fclib_bytes, 100, 300);
  judge_corpus(judge_fclib_bytes, "fclib");
}
#endif

}  // namespace
}  // namespace signorini::testing
