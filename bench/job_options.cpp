#include "bench/job_options.h"

#include <CLI/CLI.hpp>
#include <unistd.h>

namespace signorini::bench {

void JobOptions::add_to(CLI::App& command) {
  command
      .add_option("--jobs", processes_,
                  "Processes at once; started by mpirun or srun, the ranks take their place. Times "
                  "of more than one are of a shared machine")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
}

tools::JobListOptions JobOptions::list_options(const std::filesystem::path& out,
                                               const std::string& settings) const {
  return {.processes = processes_,
          .folder = folder(out),
          .settings = settings,
          .shows_progress = tools::is_first_rank() && ::isatty(STDERR_FILENO) != 0};
}

}  // namespace signorini::bench
