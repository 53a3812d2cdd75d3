#include "lcp_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  signorini::testing::SIGNORINI_JUDGE(data, size);
  return 0;
}
