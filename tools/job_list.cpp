#include "tools/job_list.h"

#include "tools/job_files.h"
#include "tools/job_ranks.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <set>
#include <stdexcept>

namespace signorini::tools {
namespace {

volatile std::sig_atomic_t stop_signal = 0;

/// Turns interrupts into a flag while it lives.
class StopSignals {
 public:
  StopSignals() {
    stop_signal = 0;
    struct sigaction action = {};
    action.sa_handler = [](int signal) { stop_signal = signal; };
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], &action, &previous_[i]);
    }
  }
  ~StopSignals() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], &previous_[i], nullptr);
    }
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> previous_ = {};
};

/// How far the list is, and the time left if the rest goes on at the same pace.
class Progress {
 public:
  Progress(bool is_shown, const std::vector<Job>& jobs) : is_shown_(is_shown), count_(jobs.size()) {
    for (const Job& job : jobs) {
      weight_left_ += job.weight;
    }
  }
  void start(const Job& job) { show(job.name); }
  void finish(const Job& job) {
    weight_left_ -= job.weight;
    weight_done_ += job.weight;
    ++done_;
    show(job.name);
  }
  void skip(const Job& job) {
    weight_left_ -= job.weight;
    --count_;
  }
  void end() const {
    if (is_shown_) std::fputs("\r\033[K", stderr);
  }

 private:
  void show(const std::string& job) const {
    if (!is_shown_) return;
    const double spent = std::chrono::duration<double>(Clock::now() - start_).count();
    std::string rest;
    if (done_ > 0) {
      const double seconds = spent / weight_done_ * std::max(weight_left_, 0.0);
      rest = seconds < 90.0 ? fmt::format(", about {:.0f} s left", std::ceil(seconds))
                            : fmt::format(", about {:.0f} min left", std::ceil(seconds / 60.0));
    }
    fmt::print(stderr, "\r\033[K[{}/{}] {}{}", done_, count_, job, rest);
    std::fflush(stderr);
  }

  using Clock = std::chrono::steady_clock;
  bool is_shown_;
  double weight_left_ = 0.0;
  double weight_done_ = 0.0;
  std::size_t count_;
  std::size_t done_ = 0;
  Clock::time_point start_ = Clock::now();
};

void check(const std::vector<Job>& jobs, const JobListOptions& options) {
  if (options.processes < 1) {
    throw std::invalid_argument(fmt::format("jobs: must be at least 1, got {}", options.processes));
  }
  if (is_under_mpi() && options.processes != 1) {
    throw std::invalid_argument(
        fmt::format("jobs: under MPI the ranks do the jobs; must be 1, got {}", options.processes));
  }
  std::set<std::string> names;
  for (const Job& job : jobs) {
    if (!(job.weight > 0.0)) {
      throw std::invalid_argument(
          fmt::format("jobs: weight of {}: must be > 0, got {}", job.name, job.weight));
    }
    if (!names.insert(job.name).second) {
      throw std::invalid_argument("jobs: two are called " + job.name);
    }
  }
}

/// Hands out the jobs that are not done, one to each idle hand.
class Dispatch {
 public:
  Dispatch(const std::vector<Job>& jobs, JobCrew& crew, const JobFiles& files, Progress& progress,
           JobListResult& result)
      : jobs_(jobs), crew_(crew), files_(files), progress_(progress), result_(result) {
    for (int hand = crew.hands() - 1; hand >= 0; --hand) {
      idle_.push_back(hand);
    }
  }

  void run() {
    while (stop_signal == 0) {
      give_all();
      if (running_.empty()) {
        return;
      }
      if (std::optional<JobCrew::Finished> finished = crew_.wait()) {
        take(std::move(*finished));
      }
    }
    result_.is_interrupted = true;
  }

 private:
  void give_all() {
    while (!idle_.empty() && next_ < jobs_.size()) {
      const std::size_t job = next_++;
      if (result_.jobs[job].is_done) {
        continue;  // taken over
      }
      crew_.give(idle_.back(), static_cast<int>(job));
      idle_.pop_back();
      running_.insert(job);
      for (const std::size_t one : running_) {
        int& most = result_.jobs[one].at_once;
        most = std::max(most, static_cast<int>(running_.size()));
      }
      progress_.start(jobs_[job]);
    }
  }
  void take(JobCrew::Finished finished) {
    const auto job = static_cast<std::size_t>(finished.report.job);
    idle_.push_back(finished.hand);
    running_.erase(job);
    JobResult& result = result_.jobs[job];
    result.is_done = finished.report.is_done;
    (result.is_done ? result.bytes : result.reason) = std::move(finished.report.bytes);
    if (result.is_done) {
      files_.keep(jobs_[job], result);
    }
    progress_.finish(jobs_[job]);
  }

  const std::vector<Job>& jobs_;
  JobCrew& crew_;
  const JobFiles& files_;
  Progress& progress_;
  JobListResult& result_;
  std::vector<int> idle_;
  std::set<std::size_t> running_;
  std::size_t next_ = 0;
};

}  // namespace

std::string JobListResult::remark() const {
  int at_once = 0;
  for (const JobResult& job : jobs) {
    at_once = std::max(at_once, job.at_once);
  }
  std::string text = fmt::format("{} jobs, {} {}", jobs.size(), processes,
                                 by_mpi ? (processes == 1 ? "MPI rank" : "MPI ranks")
                                        : (processes == 1 ? "process" : "processes"));
  if (taken_over > 0) {
    text += fmt::format(", {} taken over from an earlier run", taken_over);
  }
  if (at_once > 1) {
    text += fmt::format(
        "; up to {} jobs ran at once: their TIMES ARE OF A SHARED MACHINE, for comparison with "
        "care",
        at_once);
  }
  return text;
}

std::string JobListResult::first_failure(const std::vector<Job>& list) const {
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (!jobs[i].is_done && !jobs[i].reason.empty()) {
      return list[i].name + ": " + jobs[i].reason;
    }
  }
  return {};
}

JobListResult run_job_list(const std::vector<Job>& jobs, const JobListOptions& options) {
  check(jobs, options);
  const StopSignals stop;
  JobListResult result;
  result.jobs.resize(jobs.size());
  result.by_mpi = is_under_mpi();
  // Before MPI starts, which loads libraries of its own.
  const JobFiles files(is_first_rank() ? options.folder : std::filesystem::path(),
                       options.settings);
  std::unique_ptr<JobCrew> crew;
  if (result.by_mpi) {
    std::unique_ptr<RankCrew> ranks = join_ranks(jobs);
    result.is_leader = ranks->leads();
    if (!result.is_leader) {
      ranks->serve();
      return result;
    }
    crew = std::move(ranks);
  }
  Progress progress(options.shows_progress, jobs);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (std::optional<JobResult> kept = files.find(jobs[i])) {
      result.jobs[i] = std::move(*kept);
      ++result.taken_over;
      progress.skip(jobs[i]);
    }
  }
  if (crew == nullptr) {
    crew = make_local_crew(jobs, options.processes);
  }
  result.processes = crew->hands();
  Dispatch(jobs, *crew, files, progress, result).run();
  progress.end();
  return result;
}

}  // namespace signorini::tools
