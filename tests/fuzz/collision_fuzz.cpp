#include "collision_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  signorini::collision::testing::judge_bytes(data, size);
  return 0;
}
