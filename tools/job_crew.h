#pragma once

#include "tools/byte_archive.h"
#include "tools/job_list.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace signorini::tools {

/// What a hand in the crew says of a job.
struct JobReport {
  int job = -1;  ///< into the list
  bool is_done = false;
  std::string bytes = {};  ///< the answer, or the reason why there is none
};

void visit_fields(auto& archive, Reflects<JobReport> auto& report) {
  archive(report.job, report.is_done, report.bytes);
}

/// Hands that run jobs, one each at a time.
class JobCrew {
 public:
  virtual ~JobCrew() = default;
  [[nodiscard]] virtual int hands() const = 0;
  /// Hands out a job; the hand must be idle.
  virtual void give(int hand, int job) = 0;
  struct Finished {
    int hand = 0;
    JobReport report;
  };
  /// Waits for a moment, at most; nothing if nobody has finished or a signal came.
  [[nodiscard]] virtual std::optional<Finished> wait() = 0;
};

/// A child process that runs jobs as it is told, each in a child of its own, so that no crash ends
/// it. It dies with its parent. It has a process group of its own: Ctrl-C is for the parent.
class JobWorker {
 public:
  /// Forks. @throws std::system_error
  explicit JobWorker(const std::vector<Job>& jobs);
  /// Ends it, and what it runs.
  ~JobWorker();
  JobWorker(const JobWorker&) = delete;
  JobWorker& operator=(const JobWorker&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }  ///< readable: take() has news
  void give(int job);
  /// Reads what has arrived: the whole report of a job, or nothing yet.
  /// @throws std::runtime_error if the worker is no more.
  [[nodiscard]] std::optional<JobReport> take();

 private:
  int descriptor_ = -1;
  int process_ = -1;
  std::string arrived_;
};

/// So many workers of this process.
[[nodiscard]] std::unique_ptr<JobCrew> make_local_crew(const std::vector<Job>& jobs, int hands);

}  // namespace signorini::tools
