#include <signorini/core/response/energy_safe.h>
#include <signorini/core/response/friction_cones.h>
#include <signorini/core/response/impact.h>
#include <signorini/core/response/reflections.h>

#include "response_scenes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numbers>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

using scenes::Scene;

ImpactReport resolve(Scene& scene, const ImpactSettings& settings) {
  ImpactReport report;
  resolve_impact(scene.bodies, scene.contacts, settings, scene.state, report);
  return report;
}

Vec3 momentum(const Scene& scene) {
  Vec3 sum = Vec3::Zero();
  for (const BodyState& state : scene.state) {
    sum += state.p;
  }
  return sum;
}

// ---- generalized reflections

TEST(Reflections, TheTouchingCradleSendsTheLastBallAway) {
  for (const bool safe : {false, true}) {
    Scene scene = scenes::cradle(5, 2.0, 1.0);
    const ImpactReport report =
        resolve(scene, {.law = ImpactLaw::kReflections, .energy_safe = safe});
    EXPECT_TRUE(lcp::is_solved(report.status));
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(scene.velocity_of(i).linear.x(), i == 4 ? 2.0 : 0.0, 1e-12);
    }
    EXPECT_NEAR(report.energy_after, report.energy_before, 1e-12);
    EXPECT_EQ(report.passes, 4);
    EXPECT_EQ(report.theta[0], 1.0);
  }
}

TEST(Reflections, AreTheDefaultAndPartOfTheCradleBreaksAwayForELessThan1) {
  Scene scene = scenes::cradle(5, 1.0, 0.5);
  const ImpactReport report = resolve(scene, {});
  EXPECT_TRUE(lcp::is_solved(report.status));
  // f_c: all 1/5; f_1: (0, 0, 0, 0, 1); half way between.
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(scene.velocity_of(i).linear.x(), i == 4 ? 0.6 : 0.1, 1e-12);
  }
  EXPECT_LT(report.relative_energy_gain(), 0.0);
  EXPECT_NEAR(momentum(scene).x(), 1.0, 1e-12);
}

TEST(Reflections, ASymmetricBreakStaysSymmetricInEveryOrder) {
  // One ball runs into the gap of two that touch: the three centres form a triangle.
  std::vector<int> order{0, 1, 2};
  do {
    Scene scene;
    const double height = std::sqrt(3.0) / 2.0;
    scene.add(scenes::ball(), Vec3::Zero(), {Vec3(1, 0, 0), Vec3::Zero()});
    const Vec3 up(height, 0.5, 0);
    const Vec3 down(height, -0.5, 0);
    scene.add(scenes::ball(), up);
    scene.add(scenes::ball(), down);
    scene.touch(1, 0, 0.5 * up, up, 1.0);
    scene.touch(2, 0, 0.5 * down, down, 1.0);
    scene.touch(1, 2, Vec3(height, 0, 0), Vec3::UnitY(), 1.0);
    const ContactSet given = scene.contacts;
    for (int i = 0; i < 3; ++i) {
      scene.contacts[i] = given[order[i]];
    }
    const ImpactReport report = resolve(scene, {});
    EXPECT_TRUE(lcp::is_solved(report.status));
    const Vec3 left = scene.velocity_of(1).linear;
    const Vec3 right = scene.velocity_of(2).linear;
    EXPECT_NEAR(left.x(), right.x(), 1e-12);
    EXPECT_NEAR(left.y(), -right.y(), 1e-12);
    EXPECT_NEAR(scene.velocity_of(0).linear.x(), -0.2, 1e-12);  // A f = 2 d', f = 2 h / (1 + 2 h^2)
    EXPECT_NEAR(report.energy_after, report.energy_before, 1e-12);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Reflections, ALightBallBeforeAWallNeedsAsManyAsTheAngleSays) {
  // Wall, ball of mass 1, ball of mass 100^2 running at them: collisions unfold to straight lines
  // in a wedge of angle atan(1/100); the first digits of pi are how often it is crossed.
  Scene scene;
  const int wall = scene.add(scenes::fixed_body(), Vec3(-1, 0, 0));
  const int light = scene.add(scenes::ball(), Vec3::Zero());
  const int heavy = scene.add(scenes::ball(1e4), Vec3(1, 0, 0), {Vec3(-1, 0, 0), Vec3::Zero()});
  scene.touch(light, wall, Vec3(-0.5, 0, 0), Vec3::UnitX(), 1.0);
  scene.touch(heavy, light, Vec3(0.5, 0, 0), Vec3::UnitX(), 1.0);
  Scene capped = scene;
  const ImpactReport report = resolve(scene, {});
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_EQ(report.passes, 314);
  EXPECT_NEAR(report.energy_after, report.energy_before, 1e-12 * report.energy_before);

  ImpactSettings few;
  few.max_passes = 313;
  const ImpactReport stopped = resolve(capped, few);
  EXPECT_EQ(stopped.law_status, lcp::Status::kIterationLimit);
  EXPECT_TRUE(lcp::is_solved(stopped.status));
  EXPECT_EQ(stopped.theta[0], 0.0);
}

TEST(Reflections, BetweenOppositeWallsTheyAreShownNotToEnd) {
  Scene scene = scenes::opposite_walls(1.0, 1.0);
  const ImpactReport report = resolve(scene, {});
  EXPECT_EQ(report.law_status, lcp::Status::kInfeasible);
  EXPECT_EQ(report.passes, kReflectionsAtEase);
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_EQ(report.theta[0], 0.0);
  EXPECT_LE(scene.velocity_of(0).linear.norm(), 1e-12);
}

TEST(Reflections, TheDrivenBodysWorkBalances) {
  Scene scene;
  const int first = scene.add(scenes::ball(), Vec3::Zero());
  const int second = scene.add(scenes::ball(), Vec3(1, 0, 0));
  const int paddle =
      scene.add(scenes::kinematic_body(), Vec3(-1, 0, 0), {Vec3(2, 0, 0), Vec3::Zero()});
  scene.touch(first, paddle, Vec3(-0.5, 0, 0), Vec3::UnitX(), 1.0);
  scene.touch(second, first, Vec3(0.5, 0, 0), Vec3::UnitX(), 1.0);
  const ImpactReport report = resolve(scene, {});
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_NEAR(scene.velocity_of(first).linear.x(), 4.0, 1e-12);  // struck twice
  EXPECT_NEAR(scene.velocity_of(second).linear.x(), 4.0, 1e-12);
  EXPECT_NEAR(report.energy_gain(), 0.0, 1e-12);
  EXPECT_NEAR(report.driver_work, 16.0, 1e-12);
}

TEST(Reflections, OneRestitutionIsExactAndMixedOnesAreBetween) {
  const Scene scene = scenes::rod_on_two_supports(0.3, 1.0, 0.7);
  lcp::Vector d_dot(3);
  d_dot << -1.0, 0.0, -2.0;
  const lcp::Vector f = lcp::Vector::Ones(3);
  EXPECT_EQ(common_restitution(scene.contacts, d_dot, f, 0.0), 0.7);
  ContactSet mixed = scene.contacts;
  mixed[0].material.restitution = 0.1;
  mixed[1].material.restitution = 1.0;  // does not collide
  EXPECT_NEAR(common_restitution(mixed, d_dot, f, 0.0), (0.1 + 2.0 * 0.7) / 3.0, 1e-15);
  EXPECT_EQ(common_restitution(mixed, d_dot, f, 1.5), 0.7);
  EXPECT_EQ(common_restitution(mixed, d_dot, f, 3.0), 0.0);
  EXPECT_EQ(common_restitution({}, lcp::Vector(), lcp::Vector(), 0.0), 0.0);
}

// ---- Poisson

TEST(Poisson, UnderAnOverhangItGainsNothingForACommonRestitution) {
  for (const double e : {0.0, 0.4, 1.0}) {
    Scene scene = scenes::overhang(e);
    const ImpactReport report = resolve(scene, {.law = ImpactLaw::kPoisson, .energy_safe = false});
    EXPECT_TRUE(lcp::is_solved(report.status));
    EXPECT_LE(report.relative_energy_gain(), 1e-14);
  }
}

TEST(Poisson, RandomScenesWithACommonRestitutionNeverGain) {
  std::mt19937_64 random(11);
  int solved = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Scene scene = scenes::random_scene(random, 4, 8);
    const double e = 0.1 * (trial % 11);
    for (Contact& contact : scene.contacts) {
      contact.material.restitution = e;
    }
    scene.bodies[5].kind = BodyKind::kFixed;  // no driver
    scene.state[5].p.setZero();
    scene.state[5].L.setZero();
    const ImpactReport report = resolve(scene, {.law = ImpactLaw::kPoisson, .energy_safe = false});
    if (lcp::is_solved(report.status)) {
      ++solved;
      EXPECT_LE(report.relative_energy_gain(), 1e-12);
      EXPECT_GE(report.impulses.minCoeff(), 0.0);
    }
  }
  EXPECT_GT(solved, 35);
}

TEST(Poisson, TheOrderOfRedundantContactsWithDifferentRestitutionPlaysNoPart) {
  Scene scene = scenes::box_on_ground(1.0, Vec3(1, 0.6, 0.4), 0.2, Vec3(0, 0, -1), 0.5);
  scene.contacts[1].material.restitution = 0.9;
  Scene turned = scene;
  std::reverse(turned.contacts.begin(), turned.contacts.end());
  const ImpactSettings poisson{.law = ImpactLaw::kPoisson};
  EXPECT_TRUE(lcp::is_solved(resolve(scene, poisson).status));
  EXPECT_TRUE(lcp::is_solved(resolve(turned, poisson).status));
  EXPECT_LE((scene.state[0].L - turned.state[0].L).norm(), 1e-12);
  EXPECT_LE((scene.state[0].p - turned.state[0].p).norm(), 1e-12);
}

// ---- friction

ImpactSettings frictional(ImpactLaw law) {
  ImpactSettings settings{.law = law};
  settings.friction = true;
  settings.lcp.tolerance = 1e-11;
  return settings;
}

class FrictionLaw : public testing::TestWithParam<ImpactLaw> {};

INSTANTIATE_TEST_SUITE_P(Both, FrictionLaw,
                         testing::Values(ImpactLaw::kNewton, ImpactLaw::kReflections),
                         [](const auto& tested) { return std::string(to_string(tested.param)); });

TEST_P(FrictionLaw, ContactsThatResistTurningAreRefused) {
  Scene scene;
  scene.add(scenes::ball(), Vec3(0, 0, 0.5), {Vec3(0, 0, -2.0), Vec3::Zero()});
  scene.add(scenes::fixed_body(), Vec3::Zero());
  scene.touch(0, 1, Vec3::Zero(), Vec3::UnitZ(), 0.0).material.rolling_friction = 0.01;
  try {
    (void)resolve(scene, frictional(GetParam()));
    FAIL() << "was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("contact 0: rolling and spinning friction"),
              std::string::npos)
        << error.what();
  }
}

TEST_P(FrictionLaw, ABallThatHitsTheFloorAtAnAngleSlidesOrGrips) {
  // m = 1, r = 1/2, J = 2/5 m r^2. Normal: f = (1 + e) s. Sliding: f_T = mu f. Gripping: the
  // effective tangential mass is 2/7 m, so f_T = 2/7 v.
  for (const auto& [mu, v] : {std::pair{0.1, 3.0}, {0.5, 1.0}, {0.3, 0.2}}) {
    const double e = 0.6;
    Scene scene;
    scene.add(scenes::ball(), Vec3(0, 0, 0.5), {Vec3(v, 0, -2.0), Vec3::Zero()});
    scene.add(scenes::fixed_body(), Vec3::Zero());
    scene.touch(0, 1, Vec3::Zero(), Vec3::UnitZ(), e).material.friction = mu;
    const ImpactReport report = resolve(scene, frictional(GetParam()));
    ASSERT_TRUE(lcp::is_solved(report.status));
    const double expected = std::min(mu * (1 + e) * 2.0, 2.0 / 7.0 * v);
    EXPECT_NEAR(report.contact_impulses[0].z(), (1 + e) * 2.0, 1e-10);
    EXPECT_LE(report.relative_energy_gain(), 0.0);
    EXPECT_NEAR(report.energy_gain(), report.gain_from_impulses, 1e-12 * report.energy_before);
    if (GetParam() == ImpactLaw::kNewton) {
      EXPECT_NEAR(scene.velocity_of(0).linear.x(), v - expected, 1e-10);
      EXPECT_EQ(report.theta[0], 1.0);
    }
  }
}

TEST_P(FrictionLaw, RandomScenesStayInTheConesAndNeverGain) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> uniform(0.0, 1.2);
  int solved = 0;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    Scene scene = scenes::random_scene(random, 4, 7);
    for (Contact& contact : scene.contacts) {
      contact.material.friction = trial % 5 == 0 ? 0.0 : uniform(random);
    }
    const ImpactReport report = resolve(scene, frictional(GetParam()));
    if (!lcp::is_solved(report.status)) {
      continue;
    }
    ++solved;
    EXPECT_LE(report.relative_energy_gain(), 1e-12);
    const double scale = report.energy_before + report.energy_after + std::abs(report.driver_work);
    EXPECT_NEAR(report.energy_gain(), report.gain_from_impulses, 1e-12 * scale);
    for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
      const Vec3& N = scene.contacts[i].normal;
      const Vec3& f = report.contact_impulses[i];
      const double normal = f.dot(N);
      EXPECT_GE(normal, -1e-12);
      EXPECT_LE((f - normal * N).norm(), scene.contacts[i].material.friction * normal + 1e-9);
    }
    EXPECT_GE(report.d_dot_after.minCoeff(), -1e-9 * report.d_dot_before.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(solved, 30);
}

TEST_P(FrictionLaw, WithoutFrictionItIsTheFrictionlessImpact) {
  for (Scene scene : {scenes::wedge(1.0, 0.4), scenes::rod_on_two_supports(1.5, 1.0, 0.5),
                      scenes::cradle(4, 1.0, 1.0)}) {
    Scene smooth = scene;
    const ImpactReport report = resolve(scene, frictional(GetParam()));
    EXPECT_TRUE(lcp::is_solved(report.status));
    resolve(smooth, {.law = GetParam()});
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      EXPECT_LE((scene.state[k].p - smooth.state[k].p).norm(), 1e-9);
      EXPECT_LE((scene.state[k].L - smooth.state[k].L).norm(), 1e-9);
    }
  }
}

TEST(FrictionImpact, IsRefusedForTheLawsThatHaveNone) {
  for (const ImpactLaw law : {ImpactLaw::kNotes, ImpactLaw::kPoisson, ImpactLaw::kSequentialOnce}) {
    Scene scene = scenes::wedge(1.0, 1.0);
    EXPECT_THROW(resolve(scene, frictional(law)), std::invalid_argument);
  }
}

TEST(FrictionCones, AllowancesMustMatchTheContacts) {
  const Scene scene = scenes::wedge(1.0, 1.0);
  ConeProblem cones;
  EXPECT_THROW(
      assemble_cones(scene.bodies, scene.state, scene.contacts, lcp::Vector::Zero(1), cones),
      std::invalid_argument);
  EXPECT_EQ(cones.problem.size(), 0);
}

TEST(LargestTheta, HasTheRootWhereFrictionLetsTheLineFallFirst) {
  for (const EnergyLine& line : {EnergyLine{-1.0, -1.0, 8.0}, EnergyLine{-0.1, -2.0, 9.0}}) {
    const double theta = largest_theta(line);
    EXPECT_GT(theta, 0.0);
    EXPECT_LT(theta, 1.0);
    const double gain = line.plastic + line.slope * theta + 0.5 * line.curvature * theta * theta;
    EXPECT_NEAR(gain, 0.0, 1e-14);
  }
  EXPECT_EQ(largest_theta({-1.0, -1.0, 2.0}), 1.0);
}

}  // namespace
}  // namespace signorini
