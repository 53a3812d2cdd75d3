// signorini-bullet-float SCENE SETTING DIVISOR: one run of signorini-bench tradeoff with Bullet in
// single precision, whose library cannot be in one program with that in double precision. Prints
// the bytes of a SceneOutcome, and nothing but them; what went wrong with exit code 1.

#include "bench/scene_trade.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

namespace {

using namespace signorini::bench;

std::string run(const std::string& scene, const std::string& setting, int divisor) {
  for (const SceneSetting& one : scene_settings()) {
    if (one.name == setting) {
      return signorini::tools::to_bytes(run_trade_scene(trade_scene(scene), one, divisor));
    }
  }
  throw std::invalid_argument("no such setting: " + setting);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 || std::atoi(argv[3]) < 1) {
    std::fputs("usage: signorini-bullet-float SCENE SETTING DIVISOR\n", stderr);
    return 64;
  }
  try {
    const std::string bytes = run(argv[1], argv[2], std::atoi(argv[3]));
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    return 0;
  } catch (const std::exception& error) {
    std::printf("%s", error.what());
    return 1;
  }
}
