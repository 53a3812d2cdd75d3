// Resting stacks keep their features from step to step: what a warm start lives on.
#include <signorini/collision/collision_world.h>
#include <signorini/core/response/time_stepper.h>

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace signorini {
namespace {

using collision::Box;
using collision::Collider;
using collision::CollisionWorld;
using collision::HalfSpace;

struct Stack {
  Bodies bodies;
  State state;
  std::vector<Collider> colliders;

  void add(BodyKind kind, const collision::Shape& shape, const Pose& pose) {
    Body body;
    body.kind = kind;
    if (kind == BodyKind::kDynamic) {
      const collision::MassProperties properties = mass_properties(shape, 1000.0);
      body.mass = properties.mass;
      body.inertia = properties.inertia;
    }
    BodyState at;
    at.x = pose.position;
    at.q = pose.orientation;
    colliders.push_back({static_cast<int>(bodies.size()), shape, {}, {0.5, 0.0}, "collider"});
    bodies.push_back(body);
    state.push_back(at);
  }
};

/// Boxes on a plane, each turned a little against the one below, so that edges cross as well.
Stack turned_stack(int count, double turn) {
  Stack stack;
  stack.add(BodyKind::kFixed, HalfSpace{}, {});
  for (int k = 0; k < count; ++k) {
    stack.add(
        BodyKind::kDynamic, Box{Vec3(0.5, 0.4, 0.2)},
        {Vec3(0.01 * k, 0.0, 0.2 + 0.4 * k), Quat(Eigen::AngleAxisd(turn * k, Vec3::UnitZ()))});
  }
  return stack;
}

struct Flicker {
  int changed_ids = 0;  ///< ids that came or went between two steps, all steps
  std::size_t contacts = 0;
};

Flicker run(Stack stack, int steps) {
  CollisionWorld world(stack.bodies, stack.colliders, PairingRule::kMinimum);
  TimeStepSettings settings;
  settings.step = 1.0 / 60.0;
  settings.pyramid_sides = 4;
  settings.solver = "auto";
  TimeStepper stepper(stack.bodies, world, settings);
  StepReport report;
  Flicker flicker;
  std::set<std::uint64_t> before;
  for (int k = 0; k < steps; ++k) {
    stepper.step(stack.state, report);
    EXPECT_TRUE(lcp::is_solved(report.status)) << "step " << k;
    std::set<std::uint64_t> ids;
    for (const Contact& contact : report.contacts) {
      ids.insert(contact.feature_id);
    }
    EXPECT_EQ(ids.size(), report.contacts.size()) << "step " << k;
    if (k > 0) {
      for (const std::uint64_t id : ids) {
        flicker.changed_ids += before.contains(id) ? 0 : 1;
      }
      for (const std::uint64_t id : before) {
        flicker.changed_ids += ids.contains(id) ? 0 : 1;
      }
    }
    before = ids;
    flicker.contacts = ids.size();
  }
  return flicker;
}

TEST(SteadyFeatures, AStackOfFlushBoxesKeepsItsIdsFor600Steps) {
  const Flicker flicker = run(turned_stack(4, 0.0), 600);
  EXPECT_EQ(flicker.changed_ids, 0);
  EXPECT_EQ(flicker.contacts, 16U);
}

TEST(SteadyFeatures, AStackOfTurnedBoxesKeepsItsIdsFor600Steps) {
  const Flicker flicker = run(turned_stack(4, 0.3), 600);
  EXPECT_EQ(flicker.changed_ids, 0);
  EXPECT_GE(flicker.contacts, 16U);
}

}  // namespace
}  // namespace signorini
