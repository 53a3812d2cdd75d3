#pragma once

namespace signorini::bench {

/// Makes sure that BLAS and OpenMP run on one thread in this process: libraries read their
/// environment when they are loaded, so that the program is started anew with it unless it is there
/// already. Does nothing where /proc is absent.
/// @param argv of main()
void pin_libraries_to_one_thread(char** argv);

}  // namespace signorini::bench
