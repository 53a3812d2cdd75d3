#pragma once

#include "bench/scaling_case.h"
#include "bench/scaling_row.h"
#include "tools/job_list.h"

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace signorini::bench {

/// How whole steps grow with the number of bodies: every scene of scaling_scenes.h with 10, 30,
/// 100, 300 .. bodies.
struct ScalingOptions {
  int max_bodies = 3000;            ///< in [10, 100000]
  std::vector<std::string> scenes;  ///< of scaling_scene_names(); empty: all
  ScalingRunOptions run;
  int bullet_iterations = 10;  ///< of Bullet's sequential impulses; 0: without Bullet
  tools::JobListOptions jobs = {};
};

/// @throws std::invalid_argument naming field, value and bound
void validate(const ScalingOptions& options);

/// The rows that a run of these options should have, without counts and costs.
[[nodiscard]] std::vector<ScalingRow> planned_rows(const ScalingOptions& options);

/// cost ~ bodies^k, by least squares in the logarithms.
struct ScalingGrowth {
  std::string scene;
  std::string engine;
  std::string_view cost;  ///< of kScalingCosts
  double exponent = 0.0;
};
/// Sizes below this say what a step costs at least, not how it grows; all are taken where fewer
/// than two are larger.
inline constexpr int kGrowthFrom = 100;

struct ScalingReport {
  std::vector<ScalingRow> rows;  ///< those that failed too
  std::string failure;           ///< of the first job that crashed; else empty
  std::string remark;            ///< how the jobs were run
  bool is_interrupted = false;
  bool is_leader = true;

  [[nodiscard]] std::vector<ScalingGrowth> growth() const;
  /// No answer of ours is wrong, and no job crashed.
  [[nodiscard]] bool passed() const;
  /// A line a row; read back by read_scaling_csv().
  [[nodiscard]] std::string to_csv() const;
};

/// The jobs of the study, to be forgotten once the report is written.
[[nodiscard]] std::vector<tools::Job> scaling_jobs(const ScalingOptions& options);

/// Runs the study. @throws as run_job_list()
[[nodiscard]] ScalingReport run_scaling_study(const ScalingOptions& options);

/// The tables, a scene each, and the exponents.
void print(const ScalingReport& report, std::ostream& out);

}  // namespace signorini::bench
