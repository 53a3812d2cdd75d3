#include <signorini/collision/collision_world.h>
#include <signorini/core/response/friction_cones.h>
#include <signorini/lcp/solver.h>

#include "bench/limit_study.h"
#include "bench/masonry_scenes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <sstream>

namespace signorini::bench {
namespace {

constexpr double kStep = 1.0 / 60.0;

TEST(LimitAnalysis, ABlockOnASlopeNeedsItsTangent) {
  for (const double tangent : {0.1, 0.7, 2.5}) {
    const SteppedScene scene = slope_scene(tangent, kStep, 1.0);
    EXPECT_NEAR(critical_friction(scene).friction, tangent, 1e-8 * (1.0 + tangent));
  }
}

/// A point contact of body 1 with the ground.
Contact touching(const Vec3& point, const Vec3& normal) {
  Contact contact;
  contact.body_a = 1;
  contact.body_b = 0;
  contact.point_a = contact.point_b = point;
  contact.normal = normal;
  contact.gap = 0.0;
  return contact;
}

TEST(LimitAnalysis, ALadderNeedsTheTangentOfHalfItsLean) {
  // Wall and floor with one mu: tan(lean) = 2 mu/(1 - mu^2).
  SteppedScene scene = slope_scene(0.0, kStep, 1.0);
  scene.state[1].x = Vec3(0.0, 0.0, 2.0);
  for (const double lean : {0.2, 0.8, 1.4}) {
    const Vec3 half = 2.0 * Vec3(std::sin(lean), 0.0, std::cos(lean));
    const ContactSet contacts{touching(scene.state[1].x + half, -Vec3::UnitX()),
                              touching(scene.state[1].x - half, Vec3::UnitZ())};
    const LimitAnalysis limit =
        critical_friction(scene.bodies, scene.state, contacts, scene.gravity, Vec3::UnitY());
    EXPECT_NEAR(limit.friction, std::tan(0.5 * lean), 1e-8);
  }
}

TEST(LimitAnalysis, WhatNoFrictionHoldsIsSaid) {
  SteppedScene scene = slope_scene(0.0, kStep, 1.0);
  const ContactSet beside{touching(scene.state[1].x + Vec3(0.5, 0.0, 0.0), Vec3::UnitZ())};
  EXPECT_EQ(
      critical_friction(scene.bodies, scene.state, beside, scene.gravity, Vec3::UnitY()).friction,
      std::numeric_limits<double>::infinity());
}

/// |v+|_inf of one step from rest by the associated law with exact cones, whose forces carry the
/// weights if any do.
double speed_with(double friction, const Masonry& structure) {
  const SteppedScene scene = structure(friction);
  collision::CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  ContactSet contacts;
  world.find(scene.state, 1e-6, contacts);
  State pulled = scene.state;
  for (std::size_t k = 1; k < pulled.size(); ++k) {
    pulled[k].p = kStep * scene.bodies[k].mass * scene.gravity;
  }
  ConeProblem cones;
  const auto count = static_cast<lcp::Index>(contacts.size());
  assemble_cones(scene.bodies, pulled, contacts, lcp::Vector::Zero(count), cones);
  cones.problem.friction_law = lcp::FrictionLaw::kAssociated;
  lcp::Result result;
  lcp::make_solver("auto", {.tolerance = 1e-10})->solve(cones.problem, result);
  EXPECT_TRUE(lcp::is_solved(result.status)) << lcp::to_string(result.status);
  return result.w.cwiseAbs().maxCoeff();
}

TEST(LimitAnalysis, AgreesWithTheAssociatedConeProblem) {
  for (const Masonry& structure :
       {Masonry([](double mu) { return card_house_scene(2, mu, kStep, 1.0); }),
        Masonry([](double mu) { return arch_scene(7, mu, kStep, 1.0); })}) {
    const double critical = critical_friction(structure(1.0)).friction;
    EXPECT_LT(speed_with(1.001 * critical, structure), 1e-8);
    EXPECT_GT(speed_with(0.999 * critical, structure), 1e-6);
  }
}

TEST(LimitStudy, StructuresStandAboveTheirFrictionAndFallBelow) {
  TimeStepSettings settings;
  settings.accuracy = Accuracy::engineering();
  std::ostringstream out;
  LimitOptions options;
  options.seconds = 1.0;
  const LimitReport report =
      run_limit_study(options,
                      {[](double mu) { return card_house_scene(2, mu, kStep, 1.0); },
                       [](double mu) { return arch_scene(15, mu, kStep, 1.0); }},
                      our_stepper("ours", settings), out);
  EXPECT_TRUE(report.passed) << out.str();
  ASSERT_EQ(report.rows.size(), 4U);
  EXPECT_LT(report.rows[0].drift, 1e-9);
  EXPECT_NEAR(report.rows[2].critical, 0.308988, 1e-6);  // more stones, the same sliding base
  EXPECT_NE(report.to_csv().find("arch of 15"), std::string::npos);

  LimitRow stood = report.rows[0];
  stood.factor = 0.9;
  EXPECT_FALSE(stood.as_it_should(options));
  LimitRow fell = report.rows[1];
  fell.factor = 1.05;
  EXPECT_FALSE(fell.as_it_should(options));
}

}  // namespace
}  // namespace signorini::bench
