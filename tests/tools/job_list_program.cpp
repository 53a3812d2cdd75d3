// job_list_program COUNT PROCESSES FOLDER SETTINGS LOG RESULTS: runs COUNT jobs, each of which adds
// its name to LOG; on the leader writes what they came to into RESULTS. Job 3 of a list of settings
// "crash" kills itself.

#include "tools/job_list.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <unistd.h>

int main(int argc, char** argv) {
  if (argc != 7) return 64;
  const int count = std::atoi(argv[1]);
  const std::string settings = argv[4];
  const std::string log = argv[5];
  std::vector<signorini::tools::Job> jobs;
  for (int i = 0; i < count; ++i) {
    const std::string name = "job " + std::to_string(i);
    jobs.push_back({name, [=] {
                      if (settings == "crash" && i == 3) ::raise(SIGKILL);
                      ::usleep(20000);
                      std::ofstream(log, std::ios::app) << name + "\n" << std::flush;
                      return std::to_string(i * i) + std::string(static_cast<std::size_t>(i), '\0');
                    }});
  }
  try {
    const signorini::tools::JobListResult result = signorini::tools::run_job_list(
        jobs, {.processes = std::atoi(argv[2]), .folder = argv[3], .settings = settings});
    if (!result.is_leader) return 0;
    std::ofstream out(argv[6], std::ios::binary);
    for (const signorini::tools::JobResult& job : result.jobs) {
      out << (job.is_done ? "done " : "not ") << job.bytes << job.reason << "\n";
    }
    std::printf("%s\ntaken over: %d\nranks: %d\n", result.remark().c_str(), result.taken_over,
                result.by_mpi ? result.processes : 0);
    return result.is_interrupted ? 130 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 70;
  }
}
