#include <signorini/core/response/time_stepper.h>

#include "plane_contacts.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

using testing_tools::at;
using testing_tools::ball_body;
using testing_tools::box_body;
using testing_tools::fixed_body;
using testing_tools::PlaneContacts;
using testing_tools::TestBall;
using testing_tools::TestBox;

constexpr double kG = 9.81;
constexpr double kDegree = std::numbers::pi / 180.0;

class Model : public testing::TestWithParam<FrictionModel> {};

INSTANTIATE_TEST_SUITE_P(All, Model,
                         testing::Values(FrictionModel::kPyramid, FrictionModel::kCone,
                                         FrictionModel::kBox),
                         [](const auto& tested) { return std::string(to_string(tested.param)); });

/// A brick on a slope.
struct Slope {
  Vec3 half = Vec3(0.5, 0.4, 0.1);
  Quat tilt;
  Vec3 normal, down;  // unit
  PlaneContacts finder;
  Bodies bodies;
  State state;

  Slope(double angle, double friction, double heading)
      : tilt(Quat(Eigen::AngleAxisd(heading, Vec3::UnitZ())) *
             Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()))),
        normal(tilt * Vec3::UnitZ()),
        down(tilt * Vec3::UnitX()),
        finder(normal, {{TestBox{half}, {friction, 0.0}}}),
        bodies{fixed_body(), box_body(2.0, half)},
        state{at(Vec3::Zero()), at(half.z() * normal)} {
    state[1].q = tilt;
  }
};

void step(TimeStepper& stepper, State& state, StepReport& report) {
  stepper.step(state, report);
  ASSERT_TRUE(lcp::is_solved(report.status)) << lcp::to_string(report.status);
}

TEST_P(Model, BelowTheFrictionAngleNothingCreepsIn60Seconds) {
  for (const double heading : {0.0, 0.7}) {
    Slope slope(std::atan(0.98 * 0.5), 0.5, heading);
    TimeStepper stepper(
        slope.bodies, slope.finder,
        {.step = 1.0 / 60.0, .friction_model = GetParam(), .lcp = {.tolerance = 1e-12}});
    const State start = slope.state;
    StepReport report;
    for (int i = 0; i < 3600; ++i) {
      step(stepper, slope.state, report);
    }
    const Vec3 moved = slope.state[1].x - start[1].x;
    EXPECT_LE((moved - moved.dot(slope.normal) * slope.normal).norm(), 1e-12);
    EXPECT_LE(std::abs(moved.dot(slope.normal)), 1e-9);
  }
}

TEST_P(Model, ARollingBallForgetsItsSlipAfterTwoSeventhsOfV0OverMuG) {
  const double mu = 0.2;
  const double v0 = 7.0;
  const double h = 1.0 / 2400.0;
  const double radius = 0.5;
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{radius}, {mu, 0.0}}});
  TimeStepper stepper({fixed_body(), ball_body(2.0, radius)}, finder,
                      {.step = h, .friction_model = GetParam()});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, radius))};
  const Vec3 heading(0.6, 0.8, 0.0);
  state[1].p = 2.0 * v0 * heading;
  const auto slip = [&] {
    const Velocity v = velocity(stepper.bodies()[1], state[1]);
    return v.at(Vec3(0, 0, -radius)).norm();
  };
  StepReport report;
  double before = slip();
  int steps = 0;
  while (slip() > 1e-6 && steps < 4000) {
    before = slip();
    step(stepper, state, report);
    ++steps;
  }
  // The last step needed only a part of its friction: slip falls by 7/2 mu g h a step.
  const double time = h * (steps - 1 + before / (3.5 * mu * kG * h));
  const double expected = 2.0 * v0 / (7.0 * mu * kG);
  EXPECT_NEAR(time, expected, 1e-3 * expected);
  const Vec3 v = state[1].p / 2.0;
  EXPECT_NEAR(v.dot(heading), 5.0 / 7.0 * v0, 1e-6);
  EXPECT_NEAR(v.cross(heading).norm(), 0.0, 1e-6);
}

/// The largest angle between a contact's friction and the opposite of its slip after the step, of a
/// brick that slides at this heading across a slope.
double direction_error(FrictionModel model, double heading) {
  Slope slope(0.3, 0.4, 0.2);
  // It spins too: what one corner's friction does turns the slip of the others away from u*, along
  // which a pyramid has its first side.
  const Vec3 v = 0.1 * (slope.tilt * Vec3(std::cos(heading), std::sin(heading), 0.0));
  slope.state[1].p = 2.0 * v;
  slope.state[1].L = 0.1 * slope.normal;
  TimeStepper stepper(slope.bodies, slope.finder,
                      {.step = 1.0 / 60.0, .friction_model = model, .pyramid_sides = 4});
  StepReport report;
  double worst = 0.0;
  for (int i = 0; i < 3; ++i) {
    const State before = slope.state;
    step(stepper, slope.state, report);
    State after = before;  // positions of the step's start, momenta of its end
    after[1].p = slope.state[1].p;
    after[1].L = slope.state[1].L;
    for (std::size_t c = 0; c < report.contacts.size(); ++c) {
      const Contact& contact = report.contacts[c];
      const Vec3 u = slip_velocity(slope.bodies, after, contact);
      const Vec3 slip = u - u.dot(contact.normal) * contact.normal;
      const Vec3 friction =
          report.impulses[c] - report.normal_impulses[static_cast<lcp::Index>(c)] * contact.normal;
      if (slip.norm() > 1e-4 && friction.norm() > 1e-6) {
        worst = std::max(worst, std::atan2(slip.cross(friction).norm(), -slip.dot(friction)));
      }
    }
  }
  return worst;
}

TEST(FrictionModels, TheConesFrictionOpposesTheSlipAtEveryHeading) {
  double cone = 0.0;
  double pyramid = 0.0;
  for (int degrees = 0; degrees < 360; degrees += 15) {
    cone = std::max(cone, direction_error(FrictionModel::kCone, degrees * kDegree));
    pyramid = std::max(pyramid, direction_error(FrictionModel::kPyramid, degrees * kDegree));
  }
  EXPECT_LT(cone, 0.1 * kDegree);
  EXPECT_GT(pyramid, 1.0 * kDegree);  // the measure can fail
}

TEST_P(Model, ImpulsesStayWithinTheModelsLimit) {
  Slope slope(0.3, 0.4, 0.2);
  slope.state[1].p = Vec3(1.0, 2.0, 0.0);
  slope.state[1].L = Vec3(0.0, 0.0, 0.4);
  TimeStepper stepper(slope.bodies, slope.finder, {.friction_model = GetParam()});
  const double most = GetParam() == FrictionModel::kBox ? std::sqrt(2.0) : 1.0;
  StepReport report;
  for (int i = 0; i < 60; ++i) {
    step(stepper, slope.state, report);
    EXPECT_LE(report.energy_change_impact, 1e-12);
    for (std::size_t c = 0; c < report.contacts.size(); ++c) {
      const double f = report.normal_impulses[static_cast<lcp::Index>(c)];
      const Vec3 friction = report.impulses[c] - f * report.contacts[c].normal;
      EXPECT_GE(f, -1e-12);
      EXPECT_LE(friction.norm(), most * 0.4 * f + 1e-9);
    }
  }
}

TEST_P(Model, WithoutFrictionTheModelsAreOne) {
  Slope slope(0.3, 0.0, 0.2);
  TimeStepper stepper(slope.bodies, slope.finder, {.friction_model = GetParam()});
  StepReport report;
  for (int i = 0; i < 60; ++i) {
    step(stepper, slope.state, report);
  }
  EXPECT_NEAR((slope.state[1].p / 2.0).dot(slope.down), 60 * kG * std::sin(0.3) / 240.0, 1e-9);
}

/// A ball of 2 kg and 0.5 m on a plane.
struct Ball {
  static constexpr double kMass = 2.0;
  static constexpr double kRadius = 0.5;
  PlaneContacts finder;
  Bodies bodies{fixed_body(), ball_body(kMass, kRadius)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, kRadius))};

  explicit Ball(const Material& material)
      : finder(Vec3::UnitZ(), {{TestBall{kRadius}, material}}) {}
  void set(const Vec3& linear, const Vec3& angular) {
    set_velocity(bodies[1], {linear, angular}, state[1]);
  }
  [[nodiscard]] Velocity motion() const { return velocity(bodies[1], state[1]); }
};

TEST_P(Model, ASpinningBallStopsAfterTwoFifthsOfR2WOverMuG) {
  const double mu = 0.01;  // m
  const double h = 1.0 / 240.0;
  Ball ball({.friction = 0.3, .spinning_friction = mu});
  ball.set(Vec3::Zero(), Vec3(0, 0, 3.0));
  TimeStepper stepper(ball.bodies, ball.finder,
                      {.step = h, .friction_model = GetParam(), .lcp = {.tolerance = 1e-12}});
  const double slows = mu * kG / (0.4 * Ball::kRadius * Ball::kRadius);  // rad/s^2
  const double stops = 3.0 / slows;
  StepReport report;
  for (int k = 1; k * h < stops + 0.1; ++k) {
    step(stepper, ball.state, report);
    EXPECT_NEAR(ball.motion().angular.z(), std::max(0.0, 3.0 - slows * k * h), 1e-9);
    if (k == 1) {
      ASSERT_EQ(report.moments.size(), 1U);
      EXPECT_NEAR(report.moments[0].z(), -mu * Ball::kMass * kG * h, 1e-10);
    }
  }
  EXPECT_LT(ball.motion().linear.norm(), 1e-12);
}

TEST_P(Model, ARollingBallIsSlowedByFiveSeventhsOfMuGOverR) {
  const double mu = 0.02;  // m
  const double h = 1.0 / 240.0;
  const Vec3 heading(0.6, 0.8, 0.0);
  Ball ball({.friction = 0.5, .rolling_friction = mu});
  ball.set(2.0 * heading, Vec3::UnitZ().cross(2.0 / Ball::kRadius * heading));
  TimeStepper stepper(ball.bodies, ball.finder,
                      {.step = h, .friction_model = GetParam(), .lcp = {.tolerance = 1e-12}});
  const double slows = 5.0 / 7.0 * mu * kG / Ball::kRadius;
  StepReport report;
  for (int k = 1; k * h < 2.0 / slows + 0.1; ++k) {
    step(stepper, ball.state, report);
    const Vec3 v = ball.motion().linear;
    EXPECT_NEAR(v.dot(heading), std::max(0.0, 2.0 - slows * k * h), 1e-8);
    EXPECT_LT(v.cross(heading).norm(), 1e-8);
    EXPECT_LT(ball.motion().at(Vec3(0, 0, -Ball::kRadius)).norm(), 1e-8);  // rolls
  }
}

TEST_P(Model, ABallRestsOnASlopeThatItsRollingFrictionHolds) {
  for (const bool holds : {true, false}) {
    const double angle = 2.0 * kDegree;
    const double mu = Ball::kRadius * std::tan(angle) * (holds ? 1.02 : 0.5);  // m
    Ball ball({.friction = 0.5, .rolling_friction = mu});
    const double h = 1.0 / 60.0;
    const Vec3 gravity = kG * Vec3(std::sin(angle), 0.0, -std::cos(angle));
    TimeStepper stepper(
        ball.bodies, ball.finder,
        {.step = h, .gravity = gravity, .friction_model = GetParam(), .lcp = {.tolerance = 1e-12}});
    StepReport report;
    for (int k = 0; k < 60; ++k) {
      step(stepper, ball.state, report);
    }
    const double pull = gravity.x() + mu / Ball::kRadius * gravity.z();
    EXPECT_NEAR(ball.motion().linear.x(), holds ? 0.0 : 5.0 / 7.0 * pull * 60 * h, 1e-8);
  }
}

// Rows of rolling friction have coupled limits, which the sweeps that a small budget leaves cannot
// take.
TEST(TurningFriction, ABudgetThatPaysForNothingCertifiesTheStart) {
  for (const double work : {0.0, 0.05, 30.0}) {
    Ball ball({.friction = 0.5, .rolling_friction = 0.02});
    ball.set(Vec3(2.0, 0.0, 0.0), Vec3(0.0, 4.0, 0.0));
    TimeStepSettings settings{.accuracy = Accuracy::engineering()};
    settings.budget.work = work;
    TimeStepper stepper(ball.bodies, ball.finder, settings);
    StepReport report;
    stepper.step(ball.state, report);
    EXPECT_LE(report.work, work);
    if (work < 1.0) {
      EXPECT_EQ(report.status, lcp::Status::kIterationLimit);
      EXPECT_EQ(report.islands.at(0).solver, "none");
      EXPECT_GT(report.islands.at(0).unit_free_residual, 0.0);
      EXPECT_NE(report.result.detail.find("budget used up"), std::string::npos);
    } else {
      EXPECT_TRUE(lcp::is_solved(report.status));
    }
  }
}

/// A brick on the ground, pushed along x, whose friction direction is turned by `turned` from x.
struct Anisotropic {
  static constexpr double kAlong = 0.2;
  static constexpr double kAcross = 0.5;
  double turned;
  Vec3 half = Vec3(0.5, 0.4, 0.1);

  class Finder final : public ContactFinder {
   public:
    Finder(const Vec3& half, const Vec3& direction)
        : plane_(Vec3::UnitZ(),
                 {{TestBox{half}, {.friction = kAlong, .friction_ratio = kAcross / kAlong}}}),
          direction_(direction) {}
    void find(const State& state, double margin, ContactSet& contacts) override {
      plane_.find(state, margin, contacts);
      for (Contact& contact : contacts) {
        contact.friction_direction = direction_;
      }
    }
    std::optional<FirstContact> first_contact(std::span<const Motion* const> motions,
                                              double duration, RestingPairs resting) override {
      return plane_.first_contact(motions, duration, resting);
    }

   private:
    PlaneContacts plane_;
    Vec3 direction_;
  };

  /// The velocity after one step under a push (an acceleration), from rest.
  [[nodiscard]] Vec3 pushed(FrictionModel model, double push, double h) const {
    Finder finder(half, direction());
    Bodies bodies{fixed_body(), box_body(2.0, half)};
    State state{at(Vec3::Zero()), at(Vec3(0, 0, half.z()))};
    TimeStepper stepper(bodies, finder,
                        {.step = h,
                         .gravity = Vec3(push, 0.0, -kG),
                         .friction_model = model,
                         .lcp = {.tolerance = 1e-12}});
    StepReport report;
    step(stepper, state, report);
    return state[1].p / 2.0;
  }
  [[nodiscard]] Vec3 direction() const { return {std::cos(turned), std::sin(turned), 0.0}; }
};

// v = h a - h g (mu_1^2 v_1, mu_2^2 v_2)/|(mu_1 v_1, mu_2 v_2)| along the direction and across it.
TEST(FrictionModels, ABrickPushedAcrossItsDirectionSlidesByTheLawOfTheEllipse) {
  const Anisotropic brick{.turned = 45.0 * kDegree};
  const double h = 1.0 / 60.0;
  const double push = 0.6 * kG;
  const Vec3 v = brick.pushed(FrictionModel::kCone, push, h);
  const Vec3 along = brick.direction();
  const Vec3 across = Vec3::UnitZ().cross(along);
  const Eigen::Vector2d slip(v.dot(along), v.dot(across));
  const Eigen::Vector2d mu(Anisotropic::kAlong, Anisotropic::kAcross);
  const Eigen::Vector2d scaled = mu.cwiseProduct(slip);
  const Eigen::Vector2d force = -kG * mu.cwiseProduct(scaled) / scaled.norm();
  const Eigen::Vector2d pushing = push * Eigen::Vector2d(along.x(), across.x());
  EXPECT_LT((slip - h * (pushing + force)).norm(), 1e-9);
  EXPECT_GT(slip[0], -1.2 * slip[1]);  // it yields where friction is less
  EXPECT_LT(slip[1], 0.0);
}

TEST_P(Model, AnisotropicFrictionHoldsEachWayByItsOwnMu) {
  for (const bool across : {false, true}) {
    const Anisotropic brick{.turned = across ? 90.0 * kDegree : 0.0};
    const double mu = across ? Anisotropic::kAcross : Anisotropic::kAlong;
    const double h = 1.0 / 60.0;
    EXPECT_LT(brick.pushed(GetParam(), 0.98 * mu * kG, h).norm(), 1e-9);
    const Vec3 slides = brick.pushed(GetParam(), 1.5 * mu * kG, h);
    EXPECT_NEAR(slides.x(), 0.5 * mu * kG * h, 1e-8);
    EXPECT_LT(std::abs(slides.y()), 1e-9);
  }
}

TEST(FrictionModels, EveryPositionOfTheDialTakesTurningAndAnisotropicFriction) {
  for (const char* position : {"preview", "game", "engineering", "reference"}) {
    SCOPED_TRACE(position);
    Ball ball({.friction = 0.5,
               .friction_ratio = 0.5,
               .rolling_friction = 0.02,
               .spinning_friction = 0.01});
    ball.set(Vec3(2.0, 0.0, 0.0), Vec3(0.0, 2.0 / Ball::kRadius, 1.0));
    TimeStepper stepper(ball.bodies, ball.finder,
                        {.step = 1.0 / 240.0, .accuracy = Accuracy::named(position)});
    StepReport report;
    step(stepper, ball.state, report);
    EXPECT_EQ(report.rows, 6);
    EXPECT_NE(report.islands.at(0).model.find("cone, box where"), std::string::npos);
    EXPECT_NEAR(report.moments.at(0).z(), -0.01 * Ball::kMass * kG / 240.0, 1e-4);
  }
}

TEST(FrictionModels, AnUnknownModelIsRefused) {
  TimeStepSettings settings;
  settings.friction_model = static_cast<FrictionModel>(7);
  EXPECT_THROW(settings.validate(), std::invalid_argument);
  EXPECT_EQ(to_string(settings.friction_model), "unknown model");
}

}  // namespace
}  // namespace signorini
