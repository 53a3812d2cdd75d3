#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace signorini::tools {

/// A piece of work that depends on no other: a scene, a solver on a series of problems.
struct Job {
  std::string name;                  ///< unique in its list
  std::function<std::string()> run;  ///< what it came to, as bytes; run in a child process
  double weight = 1.0;               ///< > 0: its share of the time left, in any unit
};

struct JobListOptions {
  /// Processes on this machine, >= 1. Under MPI the ranks take their place and it must be 1.
  int processes = 1;
  /// Where each finished job is kept as one file, written whole or not at all; made if absent.
  /// Empty: nothing is kept.
  std::filesystem::path folder = {};
  /// All that decides the results beside the jobs' names, the program and its shared libraries:
  /// what was finished under other settings, or by another build, is done again. Files that the
  /// jobs read belong in it (file_state.h).
  std::string settings = {};
  bool shows_progress = false;  ///< one line on stderr, rewritten, with the time left
};

struct JobResult {
  bool is_done = false;
  std::string bytes = {};  ///< what Job::run returned, if it is done
  std::string reason =
      {};           ///< why it is not: "signal 11 (Segmentation fault)", an exception's text
  int at_once = 0;  ///< jobs that were running at the same time when it was done, at most
};

struct JobListResult {
  std::vector<JobResult> jobs;  ///< in the order of the list, however they were run
  bool is_interrupted = false;  ///< a signal came: what was not done has an empty reason
  int taken_over = 0;           ///< finished by an earlier run
  int processes = 1;            ///< that shared the work, or ranks
  bool by_mpi = false;
  /// Not on the first rank: another one has the results, and this one is to end quietly.
  bool is_leader = true;

  /// How the jobs were run, and whether their times are of a machine that they shared.
  [[nodiscard]] std::string remark() const;
  /// Of the first job that failed (crashed, threw), "NAME: reason"; empty if none did.
  [[nodiscard]] std::string first_failure(const std::vector<Job>& list) const;
};

/// Runs every job, each in a child process, `processes` at a time; whoever is free takes the next.
/// Started under MPI (`mpirun -n N`, `srun --mpi=pmix`), all ranks take part, and the first one has
/// the results; that must be the first call of the process that does so. The results do not depend
/// on who ran what. SIGINT, SIGTERM and SIGHUP end it early; a killed run goes on where it was when
/// it is started again with the same folder and settings. For a process with one thread.
///
/// @throws std::invalid_argument for a bad option or two jobs of one name, and under MPI in a build
///   without it; std::runtime_error for a folder that cannot be written, std::system_error without
///   processes to be had.
[[nodiscard]] JobListResult run_job_list(const std::vector<Job>& jobs,
                                         const JobListOptions& options);

/// Removes what run_job_list() kept of these jobs, and the folder if nothing else is in it: for
/// when their results are written. On the first rank alone.
void forget_finished_jobs(const std::vector<Job>& jobs, const std::filesystem::path& folder);

/// mpirun or srun started this process as one of its ranks: by the environment that they set.
[[nodiscard]] bool is_under_mpi();
/// True but on the ranks of an MPI run that have nothing to say: for what is printed before a list
/// is run.
[[nodiscard]] bool is_first_rank();

}  // namespace signorini::tools
