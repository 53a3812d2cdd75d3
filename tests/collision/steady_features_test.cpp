// Resting stacks keep their features from step to step: what a warm start lives on.
#include <signorini/collision/collision_world.h>
#include <signorini/collision/contact_reduction.h>
#include <signorini/core/response/impact.h>
#include <signorini/core/response/time_stepper.h>

#include <cmath>
#include <cstdio>
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
  ContactSet contacts;
  Flicker flicker;
  std::set<std::uint64_t> before;
  for (int k = 0; k < steps; ++k) {
    stepper.step(stack.state, report);
    EXPECT_TRUE(lcp::is_solved(report.status)) << "step " << k;
    // What was found, not the step's rows: a corner 1e-10 m above its face may do without one.
    world.find(stack.state, settings.margin, contacts);
    std::set<std::uint64_t> ids;
    for (const Contact& contact : contacts) {
      ids.insert(contact.feature_id);
    }
    EXPECT_EQ(ids.size(), contacts.size()) << "step " << k;
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

/// Velocities of a drum (upright cylinder, 16 points of its rim and some inside it) after a plastic
/// impact on the ground with this velocity, with all contacts (most = 0) or with fewer.
Velocity after_impact(const Velocity& before, int most) {
  Stack stack;
  stack.add(BodyKind::kFixed, HalfSpace{}, {});
  stack.add(BodyKind::kDynamic, collision::Cylinder{0.5, 0.2}, {{0, 0, 0.2}, Quat::Identity()});
  stack.state[1].p = stack.bodies[1].mass * before.linear;
  stack.state[1].L = stack.bodies[1].inertia * before.angular;  // the axes are the world's
  ContactSet contacts;
  for (int k = 0; k < 24; ++k) {
    const double r = k < 16 ? 0.5 : 0.3;
    Contact contact;
    contact.body_a = 1;
    contact.body_b = 0;
    contact.point_a = contact.point_b = {r * std::cos(k * M_PI / 8), r * std::sin(k * M_PI / 8), 0};
    contact.normal = Vec3::UnitZ();
    contact.gap = 0.0;
    contact.feature_id = static_cast<std::uint64_t>(k);
    contacts.push_back(contact);
  }
  if (most != 0) {
    (void)collision::reduce_contacts(contacts, most);
  }
  ImpactSettings settings;
  settings.law = ImpactLaw::kNewton;
  ImpactReport report;
  resolve_impact(stack.bodies, contacts, settings, stack.state, report);
  EXPECT_TRUE(lcp::is_solved(report.status));
  return {stack.state[1].p / stack.bodies[1].mass,
          stack.bodies[1].inertia.inverse() * stack.state[1].L};
}

double difference(const Velocity& p, const Velocity& q) {
  return (p.linear - q.linear).norm() + (p.angular - q.angular).norm();
}

// What reduce_contacts() costs, in the answer: nothing while the corners stay; with fewer, only
// where a torque comes to lie beyond the smaller patch.
TEST(ContactReduction, ChangesTheImpactOnlyWhereItTakesCorners) {
  const Velocity flat{{0.3, 0.1, -1.0}, Vec3::Zero()};
  const Velocity tumbling{{0.0, 0.0, -1.0}, {1.5, 0.7, 0.0}};
  for (const Velocity& before : {flat, tumbling}) {
    EXPECT_LE(difference(after_impact(before, 0), after_impact(before, 16)), 1e-10);
  }
  EXPECT_LE(difference(after_impact(flat, 0), after_impact(flat, 4)), 1e-10);
  const double change = difference(after_impact(tumbling, 0), after_impact(tumbling, 4));
  std::printf("    16 corners to 4: a tumbling drum's velocities change by %.2g of 1 m/s\n",
              change);
  EXPECT_LE(change, 1.0);
}

}  // namespace
}  // namespace signorini
