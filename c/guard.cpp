#include "guard.h"

#include <algorithm>
#include <array>

namespace {

thread_local std::array<char, 1024> last_error{};

}  // namespace

namespace signorini::c {

void keep_error(const char* text) noexcept {
  const std::size_t length = std::min(std::strlen(text), last_error.size() - 1);
  std::memmove(last_error.data(), text, length);
  last_error[length] = '\0';
}

}  // namespace signorini::c

const char* signorini_last_error(void) {
  return last_error.data();
}

const char* signorini_version(void) {
  return SIGNORINI_VERSION;
}
