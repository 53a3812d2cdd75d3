#include <signorini/collision/collision_world.h>
#include <signorini/core/response/contact_solver.h>
#include <signorini/core/response/time_stepper.h>

#include "../lcp/allocation_count.h"
#include "plane_contacts.h"

#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace signorini {
namespace {

using collision::Collider;
using collision::CollisionWorld;
using testing_tools::at;
using testing_tools::ball_body;
using testing_tools::box_body;
using testing_tools::fixed_body;

struct Scene {
  Bodies bodies{fixed_body()};
  State state{at(Vec3(0.0, 0.0, -5.0))};
  std::vector<Collider> colliders;
  Joints joints;

  int add(const Body& body, const collision::Shape& shape, const Vec3& x) {
    const int index = static_cast<int>(bodies.size());
    bodies.push_back(body);
    state.push_back(at(x));
    colliders.push_back({.body = index,
                         .shape = shape,
                         .local = {},
                         .material = {0.5, 0.0},
                         .name = "body " + std::to_string(index)});
    return index;
  }
  void add_ground(const collision::Shape& shape) {
    colliders.push_back(
        {.body = 0, .shape = shape, .local = {}, .material = {0.5, 0.0}, .name = "ground"});
  }
};

/// Boxes on each other: one island.
Scene stack() {
  Scene scene;
  scene.add_ground(collision::Box{Vec3(20.0, 20.0, 5.0)});
  for (int k = 0; k < 6; ++k) {
    scene.add(box_body(1.0, Vec3::Constant(0.5)), collision::Box{Vec3::Constant(0.5)},
              Vec3(0.0, 0.0, 0.5 + k));
  }
  return scene;
}

/// Flat boxes, each an island, that slide for four seconds: a factorisation a step.
Scene sliding() {
  Scene scene;
  const Vec3 half(0.5, 0.5, 0.1);
  scene.add_ground(collision::Box{Vec3(150.0, 20.0, 5.0)});
  for (int k = 0; k < 3; ++k) {
    scene.add(box_body(1.0, half), collision::Box{half}, Vec3(0.0, 2.0 * k, 0.1));
    scene.state.back().p = Vec3(25.0, 0.0, 0.0);
  }
  return scene;
}

/// Layers of 9, 4 and 1 balls between four walls.
Scene pile() {
  Scene scene;
  scene.add_ground(collision::Box{Vec3(20.0, 20.0, 5.0)});
  for (const double side : {-1.0, 1.0}) {
    for (const bool along_x : {true, false}) {
      scene.add_ground(collision::Box{Vec3(20.0, 20.0, 5.0)});
      const double far = side * 21.5;
      scene.colliders.back().local.position = along_x ? Vec3(far, 0.0, 5.0) : Vec3(0.0, far, 5.0);
    }
  }
  for (int layer = 0; layer < 3; ++layer) {
    const int edge = 3 - layer;
    for (int k = 0; k < edge * edge; ++k) {
      const double first = -0.5 * (edge - 1);
      scene.add(ball_body(1.0, 0.5), collision::Sphere{0.5},
                Vec3(first + k % edge, first + k / edge, 0.5 + layer * std::sqrt(0.5)));
    }
  }
  return scene;
}

/// Links that hang from the ground, and swing.
Scene chain() {
  Scene scene;
  int above = 0;
  for (int k = 0; k < 5; ++k) {
    const int link = scene.add(box_body(1.0, Vec3(0.2, 0.05, 0.05)),
                               collision::Box{Vec3(0.2, 0.05, 0.05)}, Vec3(0.25 + 0.5 * k, 0, 5));
    scene.joints.push_back(joint_at(k % 2 == 0 ? JointKind::kHinge : JointKind::kBall, link, above,
                                    scene.state, Vec3(0.5 * k, 0.0, 5.0), Vec3::UnitY()));
    above = link;
  }
  return scene;
}

struct Named {
  std::string name;
  Scene (*make)();
};

/// A scene at a position of the dial.
class StepAllocation : public testing::TestWithParam<std::tuple<Named, std::string>> {};

TEST_P(StepAllocation, NoneAfterWarmUp) {
  const auto& [named, position] = GetParam();
  Scene scene = named.make();
  CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  TimeStepSettings settings;
  settings.step = 1.0 / 60.0;
  settings.sleep.after = 100.0;  // on, and nobody sleeps yet
  settings.accuracy = Accuracy::named(position);
  TimeStepper stepper(scene.bodies, world, settings, scene.joints);
  StepReport report;
  for (int k = 0; k < 200; ++k) {
    stepper.step(scene.state, report);
  }
  const lcp::AllocationCount allocations;
  for (int k = 0; k < 20; ++k) {
    stepper.step(scene.state, report);
  }
  EXPECT_EQ(allocations.count(), 0) << to_text(report);
  EXPECT_TRUE(lcp::is_solved(report.status)) << to_text(report);
  EXPECT_GT(report.rows, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, StepAllocation,
    testing::Combine(testing::Values(Named{"stack", stack}, Named{"sliding", sliding},
                                     Named{"pile", pile}, Named{"chain", chain}),
                     testing::Values("preview", "game", "engineering", "reference")),
    [](const auto& scene) {
      return std::get<0>(scene.param).name + "_" + std::get<1>(scene.param);
    });

TEST(ContactSolverAllocation, NoneAfterWarmUp) {
  Scene scene = stack();
  CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  ContactSet contacts;
  world.find(scene.state, 0.01, contacts);
  const lcp::Vector allowance = lcp::Vector::Zero(static_cast<lcp::Index>(contacts.size()));
  ContactSolver solver;
  ContactSolution solution;
  State state;
  const auto solve = [&](int count) {
    for (int k = 0; k < count; ++k) {
      state = scene.state;
      for (std::size_t body = 1; body < state.size(); ++body) {
        state[body].p = scene.bodies[body].mass * Vec3(0.1 * (k % 3), 0.0, -0.16);
      }
      solver.solve(scene.bodies, contacts, allowance, state, solution);
      ASSERT_TRUE(lcp::is_solved(solution.status)) << solution.detail;
    }
  };
  solve(9);
  const lcp::AllocationCount allocations;
  solve(6);
  EXPECT_EQ(allocations.count(), 0);
}

// A hundred boxes asleep on the ground ask no pair; one that slides past wakes none and asks its
// own.
TEST(SleepingBodies, CostNoPairQuery) {
  Scene scene;
  scene.add_ground(collision::Box{Vec3(50.0, 50.0, 5.0)});
  const Vec3 half = Vec3::Constant(0.5);
  for (int k = 0; k < 100; ++k) {
    scene.add(box_body(1.0, half), collision::Box{half}, Vec3(2.0 * (k % 10), 2.0 * (k / 10), 0.5));
  }
  CollisionWorld world(scene.bodies, scene.colliders, {});
  TimeStepSettings settings;
  settings.accuracy = Accuracy::engineering();
  settings.sleep.after = 0.05;
  TimeStepper stepper(scene.bodies, world, settings);
  StepReport report;
  for (int k = 0; k < 40; ++k) {
    stepper.step(scene.state, report);
  }
  ASSERT_EQ(report.bodies_asleep, 100);
  EXPECT_EQ(report.contacts_asleep, 400);
  scene.state[100].p = Vec3(1.0, 0.0, 0.0);
  stepper.wake(100);
  stepper.step(scene.state, report);
  stepper.step(scene.state, report);
  EXPECT_EQ(report.bodies_asleep, 99);
  EXPECT_EQ(world.pairs_asked(), 1);
}

}  // namespace
}  // namespace signorini
