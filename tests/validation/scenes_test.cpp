#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/embedded_scenes.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/sdf_reader.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <sstream>

namespace signorini::validation {
namespace {

Scene builtin(const std::string& name) {
  return load_builtin_scene(*find_builtin_scene(name));
}

RunOptions ours_only() {
  RunOptions options;
  options.bullet = false;
  return options;
}

SceneReport checked(const std::string& name, const Scene& scene) {
  SceneReport report;
  find_builtin_scene(name)->check(scene, ours_only(), report);
  return report;
}

const Check* find_check(const SceneReport& report, const std::string& words) {
  for (const Check& check : report.checks) {
    if (check.name.find(words) != std::string::npos) return &check;
  }
  return nullptr;
}

TEST(Checks, JudgeWhatTheySay) {
  const CheckText text{.name = "x"};
  EXPECT_EQ(absolute(text, 1.0, 1.5, 0.5).judged(), Verdict::kPass);
  EXPECT_EQ(absolute(text, 1.0, 1.5, 0.4).judged(), Verdict::kFail);
  EXPECT_EQ(relative(text, 90.0, 100.0, 0.1).judged(), Verdict::kPass);
  EXPECT_EQ(relative(text, 89.0, 100.0, 0.1).judged(), Verdict::kFail);
  EXPECT_EQ(at_most(text, -5.0, 0.0).judged(), Verdict::kPass);
  EXPECT_EQ(at_most(text, 0.1, 0.0).judged(), Verdict::kFail);
  EXPECT_EQ(shown(text, 1.0, 2.0).judged(), Verdict::kInformation);
}

TEST(Checks, NaNFails) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CheckText text{.name = "x"};
  EXPECT_EQ(absolute(text, nan, 0.0, 1.0).judged(), Verdict::kFail);
  EXPECT_EQ(relative(text, nan, 1.0, 1.0).judged(), Verdict::kFail);
  EXPECT_EQ(at_most(text, nan, 1.0).judged(), Verdict::kFail);
}

TEST(BuiltinScenes, EveryFileHasChecksAndEveryCheckHasAFile) {
  EXPECT_EQ(embedded_scenes().size(), builtin_scenes().size());
  for (const EmbeddedScene& file : embedded_scenes()) {
    EXPECT_NE(find_builtin_scene(file.name), nullptr) << file.name;
  }
  for (const BuiltinScene& scene : builtin_scenes()) {
    const Scene loaded = load_builtin_scene(scene);
    EXPECT_FALSE(loaded.title.empty()) << scene.name;
    EXPECT_FALSE(loaded.description.empty()) << scene.name;
    EXPECT_FALSE(loaded.bodies.empty()) << scene.name;
  }
  EXPECT_EQ(find_builtin_scene("no-such-scene"), nullptr);
}

// The harness must be able to fail: each scene below is wrong in one way that its closed form does
// not know of.

TEST(HarnessCanFail, SlopeWithLessGravityThanTheClosedForm) {
  Scene scene = builtin("slope-slide");
  EXPECT_EQ(checked("slope-slide", scene).verdict(), Verdict::kPass);
  scene.bodies[0].gravity_scale = 0.95;
  EXPECT_EQ(checked("slope-slide", scene).verdict(), Verdict::kFail);
}

TEST(HarnessCanFail, StackThatIsPushed) {
  Scene scene = builtin("stack-of-5");
  scene.duration = 0.5;
  set_velocity(scene.bodies[4], {Vec3(0.5, 0.0, 0.0), Vec3::Zero()}, scene.state[4]);
  const SceneReport report = checked("stack-of-5", scene);
  EXPECT_EQ(report.verdict(), Verdict::kFail);
  EXPECT_EQ(find_check(report, "greatest motion")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, RollingWithMoreFrictionThanTheClosedForm) {
  // The closed form knows the friction of the first two colliders; a third one is rougher.
  Scene scene = builtin("slipping-capsule");
  collision::Collider rough = scene.colliders[1];
  rough.material.friction = 1.0;
  scene.colliders[0].material.friction = 1.0;
  scene.colliders.push_back(rough);
  const SceneReport report = checked("slipping-capsule", scene);
  EXPECT_EQ(find_check(report, "speed at the end")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, GravityHalfAPercentOff) {
  Scene cylinder = builtin("rolling-cylinder");
  cylinder.bodies[0].gravity_scale = 1.005;
  const SceneReport rolled = checked("rolling-cylinder", cylinder);
  for (const char* name : {"speed at the end", "spin at the end", "distance at the end"}) {
    EXPECT_EQ(find_check(rolled, name)->judged(), Verdict::kFail) << name;
  }
  Scene pendulum = builtin("pendulum");
  pendulum.bodies[pendulum.body("pendulum")].gravity_scale = 1.005;
  EXPECT_EQ(find_check(checked("pendulum", pendulum), "period")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, BlocksThatTurn) {
  Scene scene = builtin("sliding-headings");
  const Vec3 v = velocity(scene.bodies[2], scene.state[2]).linear;
  set_velocity(scene.bodies[2], {v, Vec3(0.0, 0.0, 3.0)}, scene.state[2]);
  const SceneReport report = checked("sliding-headings", scene);
  EXPECT_EQ(find_check(report, "exact cone: greatest drift")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, ShapeThatLandsOnItsRim) {
  Scene scene = builtin("landing-shapes");
  const int body = scene.body("cylinder-upright");
  scene.state[body].q = scene.state[body].q * Quat(Eigen::AngleAxisd(0.05, Vec3::UnitX()));
  const SceneReport report = checked("landing-shapes", scene);
  EXPECT_EQ(find_check(report, "greatest turn")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, CubeThatSlipsOffItsEdge) {
  Scene scene = builtin("box-on-an-edge");
  scene.colliders[0].material.friction = 0.0;
  const SceneReport report = checked("box-on-an-edge", scene);
  EXPECT_EQ(report.verdict(), Verdict::kFail);
}

TEST(HarnessCanFail, DominoThatFallsOutOfTurn) {
  Scene scene = builtin("dominoes");
  scene.duration = 0.3;
  set_velocity(scene.bodies[3], {Vec3(0.6, 0.0, -0.05), Vec3(0.0, 2.0, 0.0)}, scene.state[3]);
  const SceneReport report = checked("dominoes", scene);
  EXPECT_EQ(find_check(report, "before the one before")->judged(), Verdict::kFail);
  EXPECT_EQ(find_check(report, "still standing")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, BlockThatIsTouchedTurnsOverAtOtherTimes) {
  // A plane below the block, which the closed form does not know of.
  Scene scene = builtin("dzhanibekov");
  scene.duration = 12.0;
  scene.gravity = Vec3(0.0, 0.0, -9.81);
  Body ground;
  ground.kind = BodyKind::kFixed;
  scene.bodies.push_back(ground);
  scene.state.emplace_back();
  scene.state.back().x.z() = -1.0;
  collision::Collider plane;
  plane.body = 1;
  plane.shape = collision::HalfSpace{};
  scene.colliders.push_back(plane);
  EXPECT_EQ(find_check(checked("dzhanibekov", scene), "times it turned over")->judged(),
            Verdict::kFail);
}

TEST(HarnessCanFail, GearsThatAreNotPressedOnEachOther) {
  Scene scene = builtin("gears-of-friction");
  scene.bodies[scene.body("driven::carriage")].gravity_scale = 0.0;
  EXPECT_EQ(find_check(checked("gears-of-friction", scene), "wheel's spin")->judged(),
            Verdict::kFail);
}

TEST(HarnessCanFail, RodThatDoesNotJam) {
  Scene scene = builtin("painleve-rod");
  scene.duration = 0.05;
  for (collision::Collider& collider : scene.colliders) collider.material.friction = 1.2;
  const SceneReport report = checked("painleve-rod", scene);
  EXPECT_EQ(find_check(report, "energy after the jam")->judged(), Verdict::kFail);
  EXPECT_EQ(find_check(report, "way of the foot")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, WreckingBallOnALongerRod) {
  Scene scene = builtin("wrecking-ball");
  scene.gravity *= 1.02;
  scene.bodies[scene.body("crane")].gravity_scale = 0.98 / 1.02;
  const SceneReport report = checked("wrecking-ball", scene);
  EXPECT_EQ(find_check(report, "time of the blow")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, MasonryWhoseFrictionIsNotThatOfLimitAnalysis) {
  Scene scene = builtin("arch-of-15-stones");
  scene.duration = 0.1;
  for (collision::Collider& collider : scene.colliders) collider.material.friction *= 1.01;
  const SceneReport report = checked("arch-of-15-stones", scene);
  const Check* check = find_check(report, "over mu_c");
  if (check == nullptr) GTEST_SKIP() << "built without Clp";
  EXPECT_EQ(check->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, ArchThatStandsWhereItMustFall) {
  Scene scene = builtin("arch-falls");
  for (collision::Collider& collider : scene.colliders) collider.material.friction = 0.5;
  EXPECT_EQ(find_check(checked("arch-falls", scene), "lacks of 1 cm")->judged(), Verdict::kFail);
}

TEST(Stepper, EventDrivenRunsTellTheirEventsAndTheDialStepsInTime) {
  Scene scene = builtin("painleve-rod");
  scene.duration = 0.05;
  EXPECT_EQ(scene.stepper, Stepper::kEvents);
  SceneReport by_events;
  const Runs runs = run_engines(scene, ours_only(), by_events);
  ASSERT_FALSE(runs.signorini->events.empty());
  EXPECT_EQ(runs.signorini->events.front().kind, EventKind::kImpactWithoutCollision);
  ASSERT_FALSE(by_events.tables.empty());
  EXPECT_EQ(by_events.tables.front().rows.front()[1], "impact without collision");
  RunOptions options = ours_only();
  options.accuracy = Accuracy::named("reference");
  SceneReport by_steps;
  EXPECT_TRUE(run_engines(scene, options, by_steps).signorini->events.empty());
  options.stepper = Stepper::kEvents;
  EXPECT_FALSE(run_engines(scene, options, by_steps).signorini->events.empty());
}

TEST(HarnessCanFail, LandingOnAnEdge) {
  Scene scene = builtin("box-landing-flat");
  scene.state[0].q = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitY()));
  const SceneReport report = checked("box-landing-flat", scene);
  EXPECT_EQ(find_check(report, "stepped: greatest |w|")->judged(), Verdict::kFail);
}

TEST(HarnessCanFail, StepWithoutASolutionIsAFailedCheck) {
  Scene scene = builtin("ball-between-walls");
  const SceneReport report = validate_scene(scene, ours_only());
  EXPECT_EQ(report.verdict(), Verdict::kFail);
  EXPECT_EQ(find_check(report, "not solved")->judged(), Verdict::kFail);
}

TEST(GenericChecks, FreeFallIsExactWhereNothingIsInTheWay) {
  Scene scene = builtin("free-flight");
  const SceneReport report = validate_scene(scene, ours_only());
  EXPECT_EQ(report.verdict(), Verdict::kPass);
  ASSERT_NE(find_check(report, "free fall"), nullptr);
}

TEST(GenericChecks, EnergyThatRisesFails) {
  const Scene scene = builtin("free-flight");
  Runs runs;
  runs.signorini = run_signorini(scene, step_settings(scene));
  SceneReport honest;
  add_energy_check(scene, runs, honest);
  EXPECT_EQ(honest.verdict(), Verdict::kPass);
  runs.signorini->kinetic.back() *= 1.05;
  SceneReport tampered;
  add_energy_check(scene, runs, tampered);
  EXPECT_EQ(tampered.verdict(), Verdict::kFail);
}

TEST(GenericChecks, EnergyBoundsAreSmallAgainstTheEnergy) {
  for (const char* name : {"rolling-cylinder", "rolling-capsule", "pendulum", "dzhanibekov"}) {
    const Scene scene = builtin(name);
    Runs runs;
    runs.signorini = run_signorini(scene, step_settings(scene));
    SceneReport report;
    add_energy_check(scene, runs, report);
    const std::vector<double>& kinetic = runs.signorini->kinetic;
    EXPECT_LT(find_check(report, "energy above")->tolerance,
              0.2 * *std::max_element(kinetic.begin(), kinetic.end()))
        << name;
  }
}

/// What the energy check allows for the solver's tolerance goes with the tolerance.
TEST(GenericChecks, EnergyOfARestingBoxRisesByTheTolerance) {
  const Scene scene = builtin("slope-stick");
  const auto rise = [](const Track& track) {
    double most = track.energy(0);
    for (std::size_t k = 0; k < track.size(); ++k) most = std::max(most, track.energy(k));
    return most - track.energy(0);
  };
  TimeStepSettings settings = step_settings(scene);
  settings.lcp.tolerance = 1e-12;
  const Track tight = run_signorini(scene, settings);
  EXPECT_LE(rise(tight), scheme_energy_rise(scene, tight));
  EXPECT_EQ(tight.projection_energy, 0.0);
  // The contacts bear the weight all the time.
  const double weight = scene.bodies[0].mass * scene.gravity.norm();
  EXPECT_GE(tight.impulse, 0.999 * weight * scene.duration);
  EXPECT_LE(tight.impulse, 1.5 * weight * scene.duration);
  const Track loose = run_signorini(scene, step_settings(scene));
  EXPECT_GT(rise(loose), 10.0 * rise(tight));
}

TEST(GenericChecks, OverlapDeeperThanAStepFails) {
  const Scene scene = builtin("ball-drop-e0.5");
  Runs runs;
  runs.signorini = run_signorini(scene, step_settings(scene));
  SceneReport honest;
  add_overlap_check(scene, runs, honest);
  EXPECT_EQ(honest.verdict(), Verdict::kPass);
  runs.signorini->overlap.back() = 0.1;
  SceneReport tampered;
  add_overlap_check(scene, runs, tampered);
  EXPECT_EQ(tampered.verdict(), Verdict::kFail);
}

TEST(Runs, StopFlagLeavesNoReport) {
  const StopFlag stop{true};
  RunOptions options;
  options.stop = &stop;
  EXPECT_THROW((void)validate_builtin(*find_builtin_scene("free-flight"), options), RunInterrupted);
}

TEST(Runs, EngineAndDurationAreTheCallers) {
  RunOptions options;
  options.signorini = false;
  options.duration = 0.5;
  const SceneReport report = validate_builtin(*find_builtin_scene("free-flight"), options);
  EXPECT_EQ(report.signorini_seconds, -1.0);
  EXPECT_GE(report.bullet_seconds, 0.0);
  for (const Check& check : report.checks) EXPECT_EQ(check.engine, "bullet") << check.name;
  EXPECT_EQ(report.verdict(), Verdict::kInformation);
}

/// Every file of the shared scenes, a few steps in both engines: every step solved, every number
/// finite. Of the world of 3000 models the first 120.
class SharedFiles : public testing::TestWithParam<const char*> {};

Scene first_models(const std::string& file, int count) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  std::string world = text.str();
  std::size_t end = 0;
  for (int i = 0; i < count; ++i) end = world.find("</model>", end) + 8;
  return read_scene_text(world.substr(0, end) + "</world></sdf>", file);
}

TEST_P(SharedFiles, RunInBothEngines) {
  const std::string file = std::string(SIGNORINI_SHARED_DIR) + "/data/scenes/" + GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "../shared is absent";
  const bool large = std::string(GetParam()).find("3k") != std::string::npos;
  Scene scene = large ? first_models(file, 120) : read_scene_file(file, {.ground = -1.0});
  EXPECT_GE(scene.bodies.size(), 2u);
  RunOptions options;
  options.duration = 5.0 * scene.step;
  const SceneReport report = validate_scene(scene, options);
  EXPECT_EQ(report.verdict(), Verdict::kPass);
  for (const Check& check : report.checks) {
    EXPECT_NE(check.judged(), Verdict::kFail) << check.name << ": " << check.value;
  }
  EXPECT_GE(report.signorini_seconds, 0.0);
  EXPECT_GE(report.bullet_seconds, 0.0);
  ASSERT_TRUE(report.playback.has_value());
  EXPECT_EQ(report.playback->tracks.size(), 2u);
  EXPECT_EQ(report.playback->bodies.size(), scene.bodies.size());
}

INSTANTIATE_TEST_SUITE_P(
    All, SharedFiles,
    testing::Values("bullet_block.urdf", "bullet_capsule.urdf", "bullet_cube_small.urdf",
                    "bullet_sphere_with_restitution.urdf", "bullet_two_cubes.sdf",
                    "gz-physics_contact.sdf", "gz-physics_falling.world",
                    "gz-physics_multiple_collisions.sdf", "gz-physics_shapes.world",
                    "gz-physics_slip_compliance.sdf", "gz-sim_3k_shapes.sdf", "gz-sim_falling.sdf",
                    "gz-sim_friction.sdf", "gz-sim_rolling_shapes.sdf", "gz-sim_shapes.sdf"),
    [](const auto& scene) {
      std::string name = scene.param;
      for (char& c : name) c = std::isalnum(c) ? c : '_';
      return name;
    });

TEST(BuiltinScenes, ErrorsThatScenesNameAreChecksOfBothEngines) {
  int named = 0;
  for (const char* name :
       {"free-flight", "ball-drop-e0", "ball-drop-e0.5", "wedge", "newtons-cradle",
        "rod-on-two-supports", "box-landing-flat", "rolling-sphere", "box-on-an-edge",
        "painleve-rod", "gears-of-friction", "arch-of-15-stones"}) {
    const BuiltinScene& scene = *find_builtin_scene(name);
    const std::string error = load_builtin_scene(scene).error;
    ASSERT_FALSE(error.empty()) << name;
    RunOptions options;
    options.studies = false;
    const SceneReport report = validate_builtin(scene, options);
    for (const char* engine : {"signorini", "bullet"}) {
      named += std::any_of(report.checks.begin(), report.checks.end(), [&](const Check& check) {
        return check.name == error && check.engine == engine;
      });
    }
  }
  EXPECT_EQ(named, 2 * 12);
}

TEST(Trade, EveryWayHasAnErrorAndTheQuarterStepErrsLess) {
  RunOptions options;
  options.studies = false;
  options.trade = true;
  const SceneReport report = validate_builtin(*find_builtin_scene("free-flight"), options);
  ASSERT_TRUE(report.trade.has_value());
  const std::vector<TradePoint>& points = report.trade->points;
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(report.trade->unit, "m");
  for (const TradePoint& point : points) EXPECT_GE(point.whole_seconds, 0.0) << point.solver;
  // First order: g t h/2.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(points[i].error / points[i + 3].error, 4.0, 1e-6);
}

TEST(Trade, WhatAShortRunDoesNotReachIsANotice) {
  RunOptions options;
  options.trade = true;
  options.bullet = false;
  options.studies = false;
  options.duration = 0.1;  // before the first bounce
  const SceneReport report = validate_builtin(*find_builtin_scene("ball-drop-e0.5"), options);
  EXPECT_FALSE(report.trade.has_value());
  ASSERT_FALSE(report.notices.empty());
  EXPECT_NE(report.notices.back().find("apex 1 above the plane"), std::string::npos);
}

/// The quick built-in scenes, whole: what the default report must show.
class QuickScenes : public testing::TestWithParam<const char*> {};

TEST_P(QuickScenes, Pass) {
  const SceneReport report = validate_builtin(*find_builtin_scene(GetParam()), ours_only());
  for (const Check& check : report.checks) {
    EXPECT_NE(check.judged(), Verdict::kFail)
        << check.name << ": " << check.value << " for " << check.expected << ", error "
        << check.error << " > " << check.tolerance;
  }
  EXPECT_EQ(report.verdict(), Verdict::kPass);
}

INSTANTIATE_TEST_SUITE_P(
    BuiltIn, QuickScenes,
    testing::Values("free-flight", "ball-drop-e0", "ball-drop-e0.5", "ball-drop-e0.9",
                    "ball-drop-e1", "wedge", "newtons-cradle", "pendulum", "load-on-a-chain",
                    "ball-between-walls", "ball-between-tilted-walls", "rod-on-two-supports",
                    "rolling-sphere", "rolling-cylinder", "slipping-capsule", "sliding-headings",
                    "landing-shapes", "box-on-an-edge", "dzhanibekov", "card-house", "elastic-666",
                    "rolling-capsule", "thrown-cylinder", "slope-stick-by-a-hair",
                    "slope-slide-by-a-hair", "triangle-landing-flat", "mass-ratio-million",
                    "arch-of-15-stones", "gears-of-friction", "wrecking-ball", "painleve-rod",
                    "bullet-vehicle", "bullet-ragdoll"),
    [](const auto& scene) {
      std::string name = scene.param;
      for (char& c : name) c = std::isalnum(c) ? c : '_';
      return name;
    });

}  // namespace
}  // namespace signorini::validation
