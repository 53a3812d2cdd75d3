#include "bench/stacks_study.h"

#include <gtest/gtest.h>
#include <sstream>

namespace signorini::bench {
namespace {

TEST(StacksStudy, AStackStandsAndIsSolvedAtEveryStep) {
  TimeStepSettings settings;
  settings.friction_model = FrictionModel::kCone;
  settings.solver = "auto";
  std::ostringstream out;
  const StacksReport report =
      run_stacks_study({}, {stack_scene(12, 1.0 / 60.0, 0.5), heavy_scene(1e6, 1.0 / 60.0, 0.5)},
                       {our_stepper("ours", settings)}, out);
  EXPECT_TRUE(report.passed()) << out.str();
  ASSERT_EQ(report.rows.size(), 2U);
  for (const StacksRow& row : report.rows) {
    EXPECT_LT(row.drift, 1e-8) << row.scene;
    EXPECT_LT(row.penetration, 1e-9) << row.scene;
  }
  EXPECT_NE(report.to_csv().find("stack of 12"), std::string::npos);
}

TEST(StacksStudy, EveryPositionOfTheDialSolvesAPyramid) {
  for (const char* position : {"preview", "game", "engineering", "reference"}) {
    TimeStepSettings settings;
    settings.accuracy = Accuracy::named(position);
    std::ostringstream out;
    const StacksReport report = run_stacks_study({}, {pyramid_scene(10, 1.0 / 60.0, 0.5)},
                                                 {our_stepper(position, settings)}, out);
    EXPECT_TRUE(report.passed()) << out.str();
    EXPECT_LT(report.rows.at(0).drift, 1e-8) << position;
  }
}

}  // namespace
}  // namespace signorini::bench
