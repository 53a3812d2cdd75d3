#include <signorini/core/response/impact.h>

#include "response_scenes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace signorini {
namespace {

using scenes::Scene;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ImpactReport resolve(Scene& scene, const ImpactSettings& settings) {
  ImpactReport report;
  resolve_impact(scene.bodies, scene.contacts, settings, scene.state, report);
  return report;
}

bool same(const State& a, const State& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const BodyState& s, const BodyState& t) {
                      return s.x == t.x && s.q.coeffs() == t.q.coeffs() && s.p == t.p && s.L == t.L;
                    });
}

// ---- simultaneous laws

struct LawCase {
  ImpactLaw law;
  bool energy_safe;
};

class SimultaneousLaw : public testing::TestWithParam<LawCase> {
 protected:
  [[nodiscard]] ImpactSettings settings() const {
    return {.law = GetParam().law, .energy_safe = GetParam().energy_safe};
  }
};

INSTANTIATE_TEST_SUITE_P(
    All, SimultaneousLaw,
    testing::Values(LawCase{ImpactLaw::kNewton, false}, LawCase{ImpactLaw::kNewton, true},
                    LawCase{ImpactLaw::kNotes, false}, LawCase{ImpactLaw::kNotes, true},
                    LawCase{ImpactLaw::kPoisson, false}, LawCase{ImpactLaw::kPoisson, true},
                    LawCase{ImpactLaw::kReflections, false},
                    LawCase{ImpactLaw::kReflections, true}),
    [](const auto& tested) {
      return std::string(to_string(tested.param.law)) +
             (tested.param.energy_safe ? "EnergySafe" : "Plain");
    });

TEST_P(SimultaneousLaw, TheWedgeGoesStraightBackUpForE1AndStopsForE0) {
  const double s = 3.0;
  for (const double e : {0.0, 1.0}) {
    Scene scene = scenes::wedge(s, e);
    const ImpactReport report = resolve(scene, settings());
    EXPECT_TRUE(lcp::is_solved(report.status));
    EXPECT_LE((scene.velocity_of(0).linear - Vec3(0, e * s, 0)).norm(), 1e-12);
    EXPECT_LE(scene.velocity_of(0).angular.norm(), 1e-12);
    EXPECT_NEAR(report.energy_after, e * report.energy_before, 1e-12);
    // A f = -(1 + e) d'-, A = [[1, -1/sqrt 10], [-1/sqrt 10, 1]]
    Eigen::Matrix2d A;
    A << 1.0, -1.0 / std::sqrt(10.0), -1.0 / std::sqrt(10.0), 1.0;
    const Eigen::Vector2d f = A.inverse() * (-(1.0 + e) * report.d_dot_before);
    EXPECT_LE((report.impulses - f).norm(), 1e-12);
  }
}

TEST_P(SimultaneousLaw, TheTouchingCradleHasNoBreakAway) {
  if (GetParam().law == ImpactLaw::kReflections) {
    GTEST_SKIP() << "of reflections it has: Reflections.TheTouchingCradleSendsTheLastBallAway";
  }
  const double s = 2.0;
  Scene scene = scenes::cradle(5, s, 1.0);
  const ImpactReport report = resolve(scene, settings());
  EXPECT_TRUE(lcp::is_solved(report.status));
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(scene.velocity_of(i).linear.x(), (i == 0 ? -0.6 : 0.4) * s, 1e-12);
  }
  EXPECT_NEAR(report.energy_after, report.energy_before, 1e-12);
  EXPECT_NEAR(report.theta[0], 1.0, 1e-12);
}

TEST_P(SimultaneousLaw, ABoxThatLandsFlatDoesNotTurnInAnyOrderOfItsContacts) {
  std::vector<int> order{0, 1, 2, 3};
  do {
    for (const double e : {0.0, 0.3, 0.5, 0.9, 1.0}) {
      for (const double yaw : {0.0, 0.7}) {
        Scene scene = scenes::box_on_ground(1.7, Vec3(0.9, 0.31, 0.4), yaw, Vec3(0, 0, -2.3), e);
        const ContactSet given = scene.contacts;
        for (int i = 0; i < 4; ++i) {
          scene.contacts[i] = given[order[i]];
          scene.contacts[i].material.friction = 0.5;  // plays no part: nothing slides
        }
        const ImpactReport report = resolve(scene, settings());
        EXPECT_TRUE(lcp::is_solved(report.status));
        EXPECT_LE(scene.velocity_of(0).angular.norm(), 1e-12);
        EXPECT_LE((scene.velocity_of(0).linear - Vec3(0, 0, 2.3 * e)).norm(), 1e-12);
        EXPECT_NEAR(report.impulses.sum(), 1.7 * 2.3 * (1 + e), 1e-12);
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_P(SimultaneousLaw, OneContactIsTheClosedForm) {
  for (const double e : {0.0, 0.5, 1.0}) {
    Scene scene;
    scene.add(scenes::box(2.0, Vec3(1, 2, 3)), Vec3(0, 0, 1), {Vec3(1, 0, -3), Vec3(0.3, 0.2, 1)});
    scene.add(scenes::fixed_body(), Vec3::Zero());
    scene.touch(0, 1, Vec3(0.4, 0.9, 0), Vec3::UnitZ(), e);
    const ImpactReport report = resolve(scene, settings());
    EXPECT_EQ(report.status, lcp::Status::kSolved);
    EXPECT_EQ(report.law_result.solver, "closed form");
    EXPECT_EQ(report.plastic_result.status, lcp::Status::kNotRun);
    EXPECT_NEAR(report.d_dot_after[0], -e * report.d_dot_before[0], 1e-13 * 10);
    EXPECT_EQ(report.theta[0], 1.0);
  }
}

TEST_P(SimultaneousLaw, SeparatingAndRestingContactsAreLeftAlone) {
  Scene scene;
  scene.add(scenes::ball(), Vec3(0, 0, 0.5), {Vec3(0, 0, 1), Vec3::Zero()});
  scene.add(scenes::fixed_body(), Vec3::Zero());
  scene.touch(0, 1, Vec3(0.1, 0, 0), Vec3::UnitZ(), 1.0);
  scene.touch(0, 1, Vec3(0, 0, 0), Vec3::UnitX(), 1.0);
  const State before = scene.state;
  const ImpactReport report = resolve(scene, settings());
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_LE(report.impulses.cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LE((scene.state[0].p - before[0].p).norm(), 1e-14);
  EXPECT_EQ(report.theta[0], 1.0);
}

TEST_P(SimultaneousLaw, AFarSupportLiftsWhenTheRodIsHitBeyondTheOther) {
  Scene scene = scenes::rod_on_two_supports(1.5, 1.0, 0.5);
  const ImpactReport report = resolve(scene, settings());
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_GT(report.d_dot_after[0], 0.1);
  EXPECT_GE(report.d_dot_after.minCoeff(), -1e-12);
  EXPECT_GE(report.impulses.minCoeff(), 0.0);
}

TEST_P(SimultaneousLaw, ADrivenBodyDoesTheWork) {
  if (GetParam().law == ImpactLaw::kReflections) {
    GTEST_SKIP() << "these balls stay together, by reflections they part: "
                    "Reflections.TheDrivenBodysWorkBalances";
  }
  const double speed = 2.0;
  for (const double e : {0.0, 0.5, 1.0}) {
    for (const bool paddle_is_a : {false, true}) {
      // Two balls in a row at rest, the first one struck by a driven paddle.
      Scene scene;
      const int first = scene.add(scenes::ball(), Vec3(0, 0, 0));
      const int second = scene.add(scenes::ball(3.0), Vec3(1, 0, 0));
      const int paddle =
          scene.add(scenes::kinematic_body(), Vec3(-1, 0, 0), {Vec3(speed, 0, 0), Vec3::Zero()});
      if (paddle_is_a) {
        scene.touch(paddle, first, Vec3(-0.5, 0, 0), Vec3(-1, 0, 0), e);
      } else {
        scene.touch(first, paddle, Vec3(-0.5, 0, 0), Vec3(1, 0, 0), e);
      }
      scene.touch(second, first, Vec3(0.5, 0, 0), Vec3(1, 0, 0), e);
      const ImpactReport report = resolve(scene, settings());
      EXPECT_TRUE(lcp::is_solved(report.status));
      EXPECT_NEAR(scene.velocity_of(first).linear.x(), (1 + e) * speed, 1e-12);
      EXPECT_NEAR(scene.velocity_of(second).linear.x(), (1 + e) * speed, 1e-12);
      EXPECT_EQ(scene.velocity_of(paddle).linear.x(), speed);
      EXPECT_NEAR(report.driver_work, 4.0 * (1 + e) * speed * speed, 1e-11);
      EXPECT_NEAR(report.energy_after, 2.0 * (1 + e) * (1 + e) * speed * speed, 1e-11);
      EXPECT_LE(report.relative_energy_gain(), 1e-12);
      EXPECT_NEAR(report.energy_gain(), report.gain_from_impulses, 1e-12);
    }
  }
}

TEST_P(SimultaneousLaw, TheEnergyFromTheMomentaIsTheEnergyFromTheImpulses) {
  std::mt19937_64 random(4);
  int solved = 0;
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    Scene scene = scenes::random_scene(random, 4, 8);
    const State before = scene.state;
    const ImpactReport report = resolve(scene, settings());
    if (!lcp::is_solved(report.status)) {
      EXPECT_TRUE(same(before, scene.state));
      continue;
    }
    ++solved;
    const double scale = report.energy_before + report.energy_after + std::abs(report.driver_work);
    EXPECT_NEAR(report.energy_gain(), report.gain_from_impulses, 1e-12 * scale);
    EXPECT_GE(report.impulses.minCoeff(), 0.0);
    EXPECT_GE(report.d_dot_after.minCoeff(), -1e-10 * report.d_dot_before.cwiseAbs().maxCoeff());
    if (GetParam().energy_safe) {
      EXPECT_LE(report.relative_energy_gain(), 1e-12);
    }
  }
  EXPECT_GT(solved, 30);
}

TEST_P(SimultaneousLaw, NoContactsIsSolvedAndChangesNothing) {
  Scene scene = scenes::wedge(1.0, 1.0);
  scene.contacts.clear();
  const State before = scene.state;
  const ImpactReport report = resolve(scene, settings());
  EXPECT_EQ(report.status, lcp::Status::kSolved);
  EXPECT_EQ(report.impulses.size(), 0);
  EXPECT_EQ(report.theta.size(), 0);
  EXPECT_EQ(report.energy_gain(), 0.0);
  EXPECT_EQ(report.relative_energy_gain(), 0.0);
  EXPECT_TRUE(same(before, scene.state));
}

TEST_P(SimultaneousLaw, ScalingMassesScalesImpulsesAlone) {
  Scene scene = scenes::rod_on_two_supports(1.5, 1.0, 0.5);
  Scene heavy = scene;
  const double factor = 1024.0;
  for (std::size_t k = 0; k < heavy.bodies.size(); ++k) {
    heavy.bodies[k].mass *= factor;
    heavy.bodies[k].inertia *= factor;
    heavy.state[k].p *= factor;
    heavy.state[k].L *= factor;
  }
  const ImpactReport light_report = resolve(scene, settings());
  const ImpactReport heavy_report = resolve(heavy, settings());
  EXPECT_LE((heavy_report.d_dot_after - light_report.d_dot_after).norm(), 1e-12);
  EXPECT_LE((heavy_report.impulses / factor - light_report.impulses).norm(), 1e-12);
}

TEST_P(SimultaneousLaw, SlowContactsHaveNoRestitution) {
  Scene scene = scenes::wedge(0.5, 1.0);
  ImpactSettings slow = settings();
  slow.colliding_threshold = 1.0;
  EXPECT_TRUE(lcp::is_solved(resolve(scene, slow).status));
  EXPECT_LE(scene.velocity_of(0).linear.norm(), 1e-12);
}

TEST_P(SimultaneousLaw, StarvationIsItsOwnStatusAndChangesNothing) {
  Scene scene = scenes::wedge(1.0, 1.0);
  const State before = scene.state;
  ImpactSettings starved = settings();
  starved.solver = "pgs";
  starved.lcp.max_iterations = 1;
  const ImpactReport report = resolve(scene, starved);
  EXPECT_EQ(report.status, lcp::Status::kIterationLimit);
  EXPECT_EQ(report.energy_after, report.energy_before);
  EXPECT_EQ(report.d_dot_after, report.d_dot_before);
  EXPECT_EQ(report.impulses.size(), 2);
  EXPECT_TRUE(std::isnan(report.theta[0]));
  EXPECT_TRUE(same(before, scene.state));
}

// ---- where the laws differ

TEST(NewtonImpact, OppositeWallsAreInfeasibleAndPlainChangesNothing) {
  Scene scene = scenes::opposite_walls(1.0, 0.5);
  const State before = scene.state;
  const ImpactReport report = resolve(scene, {.law = ImpactLaw::kNewton, .energy_safe = false});
  EXPECT_EQ(report.status, lcp::Status::kInfeasible);
  EXPECT_EQ(report.law_result.ray_bound, std::numeric_limits<double>::infinity());
  EXPECT_EQ(report.law_result.ray.size(), 2);
  EXPECT_TRUE(same(before, scene.state));
}

TEST(NewtonImpact, OppositeWallsAreAnsweredByThePlasticImpulsesWhenEnergySafe) {
  Scene scene = scenes::opposite_walls(1.0, 0.5);
  const ImpactReport report = resolve(scene, {.law = ImpactLaw::kNewton});
  EXPECT_EQ(report.status, lcp::Status::kSolved);
  EXPECT_EQ(report.law_status, lcp::Status::kInfeasible);
  EXPECT_EQ(report.plastic_result.status, lcp::Status::kSolved);
  EXPECT_EQ(report.theta[0], 0.0);
  EXPECT_LE(scene.velocity_of(0).linear.norm(), 1e-15);
  EXPECT_LE(report.relative_energy_gain(), 0.0);
  EXPECT_NE(report.detail.find("infeasible"), std::string::npos) << report.detail;
}

TEST(NewtonImpact, OppositeWallsWithRoundedNormalsHaveABoundZ) {
  Scene scene = scenes::opposite_walls(1.0, 0.5);
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  for (Contact& contact : scene.contacts) {
    contact.normal = turn * contact.normal;
    contact.point_a = contact.point_b = turn * contact.point_a;
  }
  scene.contacts[1].normal = turn * Vec3(-1, 1e-9, 0).normalized();
  scene.state[0].p = turn * scene.state[0].p;
  const ImpactReport report = resolve(scene, {.law = ImpactLaw::kNewton});
  EXPECT_TRUE(report.law_status == lcp::Status::kNoSolutionBelow ||
              report.law_status == lcp::Status::kInfeasible)
      << lcp::to_string(report.law_status);
  EXPECT_GT(report.law_result.ray_bound, 1e6);
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_LE(report.relative_energy_gain(), 0.0);
}

TEST(NewtonImpact, UnderAnOverhangItGainsAThirdOfTheEnergy) {
  Scene scene = scenes::overhang(1.0);
  const ImpactReport report = resolve(scene, {.law = ImpactLaw::kNewton, .energy_safe = false});
  EXPECT_TRUE(lcp::is_solved(report.status));
  // d'+ = (1, 0), so V+ = (1/sqrt 3, 1)
  EXPECT_LE((scene.velocity_of(0).linear - Vec3(1 / std::sqrt(3.0), 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(report.relative_energy_gain(), 1.0 / 3.0, 1e-12);
}

TEST(NotesImpact, UnderAnOverhangItGainsFourThirdsOfTheEnergy) {
  Scene scene = scenes::overhang(1.0);
  const ImpactReport report = resolve(scene, {.law = ImpactLaw::kNotes, .energy_safe = false});
  EXPECT_TRUE(lcp::is_solved(report.status));
  // d'+ = t = (1, 1/2), so V+ = (2/sqrt 3, 1)
  EXPECT_LE((scene.velocity_of(0).linear - Vec3(2 / std::sqrt(3.0), 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(report.relative_energy_gain(), 4.0 / 3.0, 1e-12);
}

TEST(EnergySafeImpact, UnderAnOverhangThetaIsTheClosedForm) {
  // f_c stops the mass; f_e gives V_e; theta |V_e| = |V-| = 1
  for (const auto& [law, squared] :
       {std::pair{ImpactLaw::kNewton, 4.0 / 3.0}, std::pair{ImpactLaw::kNotes, 7.0 / 3.0}}) {
    Scene scene = scenes::overhang(1.0);
    const ImpactReport report = resolve(scene, {.law = law});
    EXPECT_TRUE(lcp::is_solved(report.status));
    EXPECT_NEAR(report.theta[0], 1.0 / std::sqrt(squared), 1e-12);
    EXPECT_NEAR(scene.velocity_of(0).linear.norm(), 1.0, 1e-12);
    EXPECT_LE(report.relative_energy_gain(), 1e-12);
    EXPECT_GE(report.d_dot_after.minCoeff(), -1e-12);
    EXPECT_TRUE(lcp::is_solved(report.plastic_result.status));
  }
}

TEST(NotesImpact, OppositeWallsAreFeasibleBecauseTheTargetIsOnlyApproached) {
  Scene scene = scenes::opposite_walls(1.0, 0.5);
  const ImpactReport report = resolve(scene, {.law = ImpactLaw::kNotes, .energy_safe = false});
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_LE(scene.velocity_of(0).linear.norm(), 1e-12);
}

TEST(NotesImpact, TheBoundOnEveryContactIsInfeasibleForARodHitBeyondItsSupports) {
  Scene scene = scenes::rod_on_two_supports(1.5, 1.0, 0.5);
  const State before = scene.state;
  ImpactSettings settings{
      .law = ImpactLaw::kNotes, .energy_safe = false, .bound_every_contact = true};
  const ImpactReport plain = resolve(scene, settings);
  EXPECT_TRUE(plain.status == lcp::Status::kInfeasible ||
              plain.status == lcp::Status::kNoSolutionBelow)
      << lcp::to_string(plain.status);
  EXPECT_GT(plain.law_result.ray_bound, 1e6);
  EXPECT_TRUE(same(before, scene.state));

  settings.energy_safe = true;
  const ImpactReport safe = resolve(scene, settings);
  EXPECT_TRUE(lcp::is_solved(safe.status));
  EXPECT_FALSE(lcp::is_solved(safe.law_status));
  EXPECT_EQ(safe.theta[0], 0.0);
  EXPECT_GE(safe.d_dot_after.minCoeff(), -1e-12);
  EXPECT_LE(safe.relative_energy_gain(), 0.0);

  Scene between = scenes::rod_on_two_supports(0.5, 1.0, 0.5);
  settings.energy_safe = false;
  EXPECT_TRUE(lcp::is_solved(resolve(between, settings).status));
}

TEST(EnergySafeImpact, ABallSqueezedByTwoDrivenWallsHasNoAnswer) {
  Scene scene;
  scene.add(scenes::ball(), Vec3::Zero());
  scene.add(scenes::kinematic_body(), Vec3(-1, 0, 0), {Vec3(1, 0, 0), Vec3::Zero()});
  scene.add(scenes::kinematic_body(), Vec3(1, 0, 0), {Vec3(-1, 0, 0), Vec3::Zero()});
  scene.touch(0, 1, Vec3(-0.5, 0, 0), Vec3(1, 0, 0), 0.0);
  scene.touch(0, 2, Vec3(0.5, 0, 0), Vec3(-1, 0, 0), 0.0);
  const State before = scene.state;
  const ImpactReport report = resolve(scene, {});
  EXPECT_EQ(report.status, lcp::Status::kInfeasible);
  EXPECT_EQ(report.plastic_result.status, lcp::Status::kInfeasible);
  EXPECT_TRUE(std::isnan(report.theta[0]));
  EXPECT_TRUE(same(before, scene.state));
}

TEST(EnergySafeImpact, EachConnectedSetHasItsOwnFate) {
  Scene scene = scenes::opposite_walls(1.0, 0.5);
  const int far = scene.add(scenes::ball(), Vec3(9, 0, 0), {Vec3(0, -1, 0), Vec3::Zero()});
  const int overhung = scene.add(scenes::ball(), Vec3(19, 0, 0), {Vec3(0, -1, 0), Vec3::Zero()});
  scene.touch(far, 1, Vec3(9, -0.5, 0), Vec3(0, 1, 0), 1.0);
  scene.touch(overhung, 1, Vec3(19, 0, 0), Vec3(0, 1, 0), 1.0);
  scene.touch(overhung, 1, Vec3(19, 0, 0), Vec3(0.5 * std::sqrt(3.0), -0.5, 0), 1.0);
  const ImpactReport report = resolve(scene, {.law = ImpactLaw::kNewton});
  EXPECT_EQ(report.set_of_contact, (std::vector<int>{0, 0, 1, 2, 2}));
  ASSERT_EQ(report.theta.size(), 3);
  EXPECT_EQ(report.theta[0], 0.0);
  EXPECT_EQ(report.theta[1], 1.0);
  EXPECT_NEAR(report.theta[2], std::sqrt(0.75), 1e-12);
  EXPECT_EQ(report.law_status_of_set[0], lcp::Status::kInfeasible);
  EXPECT_EQ(report.law_status_of_set[1], lcp::Status::kSolved);
  EXPECT_EQ(report.law_status, lcp::Status::kInfeasible);
  EXPECT_EQ(report.law_result.status, lcp::Status::kInfeasible);
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_LE((scene.velocity_of(far).linear - Vec3(0, 1, 0)).norm(), 1e-12);
}

// ---- sequential laws

TEST(SequentialImpact, TheWedgeRepeatedEndsWhereTheOrderDecides) {
  const double s = 3.0;
  const std::vector<std::pair<std::vector<int>, Vec3>> cases{
      {{}, Vec3(-0.6 * s, 0.8 * s, 0)},
      {{0, 1}, Vec3(-0.6 * s, 0.8 * s, 0)},
      {{1, 0}, Vec3(7.0 / 25.0 * s, 24.0 / 25.0 * s, 0)}};
  for (const auto& [order, expected] : cases) {
    Scene scene = scenes::wedge(s, 1.0);
    ImpactSettings settings{.law = ImpactLaw::kSequentialRepeated};
    settings.order = order;
    const ImpactReport report = resolve(scene, settings);
    EXPECT_EQ(report.status, lcp::Status::kSolved);
    EXPECT_LE((scene.velocity_of(0).linear - expected).norm(), 1e-12);
    EXPECT_NEAR(report.energy_after, report.energy_before, 1e-12);
    EXPECT_NEAR(report.energy_gain(), report.gain_from_impulses, 1e-12);
    const bool second_first = !order.empty() && order[0] == 1;
    EXPECT_EQ(report.passes, second_first ? 2 : 1);
    EXPECT_GE(report.d_dot_after.minCoeff(), 0.0);
  }
}

TEST(SequentialImpact, OnePassFromTheSecondContactLeavesItApproaching) {
  const double s = 3.0;
  Scene scene = scenes::wedge(s, 1.0);
  ImpactSettings settings{.law = ImpactLaw::kSequentialOnce};
  settings.order = {1, 0};
  const ImpactReport report = resolve(scene, settings);
  EXPECT_EQ(report.status, lcp::Status::kSolved);
  EXPECT_LE((scene.velocity_of(0).linear - Vec3(0.6 * s, 0.8 * s, 0)).norm(), 1e-12);
  EXPECT_LT(report.d_dot_after[1], -0.1);
  EXPECT_EQ(report.passes, 1);
}

TEST(SequentialImpact, BetweenOppositeWallsItNeverEndsForE1AndFadesForLess) {
  Scene elastic = scenes::opposite_walls(1.0, 1.0);
  const State before = elastic.state;
  ImpactSettings settings{.law = ImpactLaw::kSequentialRepeated};
  settings.max_passes = 500;
  const ImpactReport capped = resolve(elastic, settings);
  EXPECT_EQ(capped.status, lcp::Status::kIterationLimit);
  EXPECT_EQ(capped.passes, 500);
  EXPECT_GT(capped.impulses[0], 100.0);
  EXPECT_TRUE(same(before, elastic.state));

  Scene fading = scenes::opposite_walls(1.0, 0.5);
  const ImpactReport faded = resolve(fading, settings);
  EXPECT_EQ(faded.status, lcp::Status::kSolved);
  EXPECT_LE(fading.velocity_of(0).linear.norm(), 1e-12);
  EXPECT_LE(faded.passes, 25);  // 0.25 a pass, down to 1e-12: 20
}

TEST(SequentialImpact, NeverGainsEnergyAndItsImpulsesRepel) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 30; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    Scene scene = scenes::random_scene(random, 4, 8);
    const State before = scene.state;
    const ImpactReport report = resolve(scene, {.law = ImpactLaw::kSequentialRepeated});
    EXPECT_GE(report.impulses.minCoeff(), 0.0);
    EXPECT_LE(report.relative_energy_gain(), 1e-12);
    if (lcp::is_solved(report.status)) {
      EXPECT_GE(report.d_dot_after.minCoeff(), -2e-12 * report.d_dot_before.cwiseAbs().maxCoeff());
    } else {
      EXPECT_EQ(report.status, lcp::Status::kIterationLimit);
      EXPECT_TRUE(same(before, scene.state));
    }
  }
}

// ---- bad input

/// The message of the std::invalid_argument that this input ends in; state and report unchanged.
std::string refusal(Scene scene, const ImpactSettings& settings = {}) {
  const Scene before = scene;
  ImpactReport report;
  report.detail = "untouched";
  try {
    resolve_impact(scene.bodies, scene.contacts, settings, scene.state, report);
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(report.detail, "untouched");
    EXPECT_EQ(report.status, lcp::Status::kNotRun);
    for (std::size_t k = 0; k < before.state.size(); ++k) {
      EXPECT_TRUE(scene.state[k].p == before.state[k].p || !before.state[k].p.allFinite());
    }
    return error.what();
  }
  return "not refused";
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << text << "\" lacks \"" << part << "\"";
}

TEST(ImpactInput, BadSettingsAreNamedWithValueAndBound) {
  const Scene scene = scenes::wedge(1.0, 1.0);
  ImpactSettings settings;
  settings.colliding_threshold = -1.0;
  expect_contains(refusal(scene, settings), "colliding_threshold: must be finite and >= 0");
  settings.colliding_threshold = kNaN;
  expect_contains(refusal(scene, settings), "got nan");
  settings = {};
  settings.max_passes = 0;
  expect_contains(refusal(scene, settings), "max_passes: must be >= 1, got 0");
  settings = {};
  settings.order = {0};
  expect_contains(refusal(scene, settings), "order: must be empty or have one entry a contact (2)");
  settings.order = {0, 0};
  expect_contains(refusal(scene, settings), "got 0 a second time");
  settings.order = {0, 2};
  expect_contains(refusal(scene, settings), "got 2");
  settings = {};
  settings.lcp.tolerance = 0.0;
  expect_contains(refusal(scene, settings), "tolerance: must be in (0, 1)");
  settings = {};
  settings.solver = "oracle";
  expect_contains(refusal(scene, settings), "oracle");
  settings = {};
  settings.law = static_cast<ImpactLaw>(9);
  expect_contains(refusal(scene, settings), "law");
}

TEST(ImpactInput, BadBodiesStatesAndContactsAreNamed) {
  const Scene good = scenes::wedge(1.0, 1.0);
  Scene scene = good;
  scene.bodies[0].mass = -1.0;
  expect_contains(refusal(scene), "mass");
  scene = good;
  scene.bodies[0].inertia.diagonal() = Vec3(1, 1, 3);
  expect_contains(refusal(scene), "triangle");
  scene = good;
  scene.state[0].p.y() = kNaN;
  expect_contains(refusal(scene), "p: must be finite");
  scene = good;
  scene.contacts[1].normal.setZero();
  expect_contains(refusal(scene), "contact 1: normal");
  scene = good;
  scene.contacts[1].body_b = 7;
  expect_contains(refusal(scene), "contact 1: body_b");
  scene = good;
  scene.contacts[0].material.restitution = 1.5;
  expect_contains(refusal(scene), "restitution");
  scene = good;
  scene.bodies[0].kind = BodyKind::kKinematic;
  expect_contains(refusal(scene), "at least one must be dynamic");
}

TEST(ImpactLaws, EveryLawHasAName) {
  for (const ImpactLaw law :
       {ImpactLaw::kSequentialOnce, ImpactLaw::kSequentialRepeated, ImpactLaw::kNewton,
        ImpactLaw::kNotes, ImpactLaw::kPoisson, ImpactLaw::kReflections}) {
    EXPECT_NE(to_string(law), to_string(static_cast<ImpactLaw>(9)));
  }
}

}  // namespace
}  // namespace signorini
