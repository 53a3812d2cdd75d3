#pragma once

#include "tools/job_list.h"

#include <CLI/App.hpp>
#include <filesystem>
#include <string>

namespace signorini::bench {

/// --jobs of a study that is a list of jobs, and where its finished jobs are kept.
class JobOptions {
 public:
  void add_to(CLI::App& command);
  /// @param out the study's folder; empty: nothing is kept
  /// @param settings all that decides the results
  [[nodiscard]] tools::JobListOptions list_options(const std::filesystem::path& out,
                                                   const std::string& settings) const;
  /// OUT/jobs.
  [[nodiscard]] static std::filesystem::path folder(const std::filesystem::path& out) {
    return out.empty() ? out : out / "jobs";
  }

 private:
  int processes_ = 1;
};

}  // namespace signorini::bench
