#include "bench/row_scaling_study.h"

#include "bench/contact_families.h"
#include "bench/factorization_floor.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <sstream>

namespace signorini::bench {
namespace {

TEST(FactorizationFloor, CountsTheActiveRows) {
  const lcp::Problem problem = make_family({.family = "tower4", .size = 10});
  const auto& A = std::get<lcp::FactoredMatrix>(problem.M);
  lcp::Vector z = lcp::Vector::Zero(problem.size());
  z.head(12).setOnes();
  for (const std::string_view name : lcp::sparse_cholesky_names()) {
    const FactorizationFloor floor = measure_factorization_floor(A, z, name);
    EXPECT_EQ(floor.rows, 12) << name;
    EXPECT_GE(floor.counts.entries, 12.0) << name;
    EXPECT_GE(floor.seconds, floor.factor_seconds) << name;
  }
}

TEST(RowScalingReport, GrowthIsTheSlopeInLogarithms) {
  RowScalingReport report;
  for (const int rows : {1000, 10000}) {
    RowScalingRow row;
    row.family = "tower4";
    row.rows = rows;
    row.status = row.warm_status = lcp::Status::kSolved;
    row.seconds = 1e-9 * std::pow(rows, 1.5);
    row.floor_seconds = 1e-9 * rows;
    report.rows.push_back(row);
  }
  ASSERT_EQ(report.growth().size(), 1U);
  EXPECT_NEAR(report.growth()[0].solver, 1.5, 1e-12);
  EXPECT_NEAR(report.growth()[0].floor, 1.0, 1e-12);
  EXPECT_TRUE(report.passed());
  report.rows[1].warm_status = lcp::Status::kStalled;
  EXPECT_FALSE(report.passed());
}

TEST(RowScalingStudy, EveryFamilyOfAThousandRowsIsSolved) {
  std::ostringstream log;
  const RowScalingReport report = run_row_scaling_study({.max_rows = 1000, .repetitions = 1}, log);
  EXPECT_TRUE(report.passed()) << log.str();
  EXPECT_EQ(report.rows.size(), family_names().size());
  const std::string csv = report.to_csv();
  EXPECT_EQ(std::ranges::count(csv, '\n'),
            1 + static_cast<long>(report.rows.size() * lcp::sparse_cholesky_names().size()));
}

}  // namespace
}  // namespace signorini::bench
