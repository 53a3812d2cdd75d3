#include <signorini/collision/collision_world.h>
#include <signorini/core/response/time_stepper.h>

#include "bench/extremes_study.h"
#include "bench/impact_scenes.h"
#include "bench/work_precision.h"

#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace signorini::bench {
namespace {

TEST(WorkPrecision, AStackStandsAndIsSolvedAtEveryStep) {
  TimeStepSettings settings;
  settings.friction_model = FrictionModel::kCone;
  settings.solver = "auto";
  std::ostringstream out;
  const WorkPrecisionReport report =
      run_work_precision({}, {stack_scene(12, 1.0 / 60.0, 0.5), heavy_scene(1e6, 1.0 / 60.0, 0.5)},
                         {our_stepper("ours", settings)}, out);
  EXPECT_TRUE(report.passed()) << out.str();
  ASSERT_EQ(report.rows.size(), 2U);
  for (const WorkPrecisionRow& row : report.rows) {
    EXPECT_LT(row.error, 1e-8) << row.scene;
    EXPECT_LT(row.penetration, 1e-9) << row.scene;
  }
  EXPECT_NE(report.to_csv().find("stack of 12"), std::string::npos);
}

TEST(WorkPrecision, EveryPositionOfTheDialSolvesAPyramid) {
  for (const char* position : {"preview", "game", "engineering", "reference"}) {
    TimeStepSettings settings;
    settings.accuracy = Accuracy::named(position);
    std::ostringstream out;
    const WorkPrecisionReport report = run_work_precision({}, {pyramid_scene(10, 1.0 / 60.0, 0.5)},
                                                          {our_stepper(position, settings)}, out);
    EXPECT_TRUE(report.passed()) << out.str();
    EXPECT_LT(report.rows.at(0).error, 1e-8) << position;
  }
}

/// What a step corrects is known to the next one: else that starts from the correction, undoes it,
/// and every second step factors.
TEST(StacksStudy, APyramidAtRestIsSeldomCorrected) {
  const SteppedScene scene = pyramid_scene(4, 1.0 / 60.0, 4.0);
  collision::CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  TimeStepSettings settings;
  settings.step = scene.step;
  settings.gravity = scene.gravity;
  settings.margin = scene.margin;
  settings.accuracy = Accuracy::game();
  TimeStepper stepper(scene.bodies, world, settings);
  State state = scene.state;
  StepReport report;
  int corrected = 0;
  for (int k = 0; k < 240; ++k) {
    stepper.step(state, report);
    ASSERT_TRUE(lcp::is_solved(report.status)) << k;
    corrected += report.result.statistics.factorizations > 0 ? 1 : 0;
  }
  EXPECT_GT(corrected, 1);
  EXPECT_LE(corrected, 24);
}

/// What the contact problems of one second cost, in work units.
double work_of(const SteppedScene& scene, const Accuracy& accuracy) {
  collision::CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  TimeStepSettings settings;
  settings.step = scene.step;
  settings.gravity = scene.gravity;
  settings.margin = scene.margin;
  settings.accuracy = accuracy;
  TimeStepper stepper(scene.bodies, world, settings);
  State state = scene.state;
  StepReport report;
  double work = 0.0;
  for (int k = 0; k < static_cast<int>(1.0 / scene.step); ++k) {
    stepper.step(state, report);
    EXPECT_TRUE(lcp::is_solved(report.status)) << k;
    work += report.work;
  }
  return work;
}

TEST(StacksStudy, ASlabThatSlidesCostsNoMoreWhereLessIsAsked) {
  const SteppedScene scene = slope_scene(1.0, 1.0 / 240.0, 1.0);
  const double engineering = work_of(scene, Accuracy::engineering());
  EXPECT_GT(engineering, 0.0);
  EXPECT_LE(work_of(scene, Accuracy::game()), engineering);
  EXPECT_LE(work_of(scene, Accuracy::preview()), engineering);
}

double drift_of(const SteppedScene& scene) {
  TimeStepSettings settings;
  settings.accuracy = Accuracy::engineering();
  std::ostringstream out;
  WorkPrecisionOptions options;
  options.seconds = 1.0;
  const WorkPrecisionReport report =
      run_work_precision(options, {scene}, {our_stepper("ours", settings)}, out);
  EXPECT_TRUE(report.passed()) << out.str();
  return report.rows.at(0).error;
}

TEST(WorkPrecision, ASlabStaysOrSlidesAndABallRollsAsTheyShould) {
  EXPECT_LT(drift_of(slope_scene(0.45, 1.0 / 60.0, 1.0)), 1e-8);
  EXPECT_LT(drift_of(slope_scene(1.0, 1.0 / 60.0, 1.0)), 1e-7);
  const double coarse = drift_of(rolling_scene(1.0 / 60.0, 1.0));
  const double fine = drift_of(rolling_scene(1.0 / 240.0, 1.0));
  EXPECT_LT(coarse, 0.05);  // m, of 3.8: first order
  EXPECT_LT(fine, 0.5 * coarse);
  SteppedScene elsewhere = slope_scene(1.0, 1.0 / 60.0, 1.0);
  elsewhere.path = {};
  EXPECT_GT(drift_of(elsewhere), 1.0);  // it does slide
}

double error_of(const SteppedScene& scene, const Contestant& contestant) {
  std::ostringstream out;
  const WorkPrecisionReport report = run_work_precision({}, {scene}, {contestant}, out);
  EXPECT_TRUE(report.passed()) << out.str();
  return report.rows.at(0).error;
}

TEST(WorkPrecision, ImpactsComeOutAsTheyShouldOfTheEventDrivenStepper) {
  const Contestant events = our_event_stepper();
  EXPECT_LT(error_of(landing_scene(0.5, 1.0 / 60.0), events), 1e-12);
  EXPECT_LT(error_of(cradle_scene(1.0 / 60.0), events), 1e-9);
  EXPECT_LT(error_of(bounce_scene(0.9, 1.0 / 60.0), events), 1e-6);
  EXPECT_LT(error_of(elastic_balls_scene(3, 1.0 / 60.0), events), 1e-9);
}

TEST(WorkPrecision, ImpactsOfTheTimeStepperAreThoseOfItsLaw) {
  TimeStepSettings settings;
  settings.accuracy = Accuracy::engineering();
  const Contestant ours = our_stepper("ours", settings);
  EXPECT_LT(error_of(landing_scene(0.5, 1.0 / 60.0), ours), 1e-12);
  EXPECT_NEAR(error_of(cradle_scene(1.0 / 60.0), ours), 0.6, 1e-8);  // Newton's: 2/5, not 1
  const double coarse = error_of(bounce_scene(0.9, 1.0 / 60.0), ours);
  EXPECT_GT(coarse, 1e-6);
  EXPECT_LT(coarse, 0.2);
  EXPECT_LT(error_of(bounce_scene(0.9, 1.0 / 480.0), ours), 0.5 * coarse);  // first order
}

TEST(WorkPrecision, AScenesOwnErrorKnowsAWrongRun) {
  const auto course_of = [](const SteppedScene& scene) {
    std::vector<Velocity> velocities(scene.bodies.size());
    return Course(3, Moment{scene.state, velocities});
  };
  const SteppedScene landing = landing_scene(0.0, 1.0 / 60.0);
  Course turning = course_of(landing);
  EXPECT_EQ(landing.error(turning), 0.0);
  turning[1].velocities[1].angular.x() = 0.25;
  EXPECT_EQ(landing.error(turning), 0.25);
  const SteppedScene bounce = bounce_scene(0.5, 1.0 / 60.0);
  EXPECT_EQ(bounce.error(course_of(bounce)), 1.0);  // no apex
  Course parabola = course_of(bounce);
  for (int k = 0; k < 3; ++k) {
    parabola[k].poses[1].x.z() = 0.5 + 0.25 - 0.01 * std::pow(k - 1.25, 2);
  }
  EXPECT_EQ(bounce.error(parabola), 1.0);  // the first apex is right, the others are missing
  const SteppedScene balls = elastic_balls_scene(2, 1.0 / 60.0);
  Course slower = course_of(balls);
  for (Moment& moment : slower) moment.velocities[1].linear.x() = 2.0;
  slower[2].velocities[1].linear.x() = 1.0;
  EXPECT_NEAR(balls.error(slower), 0.75, 1e-15);
}

/// The first and the last value of every axis up to a mass ratio of 1e4, stacks up to 30.
std::vector<ExtremeCell> fast_sample() {
  std::vector<ExtremeCell> all = extreme_cells();
  std::erase_if(all, [](const ExtremeCell& cell) {
    return cell.mass_ratio > 1e4 || (cell.axis == "stack height" && cell.value > 30.0);
  });
  std::vector<ExtremeCell> sample;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::size_t first = i;
    std::size_t last = i;
    while (first > 0 && all[first - 1].axis == all[i].axis) --first;
    while (last + 1 < all.size() && all[last + 1].axis == all[i].axis) ++last;
    if (all[i].value == all[first].value || all[i].value == all[last].value) {
      sample.push_back(all[i]);
    }
  }
  return sample;
}

TEST(ExtremesStudy, TheReferencePositionPassesASample) {
  const std::vector<ExtremeCell> cells = fast_sample();
  std::set<std::string> axes;
  for (const ExtremeCell& cell : cells) {
    axes.insert(cell.axis);
  }
  EXPECT_EQ(axes.size(), 13U);
  std::ostringstream out;
  const ExtremesReport report = run_extremes_study({.cap = 60.0, .contestant = kReferencePosition},
                                                   cells, extreme_contestants(), out);
  EXPECT_TRUE(report.passed()) << out.str();
  EXPECT_EQ(report.rows.size(), cells.size());
  EXPECT_EQ(report.count(kReferencePosition, 1e4).passed, static_cast<int>(cells.size()));
  EXPECT_NE(report.to_csv().find("groove"), std::string::npos);
}

TEST(ExtremesStudy, NoSolverTellsALieAboutTwoCubes) {
  std::vector<ExtremeCell> cells = extreme_cells();
  std::erase_if(cells, [](const ExtremeCell& cell) {
    return cell.axis != "mass ratio, heavy on light" || (cell.value != 1.0 && cell.value != 1e4);
  });
  std::ostringstream out;
  const ExtremesReport report =
      run_extremes_study({.cap = 60.0}, cells, extreme_contestants(), out);
  for (const ExtremesRow& row : report.rows) {
    EXPECT_FALSE(row.is_ours && is_defect(row.verdict)) << out.str();
    if (row.is_ours && !lcp::is_solved(row.status)) {
      EXPECT_NE(row.verdict, ExtremeVerdict::kPass) << row.contestant;
    }
  }
}

TEST(ExtremesStudy, TheMapDoesNotDependOnTheNumberOfProcesses) {
  std::vector<ExtremeCell> cells = extreme_cells();
  std::erase_if(cells, [](const ExtremeCell& cell) {
    return cell.mass_ratio != 1.0 || !cell.axis.starts_with("time step");
  });
  ASSERT_FALSE(cells.empty());
  const auto map = [&](int processes) {
    std::ostringstream out;
    ExtremesOptions options{.cap = 60.0, .contestant = "dial"};
    options.jobs.processes = processes;
    ExtremesReport report = run_extremes_study(options, cells, extreme_contestants(), out);
    for (ExtremesRow& row : report.rows) row.seconds = 0.0;
    return report.to_csv();
  };
  EXPECT_EQ(map(1), map(3));
}

/// Moves by the closed form, but for what it is told to do wrong.
class FakePlayer final : public ScenePlayer {
 public:
  struct Faults {
    double velocity = 0.0;  ///< m/s too fast
    lcp::Status status = lcp::Status::kSolved;
    bool throws = false;
    bool hangs = false;
  };
  FakePlayer(const ExtremeScene& extreme, const Faults& faults)
      : extreme_(extreme), faults_(faults) {}

  void step() override {
    ++k_;
    if (faults_.throws) {
      throw std::runtime_error("no");
    }
    while (faults_.hangs) {
      hung_ = hung_ + 1;
    }
  }
  [[nodiscard]] State poses() const override {
    State state = extreme_.scene.state;
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (extreme_.scene.bodies[i].is_dynamic()) {
        state[i].x += extreme_.motion(k_).shift;
      }
    }
    return state;
  }
  [[nodiscard]] std::vector<Velocity> velocities() const override {
    Velocity velocity{.linear = extreme_.motion(k_).velocity};
    velocity.linear.y() += faults_.velocity;
    return std::vector<Velocity>(extreme_.scene.bodies.size(), velocity);
  }
  [[nodiscard]] double worst_residual() const override { return 0.0; }
  [[nodiscard]] int unsolved_steps() const override { return 0; }
  [[nodiscard]] lcp::Status status() const override { return faults_.status; }

 private:
  ExtremeScene extreme_;
  Faults faults_;
  int k_ = 0;
  volatile int hung_ = 0;
};

ExtremeVerdict verdict_of(const FakePlayer::Faults& faults) {
  std::vector<ExtremeCell> cells = extreme_cells();
  std::erase_if(cells, [](const ExtremeCell& cell) { return cell.value != 0.001; });
  cells.resize(1);  // sliding at a step of 1 ms: what gravity gives is 0.00981 m/s
  const ExtremeScene extreme = cells.front().make(true);
  const Contestant fake{kReferencePosition, [&](const SteppedScene&) {
                          return std::make_unique<FakePlayer>(extreme, faults);
                        }};
  std::ostringstream out;
  const ExtremesReport report = run_extremes_study({.cap = 0.5}, cells, {{.player = fake}}, out);
  EXPECT_EQ(report.passed(), report.rows.at(0).verdict == ExtremeVerdict::kPass);
  return report.rows.at(0).verdict;
}

TEST(ExtremesStudy, JudgesByErrorAndStatus) {
  EXPECT_EQ(verdict_of({}), ExtremeVerdict::kPass);
  EXPECT_EQ(verdict_of({.velocity = 1e-9}), ExtremeVerdict::kPass);
  EXPECT_EQ(verdict_of({.velocity = 1e-7}), ExtremeVerdict::kDegraded);
  EXPECT_EQ(verdict_of({.velocity = 1e-3}), ExtremeVerdict::kFail);
  EXPECT_EQ(verdict_of({.status = lcp::Status::kSolvedToRounding}), ExtremeVerdict::kPass);
  EXPECT_EQ(verdict_of({.status = lcp::Status::kStalled}), ExtremeVerdict::kDegraded);
  EXPECT_EQ(verdict_of({.velocity = std::numeric_limits<double>::quiet_NaN()}),
            ExtremeVerdict::kNotANumber);
  EXPECT_EQ(verdict_of({.throws = true}), ExtremeVerdict::kCrashed);
  EXPECT_EQ(verdict_of({.hangs = true}), ExtremeVerdict::kTime);
}

}  // namespace
}  // namespace signorini::bench
