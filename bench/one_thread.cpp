#include "bench/one_thread.h"

#include <cstdlib>
#include <cstring>
#include <unistd.h>

namespace signorini::bench {

void pin_libraries_to_one_thread(char** argv) {
  constexpr const char* kVariables[] = {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS",
                                        "MKL_NUM_THREADS", "BLIS_NUM_THREADS"};
  bool is_pinned = true;
  for (const char* variable : kVariables) {
    const char* value = std::getenv(variable);
    is_pinned = is_pinned && value != nullptr && std::strcmp(value, "1") == 0;
    ::setenv(variable, "1", 1);
  }
  if (!is_pinned) {
    ::execv("/proc/self/exe", argv);  // returns only if it fails
  }
}

}  // namespace signorini::bench
