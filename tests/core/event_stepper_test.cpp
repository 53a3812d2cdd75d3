#include <signorini/collision/collision_world.h>
#include <signorini/core/response/event_stepper.h>

#include "event_world.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <stdexcept>

namespace signorini {
namespace {

using collision::Box;
using collision::CollisionWorld;
using collision::HalfSpace;
using collision::Sphere;
using scenes::count;
using scenes::kG;
using scenes::World;

TEST(EventStepper, ApexHeightsAreThoseOfTheRestitutionLaw) {
  const double height = 1.0;
  const double fall = std::sqrt(2.0 * height / kG);
  for (const double e : {0.5, 0.9, 1.0}) {
    double time = 0.0;  // of the next impact
    double flight = fall;
    World world;
    world.add(scenes::ball(1.0, 0.5), Sphere{0.5}, Vec3(0.3, -0.2, 0.5 + height), e);
    double apex = height;
    double start = 0.0;  // where the state is
    for (int bounce = 1; bounce <= 5; ++bounce) {
      time += bounce == 1 ? fall : 2.0 * flight;
      flight *= e;
      apex *= e * e;
      const EventReport report = world.run(time + flight - start);  // to the next apex
      start = time + flight;
      ASSERT_EQ(report.events.size(), 1u);
      EXPECT_NEAR(world.scene.state[1].x.z() - 0.5, apex, 1e-8 * apex) << "e " << e;
      EXPECT_NEAR(world.scene.velocity_of(1).linear.z(), 0.0, 1e-6);
    }
  }
}

TEST(EventStepper, InfinitelyManyBouncesEndByTheRuleAtTheTimeOfTheClosedForm) {
  // From height H: t = sqrt(2 H/g) (1 + e)/(1 - e), then rest.
  const double height = 0.7;
  for (const double e : {0.3, 0.5, 0.9}) {
    World world;
    world.add(scenes::ball(1.0, 0.5), Sphere{0.5}, Vec3(0, 0, 0.5 + height), e);
    const double total = std::sqrt(2.0 * height / kG) * (1.0 + e) / (1.0 - e);
    const EventReport report = world.run(1.2 * total);
    ASSERT_EQ(count(report, EventKind::kRest), 1);
    const Event& rest = report.events.back();
    EXPECT_NEAR(rest.time + rest.skipped_seconds, total, 1e-6 * total);
    EXPECT_EQ(rest.kind, EventKind::kRest);
    EXPECT_NEAR(world.scene.state[1].x.z(), 0.5, 1e-7);
    EXPECT_LE(world.scene.velocity_of(1).linear.norm(), 1e-7);
    ASSERT_EQ(report.resting_forces.size(), 1);
    EXPECT_NEAR(report.resting_forces[0], kG, 1e-9);
    EXPECT_EQ(count(report, EventKind::kImpact),
              1 + static_cast<int>(std::floor(
                      std::log(EventSettings{}.resting_speed / std::sqrt(2.0 * kG * height)) /
                      std::log(e))));
  }
}

TEST(EventStepper, ABoxOnFourCornersCarriesAQuarterOnEach) {
  World world;
  world.add(scenes::box(2.0, Vec3(1, 0.6, 0.4)), Box{Vec3(0.5, 0.3, 0.2)}, Vec3(0, 0, 0.2), 0.0);
  const EventReport report = world.run(3.0);
  EXPECT_TRUE(report.events.empty());
  ASSERT_EQ(report.resting_forces.size(), 4);
  EXPECT_EQ(report.redundancy, 1);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(report.resting_forces[i], 2.0 * kG / 4.0, 1e-9);
  }
  EXPECT_NEAR(world.scene.state[1].x.z(), 0.2, 1e-9);
  EXPECT_LE(world.scene.velocity_of(1).angular.norm(), 1e-10);
}

TEST(EventStepper, ABoxLandsFlatInOneImpactAndDoesNotTurn) {
  World world;
  world.add(scenes::box(2.0, Vec3(1, 0.6, 0.4)), Box{Vec3(0.5, 0.3, 0.2)}, Vec3(0, 0, 0.7), 0.5);
  const EventReport report = world.run(0.5);
  EXPECT_GE(count(report, EventKind::kImpact), 1);
  EXPECT_LE(world.scene.velocity_of(1).angular.norm(), 1e-12);
  EXPECT_NEAR(report.events[0].time, std::sqrt(2.0 * 0.5 / kG), 1e-9);
}

TEST(EventStepper, ACradleWithAirSendsOneBallAwayAndAGravityFreeSceneKeepsItsEnergy) {
  World world;
  for (int i = 0; i < 5; ++i) {
    world.add(scenes::ball(1.0, 0.5), Sphere{0.5}, Vec3(i + (i == 0 ? -0.5 : 0.0), 0, 5), 1.0,
              {Vec3(i == 0 ? 1.5 : 0.0, 0, 0), Vec3::Zero()});
  }
  EventSettings settings;
  settings.gravity.setZero();
  const double before = kinetic_energy(world.scene.bodies, world.scene.state);
  const EventReport report = world.run(1.0, settings);
  EXPECT_EQ(count(report, EventKind::kImpact), 1);
  EXPECT_NEAR(report.events[0].time, 0.5 / 1.5, 1e-8);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(world.scene.velocity_of(i + 1).linear.x(), i == 4 ? 1.5 : 0.0, 1e-9);
  }
  EXPECT_NEAR(kinetic_energy(world.scene.bodies, world.scene.state), before, 1e-12 * before);
}

TEST(EventStepper, ImpactsOfManyElasticBallsKeepTheEnergy) {
  World world;
  for (int i = 0; i < 27; ++i) {
    const Vec3 x(1.1 * (i % 3) + 0.01 * (i % 5), 1.1 * (i / 3 % 3) - 0.01 * (i % 7),
                 1 + 1.1 * (i / 9));
    world.add(scenes::ball(1.0, 0.5), Sphere{0.5}, x, 1.0);
  }
  const double before = world.energy(Vec3(0, 0, -kG));
  const EventReport report = world.run(1.0);
  EXPECT_GT(report.events.size(), 50u);
  EXPECT_LE(std::abs(report.energy_change_impacts), 1e-12 * before);
  EXPECT_NEAR(world.energy(Vec3(0, 0, -kG)), before, 1e-12 * before);
}

TEST(EventStepper, AMovingSupportCarriesItsLoad) {
  World world;
  world.scene.bodies[0].kind = BodyKind::kKinematic;
  set_velocity(world.scene.bodies[0], {Vec3(0, 0, 0.8), Vec3::Zero()}, world.scene.state[0]);
  world.add(scenes::ball(3.0, 0.5), Sphere{0.5}, Vec3(0, 0, 0.5), 0.0,
            {Vec3(0, 0, 0.8), Vec3::Zero()});
  const EventReport report = world.run(2.0);
  ASSERT_EQ(report.resting_forces.size(), 1);
  EXPECT_NEAR(report.resting_forces[0], 3.0 * kG, 1e-8);
  EXPECT_NEAR(world.scene.state[1].x.z(), 0.5 + 1.6, 1e-8);
}

TEST(EventStepper, ABallThatSlidesOffAFixedBallLeavesItWhereTheForceEnds) {
  // Without friction, from v0 at the top of a circle of radius rho: it leaves where cos
  // theta = 2/3 + v0^2/(3 g rho).
  World world;
  world.colliders.clear();
  world.colliders.push_back(scenes::collider(0, Sphere{1.0}, 1.0));
  const double rho = 1.25;
  const double v0 = 2.0;
  world.add(scenes::ball(1.0, 0.25), Sphere{0.25}, Vec3(0, 0, rho), 0.0,
            {Vec3(v0, 0, 0), Vec3::Zero()});
  EventSettings settings;
  settings.tolerance = 1e-7;
  settings.most_events = 1;  // ends there
  CollisionWorld finder(world.scene.bodies, world.colliders, PairingRule::kMultiply);
  EventStepper stepper(world.scene.bodies, finder, settings);
  EventReport report;
  stepper.advance(world.scene.state, 1.5, report);
  ASSERT_EQ(count(report, EventKind::kBreakUp), 1);
  const double cosine = world.scene.state[1].x.z() / world.scene.state[1].x.norm();
  EXPECT_NEAR(cosine, 2.0 / 3.0 + v0 * v0 / (3.0 * kG * rho), 1e-3);
  // Some 100 segments, each good to 1e-7 m or better in its own way.
  EXPECT_NEAR(world.energy(Vec3(0, 0, -kG)), 0.5 * v0 * v0 + kG * rho, 1e-4);
  EXPECT_NEAR(world.scene.state[1].x.norm(), rho, 2e-6);
}

TEST(EventStepper, ATopInFlightKeepsEnergyAndMomentum) {
  World world;
  Body top = scenes::box(1.0, Vec3(1, 0.6, 0.2));
  world.add(top, Sphere{0.05}, Vec3(0, 0, 30), 1.0, {Vec3(1, 0, 3), Vec3(3, 4, 1)});
  const Vec3 L = world.scene.state[1].L;
  const double spin =
      kinetic_energy(top, world.scene.state[1]) - 0.5 * world.scene.state[1].p.squaredNorm();
  world.run(2.0);
  EXPECT_EQ(world.scene.state[1].L, L);
  const BodyState& end = world.scene.state[1];
  EXPECT_NEAR(kinetic_energy(top, end) - 0.5 * end.p.squaredNorm(), spin, 1e-12 * spin);
  EXPECT_NEAR(end.x.z(), 30 + 6 - 2 * kG, 1e-11);
}

TEST(EventStepper, EndsAtTheMostEventsWithItsStatus) {
  World world;
  world.add(scenes::ball(1.0, 0.5), Sphere{0.5}, Vec3(0, 0, 1.5), 1.0);
  EventSettings settings;
  settings.most_events = 3;
  CollisionWorld finder(world.scene.bodies, world.colliders, PairingRule::kMultiply);
  EventStepper stepper(world.scene.bodies, finder, settings);
  EventReport report;
  stepper.advance(world.scene.state, 100.0, report);
  EXPECT_EQ(report.status, lcp::Status::kIterationLimit);
  EXPECT_EQ(report.events.size(), 3u);
  EXPECT_NEAR(report.time, 5.0 * std::sqrt(2.0 / kG), 1e-8);
}

TEST(EventStepper, EndsAtTheMostSegmentsAndAtTheTimeLimitWithItsStatus) {
  for (const bool by_time : {false, true}) {
    World world;
    world.add(scenes::ball(1.0, 0.5), Sphere{0.5}, Vec3(0, 0, 1e4), 1.0);
    EventSettings settings;
    settings.most_segments = by_time ? settings.most_segments : 3;
    settings.time_limit = by_time ? 1e-9 : settings.time_limit;
    CollisionWorld finder(world.scene.bodies, world.colliders, PairingRule::kMultiply);
    EventStepper stepper(world.scene.bodies, finder, settings);
    EventReport report;
    stepper.advance(world.scene.state, 10.0, report);
    EXPECT_EQ(report.status, by_time ? lcp::Status::kTimeLimit : lcp::Status::kIterationLimit);
    EXPECT_EQ(report.segments, by_time ? 0 : 3);
    EXPECT_NE(report.detail.find(by_time ? "time_limit at 0 s" : "most_segments at"),
              std::string::npos)
        << report.detail;
    const double t = report.time;
    EXPECT_LT(t, 1.0);
    EXPECT_NEAR(world.scene.state[1].x.z(), 1e4 - 0.5 * kG * t * t, 1e-9);
  }
}

TEST(EventStepper, BadInputIsNamed) {
  World world;
  world.add(scenes::ball(1.0, 0.5), Sphere{0.5}, Vec3(0, 0, 0.5), 0.0);
  CollisionWorld finder(world.scene.bodies, world.colliders, PairingRule::kMultiply);
  EventReport report;
  EventStepper stepper(world.scene.bodies, finder, {});
  EXPECT_THROW(stepper.advance(world.scene.state, -1.0, report), std::invalid_argument);
  for (const auto& spoil : std::vector<void (*)(EventSettings&)>{
           [](EventSettings& s) { s.tolerance = 0.0; }, [](EventSettings& s) { s.touching = -1.0; },
           [](EventSettings& s) { s.resting_speed = 0.0; },
           [](EventSettings& s) { s.separating_speed = 0.0; },
           [](EventSettings& s) { s.longest_segment = 0.0; },
           [](EventSettings& s) { s.sticking_speed = 0.0; },
           [](EventSettings& s) { s.most_events = 0; },
           [](EventSettings& s) { s.most_segments = 0; },
           [](EventSettings& s) { s.time_limit = 0.0; },
           [](EventSettings& s) { s.resting.friction_lcp.tolerance = std::nan(""); },
           [](EventSettings& s) { s.gravity.x() = std::nan(""); }}) {
    EventSettings bad;
    spoil(bad);
    EXPECT_THROW(bad.validate(), std::invalid_argument);
  }
  world.colliders[1].material.rolling_friction = 0.1;
  CollisionWorld rough(world.scene.bodies, world.colliders, PairingRule::kMultiply);
  EventStepper refused(world.scene.bodies, rough, {});
  EXPECT_THROW(refused.advance(world.scene.state, 1.0, report), std::invalid_argument);
}

TEST(EventStepper, NoTimeAndNoBodies) {
  World world;
  EXPECT_EQ(world.run(0.0).events.size(), 0u);
  EXPECT_EQ(world.run(1.0).time, 1.0);
}

}  // namespace
}  // namespace signorini
