#pragma once

#include <signorini/lcp/sparse_cholesky.h>
#include <signorini/lcp/status.h>

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace signorini::bench {

/// How the interior point grows with the problem, beside the factorisation floor: every family at
/// 1000, 3000, 10,000, ... rows, cold and warm (the bodies' velocities changed by 1 %). Times are
/// CPU times of the one thread that works.
struct RowScalingOptions {
  int max_rows = 10000;  ///< >= 1000; 50,000 takes minutes
  int repetitions = 3;   ///< >= 1; the least time counts
};

/// One back-end's factor of the body-space matrix at the solution.
struct BackEndTime {
  std::string_view name;
  double analyse_seconds = 0.0;
  double factor_seconds = 0.0;
  double solve_seconds = 0.0;
  lcp::SparseCholeskyCounts counts = {};
};

struct RowScalingRow {
  std::string_view family;
  int rows = 0;
  lcp::Status status = lcp::Status::kNotRun;  ///< cold
  lcp::Status warm_status = lcp::Status::kNotRun;
  double seconds = 0.0;  ///< cold, certificate included
  double warm_seconds = 0.0;
  int factorizations = 0;
  int warm_factorizations = 0;
  double unit_free_residual = 0.0;
  double floor_seconds = 0.0;  ///< factorization_floor.h, by reference_back_end()
  std::vector<BackEndTime> back_ends = {};
};

/// The exponents of time ~ rows^k between a family's smallest and largest problem.
struct RowGrowth {
  std::string_view family;
  double solver = 0.0;
  double floor = 0.0;
};

struct RowScalingReport {
  std::vector<RowScalingRow> rows;
  [[nodiscard]] std::vector<RowGrowth> growth() const;
  /// Every problem is solved.
  [[nodiscard]] bool passed() const;
  [[nodiscard]] std::string to_csv() const;
};

/// Runs the study; a line a problem goes to `log` as soon as it is known, then the exponents.
[[nodiscard]] RowScalingReport run_row_scaling_study(const RowScalingOptions& options,
                                                     std::ostream& log);

}  // namespace signorini::bench
