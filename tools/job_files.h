#pragma once

#include "tools/job_list.h"

#include <filesystem>
#include <optional>
#include <string>

namespace signorini::tools {

/// Finished jobs of a list, one file each in a folder. A file says what it is the result of: the
/// job's name, the settings, a print of the program's own file, and the size and time of its shared
/// libraries; what does not match, or is damaged, is no result.
class JobFiles {
 public:
  /// @param folder made if absent; empty: nothing is kept @throws std::runtime_error naming it
  JobFiles(std::filesystem::path folder, const std::string& settings);

  /// What an earlier run left of this job.
  [[nodiscard]] std::optional<JobResult> find(const Job& job) const;
  /// @throws std::runtime_error naming the file
  void keep(const Job& job, const JobResult& result) const;

 private:
  std::filesystem::path folder_;
  std::string key_;  ///< program, libraries and settings
};

/// Where a job is kept.
[[nodiscard]] std::filesystem::path job_file(const std::filesystem::path& folder, const Job& job);

}  // namespace signorini::tools
