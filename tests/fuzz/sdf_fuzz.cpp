#include "sdf_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  signorini::testing::judge_sdf_bytes(data, size);
  return 0;
}
