#include <signorini/core/model/joint.h>
#include <signorini/core/response/time_stepper.h>

#include "plane_contacts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace signorini {
namespace {

using testing_tools::at;
using testing_tools::ball_body;
using testing_tools::box_body;
using testing_tools::box_inertia;
using testing_tools::fixed_body;
using testing_tools::PlaneContacts;
using testing_tools::TestBall;
using testing_tools::TestBox;

constexpr double kG = 9.81;
constexpr double kPi = std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class NoContacts final : public ContactFinder {
 public:
  void find(const State&, double, ContactSet& contacts) override { contacts.clear(); }
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const>, double,
                                                          RestingPairs) override {
    return std::nullopt;
  }
};

struct Mechanism {
  Bodies bodies;
  State state;
  Joints joints;

  int add(const Body& body, const BodyState& at_start) {
    bodies.push_back(body);
    state.push_back(at_start);
    return static_cast<int>(bodies.size()) - 1;
  }
  Joint& join(JointKind kind, int a, int b, const Vec3& point, const Vec3& axis = Vec3::UnitZ()) {
    joints.push_back(joint_at(kind, a, b, state, point, axis));
    return joints.back();
  }
};

double worst_error(const StepReport& report) {
  double worst = 0.0;
  for (const JointReport& joint : report.joints) {
    worst = std::max({worst, joint.position_error, joint.angle_error});
  }
  return worst;
}

/// Steps, and fails the test where a step is not solved or a joint is off by more than `error`.
void run(TimeStepper& stepper, State& state, int steps,
         const std::function<void(int, const StepReport&)>& look = {}, double error = 1e-9) {
  StepReport report;
  for (int i = 0; i < steps; ++i) {
    stepper.step(state, report);
    ASSERT_TRUE(lcp::is_solved(report.status))
        << "step " << i << ": " << lcp::to_string(report.status) << " " << report.detail;
    ASSERT_TRUE(report.projection_status == lcp::Status::kNotRun ||
                lcp::is_solved(report.projection_status))
        << "step " << i << ": " << report.detail;
    ASSERT_LT(worst_error(report), error) << "step " << i;
    if (look) {
      look(i, report);
    }
  }
}

/// A point mass (almost) or a bar on a pivot at the origin, let go at `angle` from straight down.
Mechanism pendulum(JointKind kind, double length, double angle, const Body& bob) {
  Mechanism scene;
  scene.add(fixed_body(), at(Vec3::Zero()));
  BodyState start = at(length * Vec3(std::sin(angle), 0.0, -std::cos(angle)));
  start.q = Quat(Eigen::AngleAxisd(-angle, Vec3::UnitY()));
  scene.add(bob, start);
  Joint& joint = scene.join(kind, 1, 0, Vec3::Zero(), Vec3::UnitY());
  if (kind == JointKind::kDistance) {
    joint.anchor_a = Vec3::Zero();
    joint.anchor_b = Vec3::Zero();
    joint.limits = {length, length};
  }
  return scene;
}

/// Time of the second passage through the bottom (half a period later than the first), doubled.
double measured_period(const Mechanism& scene, double h) {
  NoContacts finder;
  TimeStepper stepper(scene.bodies, finder, {.step = h}, scene.joints);
  State state = scene.state;
  std::vector<double> passages;
  double before = state[1].x.x();
  for (int i = 1; passages.size() < 2 && i < 100000; ++i) {
    run(stepper, state, 1);
    const double now = state[1].x.x();
    if (now * before < 0.0) {
      passages.push_back((i - now / (now - before)) * h);
    }
    before = now;
  }
  return 2.0 * (passages.at(1) - passages.at(0));
}

TEST(Pendulum, HasThePeriodOfTheClosedFormAtFirstOrder) {
  // Small angle 0.05: T = 2 pi sqrt((J/m + l^2)/(g l)) (1 + angle^2/16).
  const double length = 1.0, angle = 0.05;
  const Vec3 half(0.05, 0.05, 0.5);
  const Body bar = box_body(2.0, half);
  for (const JointKind kind : {JointKind::kHinge, JointKind::kBall, JointKind::kDistance}) {
    SCOPED_TRACE(std::string(to_string(kind)));
    // A distance leaves the bar's own turn free: it swings as a point mass.
    const double turn = kind == JointKind::kDistance ? 0.0 : bar.inertia(1, 1) / bar.mass;
    const double exact = 2.0 * kPi * std::sqrt((turn + length * length) / (kG * length)) *
                         (1.0 + angle * angle / 16.0);
    const Mechanism scene = pendulum(kind, length, angle, bar);
    const double coarse = measured_period(scene, 1.0 / 120.0);
    const double fine = measured_period(scene, 1.0 / 240.0);
    EXPECT_NEAR(fine, exact, 1e-3 * exact);
    EXPECT_LE(std::abs(fine - exact), 0.6 * std::abs(coarse - exact) + 1e-5);
  }
}

TEST(Pendulum, LosesEnergyAtFirstOrderAndGainsNone) {
  // From the side: the loss in a quarter swing halves with h.
  const Mechanism scene = pendulum(JointKind::kBall, 1.0, 1.5, ball_body(3.0, 0.1));
  std::vector<double> loss;
  for (const double h : {1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0}) {
    NoContacts finder;
    TimeStepper stepper(scene.bodies, finder, {.step = h}, scene.joints);
    State state = scene.state;
    const double start = potential_energy(scene.bodies, state, {0.0, 0.0, -kG});
    double now = start;
    run(stepper, state, static_cast<int>(std::lround(1.0 / h)), [&](int, const StepReport& report) {
      now = report.kinetic_energy + report.potential_energy;
      EXPECT_LT(now, start + 3.0 * kG * 0.1 * h * 20.0);
    });
    loss.push_back(start - now);
  }
  EXPECT_GT(loss[2], 0.0);
  EXPECT_NEAR(loss[0] / loss[1], 2.0, 0.2);
  EXPECT_NEAR(loss[1] / loss[2], 2.0, 0.1);
}

TEST(Pendulum, TheJointReportsTheWeightThatItCarries) {
  // At rest straight down, off the centre: the hinge carries m g, and no moment about its anchor.
  const Mechanism scene = pendulum(JointKind::kHinge, 0.7, 0.0, box_body(2.0, {0.1, 0.2, 0.3}));
  const TimeStepSettings settings;
  NoContacts finder;
  TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
  State state = scene.state;
  run(stepper, state, 10, [&](int, const StepReport& report) {
    EXPECT_NEAR((report.joints[0].impulse / settings.step - Vec3(0, 0, 2.0 * kG)).norm(), 0.0,
                1e-6);
    EXPECT_NEAR(report.joints[0].moment.norm(), 0.0, 1e-9);
    EXPECT_EQ(report.joint_rows, 5);
    EXPECT_EQ(report.rows, 5);
    EXPECT_EQ(report.islands.size(), 1u);
    EXPECT_EQ(report.dynamic_bodies_without_rows, 0);
  });
}

TEST(Joints, AFreeMechanismKeepsLinearMomentumToRoundingAndAngularAtFirstOrder) {
  // Two bars joined in the air, spinning about odd axes, a third by a slider: nothing outside.
  Mechanism scene;
  BodyState first = at({0.0, 0.0, 0.0});
  BodyState second = at({1.0, 0.0, 0.0});
  const Body bar = box_body(2.0, {0.5, 0.1, 0.2});
  set_velocity(bar, {{0.3, -0.2, 0.5}, {1.0, 2.0, -3.0}}, first);
  set_velocity(bar, {{-0.3, 0.9, 0.1}, {0.0, -2.0, 4.0}}, second);
  scene.add(bar, first);
  scene.add(bar, second);
  scene.add(box_body(0.5, {0.1, 0.2, 0.3}), at({1.0, 1.0, 0.0}));
  scene.join(JointKind::kBall, 0, 1, {0.5, 0.0, 0.0});
  scene.join(JointKind::kSlider, 2, 1, {1.0, 1.0, 0.0}, {1.0, 1.0, 0.0});
  const auto momenta = [&](const State& state) {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (const BodyState& one : state) {
      sum.head<3>() += one.p;
      sum.tail<3>() += one.L + one.x.cross(one.p);
    }
    return sum;
  };
  // Impulses keep both; the projection moves x with p kept, and x cross p is then of first order.
  std::vector<double> angular;
  for (const double h : {1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0}) {
    NoContacts finder;
    TimeStepper stepper(scene.bodies, finder, {.step = h, .gravity = Vec3::Zero()}, scene.joints);
    State state = scene.state;
    run(stepper, state, static_cast<int>(std::lround(1.0 / h)));
    const auto drift = (momenta(state) - momenta(scene.state)).eval();
    EXPECT_LT(drift.head<3>().norm(), 1e-12);
    angular.push_back(drift.tail<3>().norm());
  }
  EXPECT_LT(angular[0], 2e-3 * momenta(scene.state).tail<3>().norm());
  EXPECT_NEAR(angular[0] / angular[1], 2.0, 0.1);
  EXPECT_NEAR(angular[1] / angular[2], 2.0, 0.1);
}

TEST(Joints, AChainOfTenHoldsAHeavyBodyUpToMassRatio1e6) {
  for (const JointKind kind : {JointKind::kBall, JointKind::kHinge}) {
    for (const double ratio : {1e3, 1e6}) {
      SCOPED_TRACE(std::string(to_string(kind)) + ", ratio " + std::to_string(ratio));
      Mechanism scene;
      scene.add(fixed_body(), at(Vec3::Zero()));
      for (int i = 1; i <= 10; ++i) {
        const double mass = i == 10 ? ratio : 1.0;
        scene.add(box_body(mass, {0.1, 0.05, 0.05}), at({0.2 * i - 0.1, 0.0, 0.0}));
        scene.join(kind, i, i - 1, {0.2 * i - 0.2, 0.0, 0.0}, Vec3::UnitY());
      }
      NoContacts finder;
      TimeStepper stepper(scene.bodies, finder, {.step = 1.0 / 60.0}, scene.joints);
      State state = scene.state;
      int stiffened = 0;
      run(
          stepper, state, 120,
          [&](int, const StepReport& report) {
            stiffened = std::max(stiffened, report.stiffened_bodies);
          },
          1e-6);
      EXPECT_GT(stiffened, 0);
      EXPECT_NEAR(state[10].x.norm(), 1.9, 1e-3);
    }
  }
}

TEST(Joints, ALoadHangsStillOnAChainOfLightLinks) {
  // A sideways push of 1e-3: the load of 1e6 kg swings on, the links stay taut and carry its
  // weight. The plain scheme lets the chain crumple and the load fall: what the stiffness is for.
  for (const bool stiffness : {true, false}) {
    Mechanism scene;
    scene.add(fixed_body(), at(Vec3::Zero()));
    for (int i = 1; i <= 10; ++i) {
      BodyState start = at({1e-4 * i, 0.0, 0.1 - 0.2 * i});
      scene.add(box_body(i == 10 ? 1e6 : 1.0, {0.05, 0.05, 0.1}), start);
      scene.join(JointKind::kBall, i, i - 1, {1e-4 * i, 0.0, 0.2 - 0.2 * i});
    }
    scene.state[10].p.x() = 1e6 * 1e-3;
    NoContacts finder;
    TimeStepSettings settings{.step = 1.0 / 60.0};
    settings.joint_stiffness = stiffness;
    TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
    State state = scene.state;
    StepReport report;
    double error = 0.0;
    for (int i = 0; i < 120; ++i) {
      stepper.step(state, report);
      error = std::max(error, worst_error(report));
    }
    if (stiffness) {
      EXPECT_LT(error, 1e-9);
      EXPECT_NEAR(state[10].x.z(), -1.9, 1e-5);
      EXPECT_NEAR(report.joints[0].impulse.z() * 60.0, (1e6 + 9.0) * kG, 1e-3 * 1e6 * kG);
    } else {
      EXPECT_GT(error, 1e-3);
    }
  }
}

TEST(Joints, AChainOfSixtyOnAPlaneIsSolvedInAConeAndAPyramid) {
  // More rows than the dense solvers are asked for: other solvers of "auto", and the certificate.
  for (const FrictionModel model : {FrictionModel::kCone, FrictionModel::kPyramid}) {
    SCOPED_TRACE(std::string(to_string(model)));
    Mechanism scene;
    scene.add(fixed_body(), at(Vec3::Zero()));
    std::vector<testing_tools::TestBody> shapes;
    for (int i = 1; i <= 60; ++i) {
      scene.add(ball_body(0.1, 0.04), at({0.1 * i, 0.0, 0.0401}));
      shapes.push_back({TestBall{0.04}, {0.4, 0.0}});
      if (i > 1) scene.join(JointKind::kBall, i, i - 1, {0.1 * i - 0.05, 0.0, 0.0401});
    }
    PlaneContacts finder(Vec3::UnitZ(), shapes);
    TimeStepSettings settings;
    settings.friction_model = model;
    TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
    State state = scene.state;
    state[30].p = Vec3(0.0, 0.3, 0.2);
    int most = 0;
    run(stepper, state, 30,
        [&](int, const StepReport& report) { most = std::max(most, report.rows); });
    EXPECT_GT(most, 300);
  }
}

TEST(Joints, ASliderStopsAtItsLimitAndItsMotorHasTheClosedForm) {
  // On a vertical axis with a motor of F = 1.5 m g: rises with (F - m g)/m until it has its speed.
  Mechanism scene;
  scene.add(fixed_body(), at(Vec3::Zero()));
  const double mass = 2.0;
  scene.add(box_body(mass, {0.1, 0.2, 0.3}), at({0.3, 0.0, 0.0}));
  Joint& joint = scene.join(JointKind::kSlider, 1, 0, {0.0, 0.0, 0.0}, Vec3::UnitZ());
  joint.limits = {-0.5, 0.25};
  joint.motor = {0.4, 1.5 * mass * kG};
  const TimeStepSettings settings;
  const double h = settings.step;
  NoContacts finder;
  TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
  State state = scene.state;
  int steps = 0;
  run(stepper, state, 240, [&](int i, const StepReport& report) {
    steps = i + 1;
    const double c = report.joints[0].coordinate;
    EXPECT_LE(c, 0.25 + 1e-9);
    const double speed = state[1].p.z() / mass;
    if (c < 0.25 - 0.41 * h) {
      EXPECT_NEAR(speed, std::min(0.5 * kG * steps * h, 0.4), 1e-9);
      const double force = steps * 0.5 * kG * h < 0.4 ? 1.5 * mass * kG : mass * kG;
      if (std::abs(steps * 0.5 * kG * h - 0.4) > 0.5 * kG * h) {
        EXPECT_NEAR(report.joints[0].motor / h, force, 1e-6);
      }
    }
  });
  EXPECT_NEAR(state[1].x.z(), 0.25, 1e-9);
  // At the upper limit all of the motor pushes, and the limit carries what is too much.
  StepReport report;
  stepper.step(state, report);
  EXPECT_NEAR(report.joints[0].motor / h, 1.5 * mass * kG, 1e-6);
  EXPECT_NEAR(report.joints[0].limit / h, -0.5 * mass * kG, 1e-6);
  // Without a motor it falls freely to the lower limit, and rests there.
  stepper.set_motor(0, {});
  run(stepper, state, 240);
  EXPECT_NEAR(state[1].x.z(), -0.5, 1e-9);
  EXPECT_NEAR(state[1].p.norm(), 0.0, 1e-9);
  stepper.step(state, report);
  EXPECT_NEAR(report.joints[0].limit / h, mass * kG, 1e-6);
}

TEST(Joints, AHingeMotorReachesItsSpeedWithBoundedTorque) {
  // A wheel on its axle: w = min(tau t/J, speed).
  Mechanism scene;
  scene.add(fixed_body(), at(Vec3::Zero()));
  const Body wheel = box_body(2.0, {0.3, 0.3, 0.1});
  scene.add(wheel, at(Vec3::Zero()));
  scene.join(JointKind::kHinge, 1, 0, Vec3::Zero(), Vec3::UnitZ()).motor = {5.0, 0.25};
  const TimeStepSettings settings;
  const double J = wheel.inertia(2, 2);
  NoContacts finder;
  TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
  State state = scene.state;
  run(stepper, state, 1200, [&](int i, const StepReport& report) {
    const double time = (i + 1) * settings.step;
    EXPECT_NEAR(state[1].L.z() / J, std::min(0.25 * time / J, 5.0), 1e-7);
    EXPECT_LE(std::abs(report.joints[0].motor), 0.25 * settings.step * (1.0 + 1e-12));
  });
  EXPECT_NEAR(state[1].L.z() / J, 5.0, 1e-9);
}

TEST(Joints, AHingeStopsAtItsLimits) {
  // A door of which the hinge is vertical, pushed by its own speed against either limit.
  for (const double sign : {1.0, -1.0}) {
    Mechanism scene;
    scene.add(fixed_body(), at(Vec3::Zero()));
    const Body door = box_body(5.0, {0.4, 0.02, 1.0});
    BodyState start = at({0.4, 0.0, 0.0});
    set_velocity(door, {{0.0, 0.4 * sign, 0.0}, {0.0, 0.0, sign}}, start);
    scene.add(door, start);
    scene.join(JointKind::kHinge, 1, 0, Vec3::Zero(), Vec3::UnitZ()).limits = {-0.3, 0.5};
    NoContacts finder;
    TimeStepper stepper(scene.bodies, finder, {}, scene.joints);
    State state = scene.state;
    run(stepper, state, 240);
    EXPECT_NEAR(joint_coordinate(scene.joints[0], state), sign > 0.0 ? 0.5 : -0.3, 1e-9);
    EXPECT_NEAR(state[1].L.norm(), 0.0, 1e-9);
  }
}

TEST(Joints, AFixedJointMakesOneBodyOfTwo) {
  // Two halves of a box fly and tumble as the whole one does, to first order in h.
  const Vec3 half(0.2, 0.3, 0.1);
  const double mass = 3.0;
  const Body part = box_body(mass, half);
  const Body whole = box_body(2.0 * mass, {2.0 * half.x(), half.y(), half.z()});
  const Velocity u{{0.5, 0.0, 2.0}, {0.3, 0.2, 1.5}};
  std::vector<double> error;
  for (const double h : {1.0 / 240.0, 1.0 / 480.0}) {
    Mechanism scene;
    for (const double side : {-1.0, 1.0}) {
      const Vec3 arm(side * half.x(), 0.0, 0.0);
      BodyState start = at(arm);
      set_velocity(part, {u.at(arm), u.angular}, start);
      scene.add(part, start);
    }
    scene.join(JointKind::kFixed, 0, 1, Vec3::Zero());
    State one(1);
    set_velocity(whole, u, one[0]);
    NoContacts finder;
    TimeStepper joined(scene.bodies, finder, {.step = h}, scene.joints);
    TimeStepper alone({whole}, finder, {.step = h});
    State state = scene.state;
    const int steps = static_cast<int>(std::lround(0.5 / h));
    run(joined, state, steps);
    run(alone, one, steps);
    const Vec3 middle = 0.5 * (state[0].x + state[1].x);
    EXPECT_NEAR((middle - one[0].x).norm(), 0.0, 1e-9);
    EXPECT_LT(state[0].q.angularDistance(state[1].q), 1e-9);
    error.push_back(state[0].q.angularDistance(one[0].q));
  }
  EXPECT_LT(error[1], 0.6 * error[0]);
  EXPECT_LT(error[1], 2e-3);
}

TEST(Joints, ARopeHasNoForceUntilItIsTaut) {
  Mechanism scene;
  scene.add(fixed_body(), at(Vec3::Zero()));
  scene.add(ball_body(2.0, 0.1), at({0.0, 0.0, -0.5}));
  Joint& rope = scene.join(JointKind::kDistance, 1, 0, Vec3::Zero());
  rope.limits = {-kInfinity, 1.0};
  NoContacts finder;
  const TimeStepSettings settings;
  TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
  State state = scene.state;
  run(stepper, state, 240, [&](int, const StepReport& report) {
    if (report.joints[0].coordinate < 1.0 - 1e-9) {
      EXPECT_EQ(report.joints[0].impulse.norm(), 0.0);
    }
  });
  EXPECT_NEAR(state[1].x.z(), -1.0, 1e-9);
  StepReport report;
  stepper.step(state, report);
  EXPECT_NEAR(report.joints[0].impulse.z() / settings.step, 2.0 * kG, 1e-6);
  EXPECT_NEAR(report.joints[0].limit / settings.step, -2.0 * kG, 1e-6);
}

TEST(Joints, ClosedLoopsWithMoreRowsThanTheyNeedWork) {
  // A four-bar of hinges: 20 rows, 18 freedoms, one motion. And a door on two hinges.
  Mechanism four;
  four.add(fixed_body(), at(Vec3::Zero()));
  four.add(box_body(1.0, {0.05, 0.05, 0.5}), at({0.0, 0.0, 0.5}));
  four.add(box_body(1.0, {0.6, 0.05, 0.05}), at({0.6, 0.0, 1.0}));
  four.add(box_body(1.0, {0.05, 0.05, 0.5}), at({1.2, 0.0, 0.5}));
  four.join(JointKind::kHinge, 1, 0, {0.0, 0.0, 0.0}, Vec3::UnitY());
  four.join(JointKind::kHinge, 2, 1, {0.0, 0.0, 1.0}, Vec3::UnitY());
  four.join(JointKind::kHinge, 3, 2, {1.2, 0.0, 1.0}, Vec3::UnitY());
  four.join(JointKind::kHinge, 3, 0, {1.2, 0.0, 0.0}, Vec3::UnitY());
  Mechanism door;
  door.add(fixed_body(), at(Vec3::Zero()));
  door.add(box_body(20.0, {0.4, 0.02, 1.0}), at({0.4, 0.0, 0.0}));
  door.join(JointKind::kHinge, 1, 0, {0.0, 0.0, 0.8}, Vec3::UnitZ());
  door.join(JointKind::kHinge, 1, 0, {0.0, 0.0, -0.8}, Vec3::UnitZ());
  for (const Mechanism* scene : {&four, &door}) {
    NoContacts finder;
    TimeStepper stepper(scene->bodies, finder, {}, scene->joints);
    State state = scene->state;
    set_velocity(scene->bodies[1], {Vec3(0.5, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)}, state[1]);
    if (scene == &door) {
      set_velocity(door.bodies[1], {Vec3(0.0, 0.4, 0.0), Vec3(0.0, 0.0, 1.0)}, state[1]);
    }
    run(stepper, state, 240);
  }
}

/// A limb of two bars on a ball joint falls on a plane.
Mechanism limb(double friction, PlaneContacts& finder) {
  const Vec3 half(0.3, 0.06, 0.08);
  Mechanism scene;
  scene.add(fixed_body(), at(Vec3::Zero()));
  BodyState upper = at({0.0, 0.0, 0.6});
  upper.q = Quat(Eigen::AngleAxisd(0.6, Vec3(0.2, 1.0, 0.3).normalized()));
  const Vec3 elbow = upper.pose() * Vec3(0.3, 0.0, 0.0);
  BodyState lower = upper;
  lower.q = Quat(Eigen::AngleAxisd(-0.8, Vec3::UnitZ())) * upper.q;
  lower.x = elbow + lower.q * Vec3(0.3, 0.0, 0.0);
  scene.add(box_body(3.0, half), upper);
  scene.add(box_body(1.5, half), lower);
  scene.join(JointKind::kHinge, 2, 1, elbow, Vec3::UnitZ()).limits = {-1.0, 0.5};
  finder = PlaneContacts(Vec3::UnitZ(),
                         {{TestBox{half}, {friction, 0.0}}, {TestBox{half}, {friction, 0.0}}});
  return scene;
}

TEST(Joints, ALimbFallsOnAPlaneInEveryFrictionModel) {
  for (const FrictionModel model :
       {FrictionModel::kPyramid, FrictionModel::kCone, FrictionModel::kBox}) {
    for (const double friction : {0.0, 0.6}) {
      SCOPED_TRACE(std::string(to_string(model)) + " " + std::to_string(friction));
      PlaneContacts finder(Vec3::UnitZ(), {});
      const Mechanism scene = limb(friction, finder);
      TimeStepSettings settings;
      settings.friction_model = model;
      TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
      State state = scene.state;
      const double start = potential_energy(scene.bodies, state, settings.gravity);
      int most = 0;
      run(stepper, state, 480, [&](int, const StepReport& report) {
        most = std::max(most, static_cast<int>(report.contacts.size()));
        EXPECT_LT(report.kinetic_energy + report.potential_energy, start + 1e-9);
      });
      EXPECT_GE(most, 3);
      if (friction > 0.0) {
        EXPECT_LT(state[1].p.norm() + state[2].p.norm(), 1e-5);
      }
    }
  }
}

TEST(Joints, AJointKeepsItsBodiesFromCollidingUnlessItIsTold) {
  Mechanism scene;
  scene.add(fixed_body(), at(Vec3::Zero()));
  scene.add(ball_body(1.0, 0.1), at({0.0, 0.0, 0.05}));
  for (const bool collide : {false, true}) {
    scene.joints.clear();
    scene.join(JointKind::kSlider, 1, 0, Vec3::Zero(), Vec3::UnitZ()).bodies_collide = collide;
    PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.1}, {}}});
    TimeStepper stepper(scene.bodies, finder, {}, scene.joints);
    State state = scene.state;
    StepReport report;
    stepper.step(state, report);
    EXPECT_EQ(report.contacts.size(), collide ? 1u : 0u);
  }
}

TEST(Joints, AssembledWronglyTheyCloseWithoutKineticEnergy) {
  Mechanism scene = pendulum(JointKind::kHinge, 1.0, 0.3, box_body(2.0, {0.1, 0.1, 0.5}));
  scene.state[1].x += Vec3(0.02, 0.03, -0.01);
  scene.state[1].q = Quat(Eigen::AngleAxisd(0.05, Vec3::UnitX())) * scene.state[1].q;
  NoContacts finder;
  TimeStepper stepper(scene.bodies, finder, {.gravity = Vec3::Zero()}, scene.joints);
  State state = scene.state;
  run(stepper, state, 2,
      [&](int, const StepReport& report) { EXPECT_EQ(report.kinetic_energy, 0.0); });
}

TEST(Joints, ThatCannotCloseSaySo) {
  // A bar on two balls that are farther apart than its anchors.
  for (const auto& [tolerance, said] : {std::pair{1e-4, "m or rad after 20 passes"},
                                        {1e-8, "stalled, overlaps left as pass 1 did"}}) {
    Mechanism scene;
    scene.add(fixed_body(), at(Vec3::Zero()));
    scene.add(box_body(1.0, {0.5, 0.1, 0.1}), at(Vec3::Zero()));
    scene.join(JointKind::kBall, 1, 0, {-0.5, 0.0, 0.0});
    scene.join(JointKind::kBall, 1, 0, {0.5, 0.0, 0.0}).anchor_b.x() += 1e-7;
    NoContacts finder;
    TimeStepSettings settings;
    settings.lcp.tolerance = tolerance;
    TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
    State state = scene.state;
    StepReport report;
    stepper.step(state, report);
    EXPECT_NEAR(worst_error(report), 5e-8, 1e-10);
    EXPECT_NE(report.detail.find(said), std::string::npos) << report.detail;
  }
}

TEST(Joints, OfBodiesAsleepAreLeftAloneWhereOthersAreClosed) {
  // Two pendulums hang and sleep, one of them off by what is tolerated; the other is pushed.
  Mechanism scene = pendulum(JointKind::kHinge, 1.0, 0.0, ball_body(2.0, 0.1));
  scene.add(ball_body(2.0, 0.1), at({0.0, 3.0, -1.0}));
  scene.join(JointKind::kHinge, 2, 0, {0.0, 3.0, 0.0}, Vec3::UnitY());
  scene.joints[0].anchor_b.x() += 0.5 * 1e-10;
  NoContacts finder;
  TimeStepSettings settings;
  settings.sleep.after = 0.05;
  TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
  State state = scene.state;
  run(stepper, state, 30);
  ASSERT_TRUE(stepper.is_asleep(1) && stepper.is_asleep(2));
  const BodyState asleep = state[1];
  state[2].p.x() = 4.0;
  run(stepper, state, 100, [](int, const StepReport& report) {
    EXPECT_NE(report.projection_status, lcp::Status::kNotRun);
    EXPECT_EQ(report.joint_rows, 5);
  });
  EXPECT_FALSE(stepper.is_asleep(2));
  EXPECT_EQ(state[1].x, asleep.x);
  EXPECT_EQ(state[1].q.coeffs(), asleep.q.coeffs());
}

TEST(Joints, AChainThatWakesIsAsStiffAsWhenItFellAsleep) {
  Mechanism scene;
  scene.add(fixed_body(), at(Vec3::Zero()));
  for (int i = 1; i <= 10; ++i) {
    scene.add(box_body(i == 10 ? 1e6 : 1.0, {0.05, 0.05, 0.1}), at({0.0, 0.0, 0.1 - 0.2 * i}));
    scene.join(JointKind::kBall, i, i - 1, {0.0, 0.0, 0.2 - 0.2 * i});
  }
  NoContacts finder;
  TimeStepSettings settings{.step = 1.0 / 60.0};
  settings.sleep.after = 0.1;
  TimeStepper stepper(scene.bodies, finder, settings, scene.joints);
  State state = scene.state;
  run(stepper, state, 10);
  StepReport report;
  stepper.step(state, report);
  ASSERT_EQ(report.bodies_asleep, 10);
  EXPECT_EQ(report.stiffened_bodies, 0);
  EXPECT_EQ(report.rows, 0);
  state[10].p.x() = 1e6 * 1e-3;
  stepper.step(state, report);
  EXPECT_EQ(report.bodies_woken, 10);
  EXPECT_GT(report.stiffened_bodies, 0);
}

TEST(Joints, AnAngleIsTakenAroundTheMiddleOfItsLimits) {
  State state(2);
  Joint joint = joint_at(JointKind::kHinge, 0, 1, state, Vec3::Zero(), Vec3::UnitX());
  for (const double angle : {-3.0, -0.5, 0.0, 1.0, 3.1}) {
    state[0].q = Quat(Eigen::AngleAxisd(angle, Vec3::UnitX()));
    joint.limits = {};
    EXPECT_NEAR(joint_coordinate(joint, state), angle, 1e-14);
    joint.limits = {1.0, 7.0};
    EXPECT_NEAR(joint_coordinate(joint, state), angle + (angle < 4.0 - kPi ? 2.0 * kPi : 0.0),
                1e-14);
    EXPECT_NEAR(joint_error(joint, state).angle.norm(), 0.0, 1e-14);
  }
}

std::string refusal(const Bodies& bodies, const Joint& joint) {
  try {
    validate({joint}, bodies);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Joints, BadInputIsNamed) {
  const Bodies bodies{fixed_body(), ball_body(1.0, 0.1), fixed_body()};
  const State state(3);
  const Joint good = joint_at(JointKind::kHinge, 1, 0, state, Vec3::Zero());
  EXPECT_EQ(refusal(bodies, good), "");
  const auto refused = [&](const std::function<void(Joint&)>& spoil) {
    Joint joint = good;
    joint.name = "knee";
    spoil(joint);
    const std::string text = refusal(bodies, joint);
    EXPECT_EQ(text.rfind("joint 0 ('knee'): ", 0), 0u) << text;
    return text.substr(std::min<std::size_t>(18, text.size()));
  };
  EXPECT_EQ(refused([](Joint& j) { j.axis = Vec3::Zero(); }),
            "axis: must be a unit vector, got the zero vector");
  EXPECT_EQ(refused([](Joint& j) { j.axis.x() = kNaN; }).rfind("axis: must be a unit vector to", 0),
            0u);
  EXPECT_EQ(refused([](Joint& j) {
              j.limits = {1.0, -1.0};
            }),
            "limits: lower <= upper must hold, got lower = 1, upper = -1");
  EXPECT_NE(refused([](Joint& j) { j.limits.lower = kNaN; }), "");
  EXPECT_NE(refused([](Joint& j) { j.limits.upper = 1.0; }), "");
  EXPECT_NE(refused([](Joint& j) { j.limits = {-4.0, 4.0}; }), "");
  EXPECT_NE(refused([](Joint& j) { j.limits = {kInfinity, kInfinity}; }), "");
  EXPECT_EQ(refused([](Joint& j) { j.body_a = 3; }), "body_a: must be in [0, 3), got 3");
  EXPECT_EQ(refused([](Joint& j) { j.body_b = -1; }), "body_b: must be in [0, 3), got -1");
  EXPECT_EQ(refused([](Joint& j) { j.body_b = 1; }), "body_b: must differ from body_a, both are 1");
  EXPECT_EQ(refused([](Joint& j) { j.body_a = 2; }),
            "body_a 2 and body_b 0: at least one must be dynamic");
  EXPECT_NE(refused([](Joint& j) { j.anchor_a.y() = kInfinity; }), "");
  EXPECT_NE(refused([](Joint& j) { j.anchor_b.y() = kNaN; }), "");
  EXPECT_NE(refused([](Joint& j) { j.reference.w() = 2.0; }), "");
  EXPECT_NE(refused([](Joint& j) { j.motor.speed = kNaN; }), "");
  EXPECT_NE(refused([](Joint& j) { j.motor.max_force = -1.0; }), "");
  EXPECT_NE(refused([](Joint& j) { j.motor.max_force = kNaN; }), "");
  EXPECT_NE(refused([](Joint& j) {
              j.limits = {0.0, 1.0};
              j.motor.max_force = kInfinity;
            }),
            "");
  EXPECT_NE(refused([](Joint& j) {
              j.kind = JointKind::kBall;
              j.motor.max_force = 1.0;
            }),
            "");
  EXPECT_NE(refused([](Joint& j) {
              j.kind = JointKind::kFixed;
              j.limits.lower = 0.0;
            }),
            "");
  EXPECT_NE(refused([](Joint& j) {
              j.kind = JointKind::kDistance;
              j.limits.upper = 0.0;
            }),
            "");
  EXPECT_NE(refused([](Joint& j) { j.kind = static_cast<JointKind>(9); }), "");
  EXPECT_THROW((void)joint_at(JointKind::kHinge, 1, 0, state, Vec3::Zero(), Vec3::Zero()),
               std::invalid_argument);
  EXPECT_THROW((void)joint_at(JointKind::kHinge, 5, 0, state, Vec3::Zero()), std::invalid_argument);

  NoContacts finder;
  Joint bad = good;
  bad.body_b = 7;
  EXPECT_THROW(TimeStepper(bodies, finder, {}, {bad}), std::invalid_argument);
  TimeStepper stepper(bodies, finder, {}, {good});
  EXPECT_THROW(stepper.set_motor(1, {}), std::invalid_argument);
  EXPECT_THROW(stepper.set_motor(0, {kNaN, 1.0}), std::invalid_argument);
  EXPECT_EQ(stepper.joints()[0].motor.max_force, 0.0);

  // Anchors of a distance that coincide: refused before anything moves.
  Joint distance = joint_at(JointKind::kDistance, 1, 0, state, Vec3::Zero());
  distance.limits = {0.0, 1.0};
  TimeStepper coinciding(bodies, finder, {}, {distance});
  State same(3);
  StepReport report;
  EXPECT_THROW(coinciding.step(same, report), std::invalid_argument);
  EXPECT_EQ(same[1].p.norm(), 0.0);
}

}  // namespace
}  // namespace signorini
