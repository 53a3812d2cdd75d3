#pragma once

#include <string>

#ifdef SIGNORINI_MPIRUN
namespace signorini {

/// In front of a program's command: four MPI ranks of it. Open MPI leaks a little by itself, so
/// that sanitized ranks do not look for leaks.
inline const std::string kFourRanks =
    "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
    "ASAN_OPTIONS=detect_leaks=0 " SIGNORINI_MPIRUN " --oversubscribe -n 4";

}  // namespace signorini
#endif
