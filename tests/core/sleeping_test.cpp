#include <signorini/core/response/sleeping.h>
#include <signorini/core/response/time_stepper.h>

#include "../lcp/allocation_count.h"
#include "plane_contacts.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace signorini {
namespace {

using testing_tools::at;
using testing_tools::box_body;
using testing_tools::fixed_body;
using testing_tools::PlaneContacts;
using testing_tools::TestBox;

const Vec3 kHalf(0.5, 0.4, 0.2);

TimeStepSettings sleepy(double after = 0.05) {
  TimeStepSettings settings;
  settings.accuracy = Accuracy::engineering();
  settings.sleep.after = after;
  return settings;
}

/// A stack of two boxes, and a third box above it in the air.
struct Scene {
  explicit Scene(BodyKind ground = BodyKind::kFixed)
      : finder(Vec3::UnitZ(), {{TestBox{kHalf}, {0.4, 0.0}},
                               {TestBox{kHalf}, {0.4, 0.0}},
                               {TestBox{kHalf}, {0.4, 0.0}}}),
        bodies{fixed_body(), box_body(2.0, kHalf), box_body(1.0, kHalf), box_body(1.0, kHalf)},
        state{at(Vec3::Zero()), at(Vec3(0, 0, 0.2)), at(Vec3(0, 0, 0.6)), at(Vec3(0, 0, 3.0))} {
    bodies[0].kind = ground;
    finder.stack(2, 1);
    finder.stack(3, 2);
  }
  PlaneContacts finder;
  Bodies bodies;
  State state;
};

void step(TimeStepper& stepper, State& state, int steps, StepReport& report) {
  for (int k = 0; k < steps; ++k) {
    stepper.step(state, report);
    ASSERT_TRUE(lcp::is_solved(report.status)) << k << " " << report.detail;
  }
}

TEST(Sleeping, AStackAtRestFallsAsleepAndCostsNoRow) {
  Scene scene;
  scene.bodies[3].gravity_scale = 0.0;  // hangs in the air, touches nothing: stays awake
  TimeStepper stepper(scene.bodies, scene.finder, sleepy());
  StepReport report;
  step(stepper, scene.state, 40, report);
  EXPECT_TRUE(stepper.is_asleep(1));
  EXPECT_TRUE(stepper.is_asleep(2));
  EXPECT_FALSE(stepper.is_asleep(3));
  EXPECT_EQ(report.bodies_asleep, 2);
  EXPECT_EQ(report.rows, 0);
  EXPECT_TRUE(report.islands.empty());
  EXPECT_EQ(report.contacts_asleep, 8);
  EXPECT_NE(to_text(report).find("2 bodies asleep"), std::string::npos);
  const State asleep = scene.state;
  step(stepper, scene.state, 100, report);
  for (const int k : {1, 2}) {
    EXPECT_EQ(scene.state[k].x, asleep[k].x);
    EXPECT_EQ(scene.state[k].q.coeffs(), asleep[k].q.coeffs());
    EXPECT_TRUE(scene.state[k].p.isZero(0.0));
  }
}

TEST(Sleeping, OffByDefault) {
  Scene scene;
  TimeStepper stepper(scene.bodies, scene.finder, {});
  StepReport report;
  step(stepper, scene.state, 10, report);
  EXPECT_EQ(report.bodies_asleep, 0);
  EXPECT_FALSE(SleepSettings{}.is_on());
}

TEST(Sleeping, ABodyThatArrivesWakesTheWholeStackInTime) {
  Scene scene;  // the third box falls on the two
  TimeStepSettings settings = sleepy();
  settings.margin = 0.05;  // it falls 26 mm in its last step
  TimeStepper stepper(scene.bodies, scene.finder, settings);
  StepReport report;
  int woken_at = -1;
  double deepest = 0.0;
  for (int k = 0; k < 240; ++k) {
    stepper.step(scene.state, report);
    ASSERT_TRUE(lcp::is_solved(report.status));
    deepest = std::max(deepest, report.deepest_overlap);
    if (report.bodies_woken > 0) {
      EXPECT_EQ(report.bodies_woken, 2);
      EXPECT_EQ(woken_at, -1);
      woken_at = k;
    }
  }
  // It falls 2 m: 0.639 s, 153 steps.
  EXPECT_NEAR(woken_at, 153, 2);
  EXPECT_LT(deepest, 1e-6);
  EXPECT_NEAR(scene.state[3].x.z(), 1.0, 1e-6);
  EXPECT_EQ(report.bodies_asleep, 3);  // and all sleep again
}

TEST(Sleeping, ADrivenGroundThatMovesWakesWhicheverWay) {
  for (const Vec3& speed : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0)}) {
    Scene scene(BodyKind::kKinematic);
    scene.bodies[3].gravity_scale = 0.0;
    TimeStepper stepper(scene.bodies, scene.finder, sleepy());
    StepReport report;
    step(stepper, scene.state, 40, report);
    ASSERT_EQ(report.bodies_asleep, 2);
    scene.state[0].p = speed;  // a driven body's momentum is its velocity
    step(stepper, scene.state, 1, report);
    EXPECT_EQ(report.bodies_woken, 2);
    step(stepper, scene.state, 30, report);
    EXPECT_EQ(report.bodies_asleep, 0);
    EXPECT_GT((scene.state[2].x - Vec3(0, 0, 0.6)).norm(), 0.01);
  }
}

TEST(Sleeping, TheCallerWakesByCallByMomentumByPoseAndByMovingTheGround) {
  const std::vector<void (*)(TimeStepper&, State&)> ways = {
      [](TimeStepper& stepper, State&) { stepper.wake(1); },
      [](TimeStepper&, State& state) { state[2].p.x() = 0.1; },
      [](TimeStepper&, State& state) { state[2].x.z() += 0.3; },
      [](TimeStepper&, State& state) { state[0].x.z() -= 0.5; },
  };
  for (const auto& way : ways) {
    Scene scene;
    scene.bodies[3].gravity_scale = 0.0;
    TimeStepper stepper(scene.bodies, scene.finder, sleepy());
    StepReport report;
    step(stepper, scene.state, 40, report);
    ASSERT_EQ(report.bodies_asleep, 2);
    way(stepper, scene.state);
    step(stepper, scene.state, 1, report);
    EXPECT_EQ(report.bodies_asleep, 0);
  }
  Scene scene;
  TimeStepper stepper(scene.bodies, scene.finder, sleepy());
  EXPECT_THROW(stepper.wake(4), std::invalid_argument);
  EXPECT_THROW(stepper.wake(-1), std::invalid_argument);
}

TEST(Sleeping, AThousandSleepersAddNoRowNoWorkAndNoAllocation) {
  std::vector<std::pair<long, StepReport>> runs;
  for (const int extra : {1, 1000}) {
    std::vector<testing_tools::TestBody> shapes;
    Bodies bodies{fixed_body()};
    State state{at(Vec3::Zero())};
    for (int k = 0; k <= extra; ++k) {
      shapes.push_back({TestBox{kHalf}, {0.4, 0.0}});
      bodies.push_back(box_body(1.0, kHalf));
      state.push_back(at(Vec3(2.0 * k, 0.0, 0.2)));
    }
    PlaneContacts finder(Vec3::UnitZ(), shapes);
    TimeStepper stepper(bodies, finder, sleepy());
    StepReport report;
    step(stepper, state, 30, report);
    ASSERT_EQ(report.bodies_asleep, extra + 1);
    state[1].p = Vec3(3.0, 1.0, 0.0);  // one slides
    step(stepper, state, 10, report);
    const lcp::AllocationCount allocations;
    stepper.step(state, report);
    runs.emplace_back(allocations.count(), report);
    EXPECT_EQ(report.bodies_asleep, extra);
  }
  EXPECT_EQ(runs[0].first, runs[1].first);
  EXPECT_EQ(runs[0].second.rows, runs[1].second.rows);
  EXPECT_EQ(runs[0].second.rows, 12);
  EXPECT_EQ(runs[0].second.islands.size(), runs[1].second.islands.size());
  EXPECT_EQ(runs[0].second.result.statistics.iterations,
            runs[1].second.result.statistics.iterations);
}

TEST(Sleeping, BadSettingsNameTheField) {
  const auto said = [](const SleepSettings& settings) -> std::string {
    try {
      settings.validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(said({.after = -1.0}).find("after"), std::string::npos);
  EXPECT_NE(said({.after = 1.0, .speed = -1.0}).find("speed"), std::string::npos);
  EXPECT_NE(said({.after = 1.0, .spin = std::numeric_limits<double>::quiet_NaN()}).find("spin"),
            std::string::npos);
  EXPECT_EQ(said({}), "");
}

}  // namespace
}  // namespace signorini
