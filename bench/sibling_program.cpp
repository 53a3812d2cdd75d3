#include "bench/sibling_program.h"

namespace signorini::bench {

std::filesystem::path sibling_program(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

}  // namespace signorini::bench
