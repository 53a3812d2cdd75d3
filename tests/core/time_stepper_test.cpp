#include <signorini/core/response/time_stepper.h>

#include "plane_contacts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace signorini {
namespace {

using testing_tools::at;
using testing_tools::ball_body;
using testing_tools::box_body;
using testing_tools::fixed_body;
using testing_tools::PlaneContacts;
using testing_tools::TestBall;
using testing_tools::TestBody;
using testing_tools::TestBox;

constexpr double kG = 9.81;
constexpr double kH = 1.0 / 240.0;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The contacts that a function gives: for scenes that PlaneContacts cannot make.
class GivenContacts final : public ContactFinder {
 public:
  explicit GivenContacts(std::function<ContactSet(const State&)> contacts)
      : contacts_(std::move(contacts)) {}
  void find(const State& state, double, ContactSet& contacts) override {
    contacts = contacts_(state);
  }
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const>, double,
                                                          RestingPairs) override {
    throw std::logic_error("GivenContacts has no contact times");
  }

 private:
  std::function<ContactSet(const State&)> contacts_;
};

// Steps, and fails the test if a velocity problem was not solved.
void run(TimeStepper& stepper, State& state, int steps,
         const std::function<void(int, const StepReport&)>& look = {}) {
  StepReport report;
  for (int i = 0; i < steps; ++i) {
    stepper.step(state, report);
    ASSERT_TRUE(lcp::is_solved(report.status))
        << "step " << i << ": " << lcp::to_string(report.status) << " " << report.detail;
    if (look) {
      look(i, report);
    }
  }
}

double largest_move(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max({largest, (a[k].x - b[k].x).norm(), a[k].q.angularDistance(b[k].q)});
  }
  return largest;
}

TEST(TimeStepper, ABoxOnAPlaneRestsAndTheImpulsesCarryItsWeight) {
  const Vec3 half(0.5, 0.4, 0.3);
  const double mass = 2.0;
  for (const double e : {0.0, 0.5, 1.0}) {
    SCOPED_TRACE("e = " + std::to_string(e));
    PlaneContacts finder(Vec3::UnitZ(), {{TestBox{half}, {0.5, e}}});
    TimeStepper stepper({fixed_body(), box_body(mass, half)}, finder, {});
    const State start{at(Vec3::Zero()), at(Vec3(0, 0, 0.3))};
    State state = start;
    run(stepper, state, 240, [&](int, const StepReport& report) {
      EXPECT_EQ(report.contacts.size(), 4u);
      EXPECT_NEAR(report.normal_impulses.sum(), mass * kG * kH, 1e-12);
      EXPECT_GE(report.normal_impulses.minCoeff(), 0.0);
    });
    EXPECT_LT(largest_move(state, start), 1e-10);
  }
}

struct Slope {
  double angle;
  double friction;
  Vec3 normal, down;  // unit
  Vec3 half = Vec3(0.5, 0.4, 0.3);
  State start;

  // `heading` turns the slope about the vertical, so that its direction is no axis.
  Slope(double angle_, double friction_, double heading) : angle(angle_), friction(friction_) {
    const Quat tilt = Quat(Eigen::AngleAxisd(heading, Vec3::UnitZ())) *
                      Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
    normal = tilt * Vec3::UnitZ();
    down = tilt * Vec3::UnitX();
    start = {at(Vec3::Zero()), at(half.z() * normal)};
    start[1].q = tilt;
  }
  [[nodiscard]] PlaneContacts finder() const {
    return {normal, {{TestBox{half}, {friction, 0.0}}}};
  }
  [[nodiscard]] Bodies bodies() const { return {fixed_body(), box_body(2.0, half)}; }
};

TEST(TimeStepper, ABlockAboveTheFrictionAngleSlidesWithTheClosedForm) {
  // v_n = n h a exactly, x_n = h^2 a n (n + 1)/2: half a step ahead of the parabola.
  constexpr int kSteps = 120;
  for (const int sides : {4, 6, 8}) {
    for (const double heading : {0.0, 0.7}) {
      SCOPED_TRACE("sides " + std::to_string(sides) + ", heading " + std::to_string(heading));
      const Slope slope(0.6, 0.3, heading);
      PlaneContacts finder = slope.finder();
      TimeStepper stepper(slope.bodies(), finder, {.pyramid_sides = sides});
      State state = slope.start;
      run(stepper, state, kSteps);
      const double a = kG * (std::sin(0.6) - 0.3 * std::cos(0.6));
      const Vec3 moved = state[1].x - slope.start[1].x;
      EXPECT_NEAR(moved.dot(slope.down), kH * kH * a * kSteps * (kSteps + 1) / 2, 1e-9);
      EXPECT_LT((moved - moved.dot(slope.down) * slope.down).norm(), 1e-9);
      EXPECT_NEAR((state[1].p / 2.0).norm(), kSteps * kH * a, 1e-9);
      EXPECT_LT(state[1].L.norm(), 1e-9);
    }
  }
}

TEST(TimeStepper, ABlockBelowTheFrictionAngleDoesNotCreep) {
  // 0.99 of the friction angle: with a frame that is not aligned, 4 sides would hold only
  // cos(45 degrees) = 0.71 of it.
  for (const int sides : {4, 8}) {
    for (const double heading : {0.0, 0.7}) {
      SCOPED_TRACE("sides " + std::to_string(sides) + ", heading " + std::to_string(heading));
      const Slope slope(std::atan(0.99 * 0.5), 0.5, heading);
      PlaneContacts finder = slope.finder();
      TimeStepper stepper(slope.bodies(), finder, {.pyramid_sides = sides});
      State state = slope.start;
      run(stepper, state, 240);
      EXPECT_LT(largest_move(state, slope.start), 1e-10);
    }
  }
}

TEST(TimeStepper, ASlidingBlockIsBrakedToRestAndStays) {
  // v_0 = 1 m/s, mu g h = 0.0204 m/s a step: at rest within 0.25 s, after v_0^2 / (2 mu g) up to
  // h v_0 of the scheme.
  const Slope slope(0.0, 0.5, 0.4);
  PlaneContacts finder = slope.finder();
  TimeStepper stepper(slope.bodies(), finder, {});
  State state = slope.start;
  const Vec3 v0 = Vec3(0.6, 0.8, 0.0);
  state[1].p = 2.0 * v0;
  run(stepper, state, 60);
  const State stopped = state;
  EXPECT_LT(state[1].p.norm(), 1e-12);
  EXPECT_NEAR((state[1].x - slope.start[1].x).dot(v0), 1.0 / (2 * 0.5 * kG), kH);
  run(stepper, state, 60);
  EXPECT_LT(largest_move(state, stopped), 1e-12);
}

TEST(TimeStepper, ABallBouncesWithItsRestitution) {
  for (const double e : {0.0, 0.5, 0.9, 1.0}) {
    SCOPED_TRACE("e = " + std::to_string(e));
    PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.0, e}}});
    TimeStepper stepper({fixed_body(), ball_body(2.0, 0.5)}, finder, {});
    State state{at(Vec3::Zero()), at(Vec3(0, 0, 1.5))};
    int impacts = 0;
    double before = 0.0;
    run(stepper, state, 150, [&](int, const StepReport& report) {
      const double after = state[1].p.z() / 2.0;
      const bool hit = report.normal_impulses.size() > 0 && report.normal_impulses[0] > 0.0;
      if (hit && e > 0.0) {
        EXPECT_NEAR(after, -e * before, 1e-12);
      }
      impacts += hit ? 1 : 0;
      before = after;
    });
    EXPECT_GE(impacts, 1);
  }
}

TEST(TimeStepper, AnElasticBallKeepsTheInvariantOfTheSchemeForEver) {
  // Free steps and bounces at v -> -v both keep v^2/2 + g z - h g v/2 exactly.
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.3, 1.0}}});
  TimeStepper stepper({fixed_body(), ball_body(2.0, 0.5)}, finder, {});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 1.5))};
  const auto invariant = [&] {
    const double v = state[1].p.z() / 2.0;
    return 0.5 * v * v + kG * state[1].x.z() - 0.5 * kH * kG * v;
  };
  const double start = invariant();
  double lowest = 1.5;
  run(stepper, state, 5000, [&](int i, const StepReport& report) {
    EXPECT_NEAR(invariant(), start, 1e-10) << "step " << i;
    EXPECT_EQ(report.energy_change_projection, 0.0);
    lowest = std::min(lowest, state[1].x.z());
  });
  EXPECT_GT(lowest, 0.5 - kH * std::sqrt(2.0 * kG * 1.0) * 1.01);  // h |v| at most
}

TEST(TimeStepper, ABallAboutToBounceIsLeftOutAndNotSlowed) {
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.0, 1.0}}});
  TimeStepper stepper({fixed_body(), ball_body(1.0, 0.5)}, finder, {.margin = 0.1});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.51))};
  state[1].p = Vec3(0, 0, -4.0);  // crosses 0.0167 m a step, the gap is 0.01 m
  StepReport report;
  stepper.step(state, report);
  EXPECT_EQ(report.contacts_left_out, 1);
  EXPECT_TRUE(report.contacts.empty());
  EXPECT_NE(report.detail.find("left out"), std::string::npos);
  EXPECT_NEAR(state[1].p.z(), -4.0 - kG * kH, 1e-14);
  EXPECT_EQ(report.projection_status, lcp::Status::kNotRun);
  stepper.step(state, report);
  EXPECT_EQ(report.contacts_left_out, 0);
  EXPECT_NEAR(state[1].p.z(), 4.0 + kG * kH, 1e-12);
  EXPECT_GT(report.deepest_overlap, 0.006);
  EXPECT_EQ(report.projection_status, lcp::Status::kNotRun);  // it leaves by itself
}

TEST(TimeStepper, APlasticBallIsCaughtAtTheSurface) {
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.0, 0.0}}});
  TimeStepper stepper({fixed_body(), ball_body(1.0, 0.5)}, finder, {.margin = 0.1});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.51))};
  state[1].p = Vec3(0, 0, -4.0);
  StepReport report;
  stepper.step(state, report);
  EXPECT_NEAR(state[1].x.z(), 0.5, 1e-14);
  EXPECT_NEAR(state[1].p.z(), -0.01 / kH, 1e-12);
  stepper.step(state, report);
  EXPECT_NEAR(state[1].x.z(), 0.5, 1e-14);
  EXPECT_NEAR(state[1].p.z(), 0.0, 1e-12);
}

TEST(TimeStepper, BelowTheThresholdNothingBounces) {
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.0, 1.0}}});
  TimeStepper stepper({fixed_body(), ball_body(1.0, 0.5)}, finder, {.restitution_threshold = 0.5});
  for (const double speed : {0.4, 0.6}) {
    State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.5))};
    state[1].p = Vec3(0, 0, -speed);
    StepReport report;
    stepper.step(state, report);
    EXPECT_NEAR(state[1].p.z(), speed > 0.5 ? speed : 0.0, 1e-12);
  }
}

TEST(TimeStepper, ATumblingBoxWithRestitutionComesToRest) {
  const Vec3 half(0.5, 0.3, 0.2);
  PlaneContacts finder(Vec3::UnitZ(), {{TestBox{half}, {0.4, 0.5}}});
  TimeStepper stepper({fixed_body(), box_body(1.5, half)}, finder, {});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 1.0))};
  state[1].q = Quat(Eigen::AngleAxisd(0.5, Vec3(1, 2, 0).normalized()));
  set_velocity(stepper.bodies()[1], {Vec3(0.5, 0, 0), Vec3(0, 1, 2)}, state[1]);
  double energy = 0.0;
  run(stepper, state, 5 * 240,
      [&](int, const StepReport& report) { energy = report.kinetic_energy; });
  EXPECT_LT(energy, 1e-12);
  const Vec3 heights = (half.array() - state[1].x.z()).abs();  // on which face is its choice
  EXPECT_LT(heights.minCoeff(), 1e-6);
}

struct Tower {
  std::vector<Vec3> halves;
  Bodies bodies{fixed_body()};
  State start{at(Vec3::Zero())};

  void add(double mass, const Vec3& half, double overlap = 0.0) {
    double top = 0.0;
    if (!halves.empty()) top = start.back().x.z() + halves.back().z();
    bodies.push_back(box_body(mass, half));
    start.push_back(at(Vec3(0, 0, top + half.z() - overlap)));
    halves.push_back(half);
  }
  [[nodiscard]] PlaneContacts finder(const Material& material) const {
    std::vector<TestBody> shapes;
    for (const Vec3& half : halves) shapes.push_back({TestBox{half}, material});
    PlaneContacts contacts(Vec3::UnitZ(), shapes);
    for (int k = 2; k <= static_cast<int>(halves.size()); ++k) contacts.stack(k, k - 1);
    return contacts;
  }
};

TEST(TimeStepper, AStackOfFiveBoxesStandsForTwoSeconds) {
  Tower tower;
  for (int i = 0; i < 5; ++i) tower.add(1.0, Vec3(0.5, 0.5, 0.5));
  PlaneContacts finder = tower.finder({0.5, 0.0});
  TimeStepper stepper(tower.bodies, finder, {.pyramid_sides = 4});
  State state = tower.start;
  run(stepper, state, 480, [&](int, const StepReport& report) {
    EXPECT_EQ(report.contacts.size(), 20u);
    EXPECT_NEAR(report.normal_impulses.sum(), (5 + 4 + 3 + 2 + 1) * kG * kH, 1e-9);
  });
  EXPECT_LT(largest_move(state, tower.start), 1e-9);
}

TEST(TimeStepper, AHeavyBoxRestsOnALightOne) {
  for (const bool heavy_on_top : {true, false}) {
    SCOPED_TRACE(heavy_on_top ? "heavy on top" : "light on top");
    Tower tower;
    tower.add(heavy_on_top ? 1.0 : 1000.0, Vec3(0.5, 0.5, 0.5));
    tower.add(heavy_on_top ? 1000.0 : 1.0, Vec3(0.4, 0.4, 0.4));
    PlaneContacts finder = tower.finder({0.5, 0.0});
    TimeStepper stepper(tower.bodies, finder, {});
    State state = tower.start;
    run(stepper, state, 120);
    EXPECT_LT(largest_move(state, tower.start), 1e-9);
  }
}

TEST(TimeStepper, OverlapIsProjectedAwayAndTheEnergyForItIsReported) {
  Tower tower;
  for (int i = 0; i < 3; ++i) tower.add(1.0, Vec3(0.5, 0.5, 0.5), 1e-3);
  PlaneContacts finder = tower.finder({0.5, 0.0});
  TimeStepper stepper(tower.bodies, finder, {.pyramid_sides = 4});
  State state = tower.start;
  StepReport report;
  stepper.step(state, report);
  EXPECT_NEAR(report.deepest_overlap, 1e-3, 1e-12);
  EXPECT_TRUE(lcp::is_solved(report.projection_status));
  EXPECT_NEAR(report.energy_change_projection, kG * (1 + 2 + 3) * 1e-3, 1e-9);
  for (int k = 1; k <= 3; ++k) {
    EXPECT_NEAR(state[k].x.z(), k - 0.5, 1e-12);
    EXPECT_LT(state[k].p.norm(), 1e-12);
  }
  stepper.step(state, report);
  EXPECT_EQ(report.projection_status, lcp::Status::kNotRun);
}

TEST(TimeStepper, WithoutRestitutionImpulsesNeverAddEnergy) {
  const Vec3 half(0.5, 0.3, 0.2);
  for (unsigned seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 rng(seed);
    std::normal_distribution<double> normal;
    PlaneContacts finder(Vec3::UnitZ(), {{TestBox{half}, {0.4, 0.0}}});
    TimeStepper stepper({fixed_body(), box_body(1.5, half)}, finder, {});
    State state{at(Vec3::Zero()), at(Vec3(0, 0, 1.0))};
    const auto draw = [&] { return Vec3(normal(rng), normal(rng), normal(rng)); };
    state[1].q = Quat(Eigen::AngleAxisd(normal(rng), draw().normalized()));
    set_velocity(stepper.bodies()[1], {draw(), 3.0 * draw()}, state[1]);
    run(stepper, state, 300, [&](int i, const StepReport& report) {
      // |w| <= 1e-8 |q| at active rows, |q| of some m/s, times impulses of some N s, would allow
      // 1e-7; a solved active set leaves far less.
      EXPECT_LE(report.energy_change_impact, 1e-8) << "step " << i;
    });
    // It has come to rest on the plane, not through it.
    EXPECT_GT(state[1].x.z(), 0.2 - 1e-3);
  }
}

TEST(TimeStepper, TwoFreeBallsKeepLinearAndAngularMomentum) {
  const Bodies bodies{fixed_body(), ball_body(1.0, 0.5), ball_body(1000.0, 0.5)};
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.5, 0.5}}, {TestBall{0.5}, {0.5, 0.5}}});
  finder.without_plane();
  finder.pair_balls(1, 2);
  TimeStepper stepper(bodies, finder, {.gravity = Vec3::Zero()});
  State state{at(Vec3::Zero()), at(Vec3(-1.0, 0.2, 0)), at(Vec3(0.5, 0, 0.1))};
  set_velocity(bodies[1], {Vec3(2, 0, 0.3), Vec3(3, -5, 8)}, state[1]);
  const auto momentum = [&]() -> Vec3 { return state[1].p + state[2].p; };
  const auto moment = [&]() -> Vec3 {
    return state[1].L + state[1].x.cross(state[1].p) + state[2].L + state[2].x.cross(state[2].p);
  };
  const Vec3 p = momentum();
  const Vec3 L = moment();
  int hits = 0;
  run(stepper, state, 240, [&](int, const StepReport& report) {
    hits += report.normal_impulses.size() > 0 && report.normal_impulses[0] > 0.0 ? 1 : 0;
  });
  EXPECT_GE(hits, 1);
  EXPECT_LT(state[1].p.x(), 0.0);  // it came back
  EXPECT_LT((momentum() - p).norm(), 1e-12 * p.norm());
  EXPECT_LT((moment() - L).norm(), 1e-12 * 100.0);  // rounding of momenta of about 10 at 2 m
}

TEST(TimeStepper, AConveyorDragsABoxAlong) {
  const Vec3 half(0.5, 0.4, 0.3);
  Body belt;
  belt.kind = BodyKind::kKinematic;
  // The belt's face is not bounded, so it may move on for ever.
  PlaneContacts finder(Vec3::UnitZ(), {{TestBox{half}, {0.5, 0.0}}});
  TimeStepper stepper({belt, box_body(2.0, half)}, finder, {});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.3))};
  state[0].p = Vec3(1.0, 0.5, 0.0);
  run(stepper, state, 10);
  EXPECT_NEAR((state[1].p / 2.0).norm(), 10 * kH * 0.5 * kG, 1e-10);  // mu g while it slips
  run(stepper, state, 90);
  EXPECT_LT((state[1].p / 2.0 - Vec3(1.0, 0.5, 0.0)).norm(), 1e-10);
  EXPECT_EQ(state[0].p, Vec3(1.0, 0.5, 0.0));
  EXPECT_LT((state[0].x - 100 * kH * Vec3(1.0, 0.5, 0.0)).norm(), 1e-13);
}

TEST(TimeStepper, ALiftCarriesABoxUp) {
  const Vec3 half(0.5, 0.4, 0.3);
  Body lift;
  lift.kind = BodyKind::kKinematic;
  PlaneContacts finder(Vec3::UnitZ(), {{TestBox{half}, {0.0, 0.0}}});
  TimeStepper stepper({lift, box_body(2.0, half)}, finder, {});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.3))};
  state[0].p = Vec3(0, 0, 1.0);
  run(stepper, state, 100);
  EXPECT_NEAR(state[1].x.z(), 0.3 + 100 * kH, 1e-10);
  EXPECT_NEAR(state[1].p.z(), 2.0, 1e-10);
}

TEST(TimeStepper, FreeFlightIsTheClosedFormOfTheIntegrator) {
  const Body body = ball_body(2.0, 0.5);
  const Vec3 v0(1.0, 2.0, 30.0);
  constexpr int kSteps = 100;
  const double t = kSteps * kH;
  for (const Integrator integrator : {Integrator::kSemiImplicit, Integrator::kRungeKutta4}) {
    PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {}}});
    TimeStepper stepper({fixed_body(), body}, finder, {.integrator = integrator});
    State state{at(Vec3::Zero()), at(Vec3(0, 0, 10))};
    state[1].p = 2.0 * v0;
    StepReport report;
    for (int i = 0; i < kSteps; ++i) {
      stepper.step(state, report);
      EXPECT_EQ(report.status, lcp::Status::kSolved);
      EXPECT_EQ(report.result.z.size(), 0);
      EXPECT_TRUE(report.detail.empty());
    }
    const double drop = integrator == Integrator::kRungeKutta4
                            ? 0.5 * t * t
                            : 0.5 * kH * kH * kSteps * (kSteps + 1);
    EXPECT_LT((state[1].x - (Vec3(0, 0, 10) + t * v0 - kG * drop * Vec3::UnitZ())).norm(), 1e-12);
    EXPECT_LT((state[1].p / 2.0 - (v0 - kG * t * Vec3::UnitZ())).norm(), 1e-12);
    EXPECT_NEAR(report.kinetic_energy, 0.5 * state[1].p.squaredNorm() / 2.0, 1e-10);
    EXPECT_NEAR(report.potential_energy, 2.0 * kG * state[1].x.z(), 1e-10);
  }
}

TEST(TimeStepper, OneContactWithoutFrictionTakesNoSolver) {
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.0, 0.0}}});
  TimeStepper stepper({fixed_body(), ball_body(2.0, 0.5)}, finder, {});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.5))};
  StepReport report;
  stepper.step(state, report);
  EXPECT_EQ(report.result.solver, "closed form");
  EXPECT_EQ(report.status, lcp::Status::kSolved);
  EXPECT_LE(report.result.certificate.unit_free_residual, 1e-15);
  EXPECT_NEAR(report.normal_impulses[0], 2.0 * kG * kH, 1e-15);
}

TEST(TimeStepper, AnUnevenBallSpinsInContactWithoutLosingOrGainingEnergy) {
  // The contact acts through the centre of mass: the spin is free, and its energy that of a top.
  Body top = ball_body(1.0, 0.5);
  top.inertia = Vec3(1, 2, 3).asDiagonal();
  PlaneContacts contacts(Vec3::UnitZ(), {{TestBall{0.5}, {}}});
  TimeStepper stepper({fixed_body(), top}, contacts, {.step = kH});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.5))};
  set_velocity(top, {Vec3::Zero(), Vec3(5, 7, 5)}, state[1]);
  const BodyState start = state[1];
  run(stepper, state, 2400,
      [&](int, const StepReport& report) { EXPECT_EQ(report.contacts.size(), 1u); });
  EXPECT_NEAR(kinetic_energy(top, state[1]), kinetic_energy(top, start),
              1e-12 * kinetic_energy(top, start));
  EXPECT_LE((state[1].L - start.L).norm(), 1e-12 * start.L.norm());
  EXPECT_NEAR(state[1].x.z(), 0.5, 1e-9);
}

TEST(TimeStepper, MatrixAndQuaternionTellTheSameStory) {
  const Vec3 half(0.5, 0.3, 0.2);
  State end[2];
  for (const auto scheme : {OrientationScheme::kQuaternion, OrientationScheme::kRotationMatrix}) {
    PlaneContacts finder(Vec3::UnitZ(), {{TestBox{half}, {0.4, 0.0}}});
    TimeStepper stepper({fixed_body(), box_body(1.5, half)}, finder,
                        {.step = 1e-3, .orientation = scheme});
    State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.6))};
    set_velocity(stepper.bodies()[1], {Vec3(0.3, 0, 0), Vec3(0.5, 1.0, 0.2)}, state[1]);
    run(stepper, state, 200);
    end[static_cast<int>(scheme)] = state;
  }
  // Both are of first order: 0.2 s with |w| = 1.2 rad/s and h = 1e-3 s.
  EXPECT_LT(largest_move(end[0], end[1]), 1e-3);
  EXPECT_GT(end[0][1].q.angularDistance(Quat::Identity()), 0.1);
}

TEST(TimeStepper, AVelocityProblemThatIsNotSolvedSaysSoAndAppliesTheBestIterate) {
  Tower tower;
  for (int i = 0; i < 3; ++i) tower.add(1.0, Vec3(0.5, 0.5, 0.5));
  PlaneContacts finder = tower.finder({0.5, 0.0});
  TimeStepper stepper(tower.bodies, finder,
                      {.solver = "pgs", .lcp = {.tolerance = 1e-9, .max_iterations = 1}});
  State state = tower.start;
  StepReport report;
  stepper.step(state, report);
  EXPECT_EQ(report.status, lcp::Status::kIterationLimit);
  EXPECT_NE(report.detail.find("best iterate applied"), std::string::npos) << report.detail;
  EXPECT_TRUE(state[1].p.allFinite());
  EXPECT_EQ(report.normal_impulses, report.result.z.head(12));
}

TEST(TimeStepper, AnInfeasibleRestitutionIsNotCalledSolved) {
  // A ball in a vice: two driven walls close in on it, e = 1. Each wants it to leave.
  Body wall;
  wall.kind = BodyKind::kKinematic;
  const auto contact = [](int from, double side, const State& state) {
    Contact c;
    c.body_a = 0;
    c.body_b = from;
    c.normal = Vec3(-side, 0, 0);
    c.point_a = state[0].x + Vec3(0.5 * side, 0, 0);
    c.point_b = c.point_a;
    c.gap = 0.0;
    c.material = {0.0, 1.0};
    return c;
  };
  GivenContacts finder([&](const State& state) {
    return ContactSet{contact(1, 1.0, state), contact(2, -1.0, state)};
  });
  TimeStepper stepper({ball_body(1.0, 0.5), wall, wall}, finder, {.gravity = Vec3::Zero()});
  State state{at(Vec3::Zero()), at(Vec3(1, 0, 0)), at(Vec3(-1, 0, 0))};
  state[1].p = Vec3(-1, 0, 0);
  state[2].p = Vec3(1, 0, 0);
  StepReport report;
  stepper.step(state, report);
  EXPECT_EQ(report.status, lcp::Status::kInfeasible) << lcp::to_string(report.status);
  EXPECT_FALSE(report.detail.empty());
  EXPECT_TRUE(state[0].p.allFinite());
}

TEST(TimeStepper, BadSettingsNameTheField) {
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {}}});
  const auto message = [&](const TimeStepSettings& settings) -> std::string {
    try {
      TimeStepper stepper({fixed_body(), ball_body(1.0, 0.5)}, finder, settings);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto names = [&](const TimeStepSettings& settings, const std::string& field) {
    const std::string text = message(settings);
    EXPECT_NE(text.find(field), std::string::npos) << text;
  };
  EXPECT_EQ(message({}), "accepted");
  for (const double bad : {0.0, -1.0, kNaN, std::numeric_limits<double>::infinity()}) {
    names({.step = bad}, "step");
  }
  names({.gravity = Vec3(0, 0, kNaN)}, "gravity");
  names({.pyramid_sides = 2}, "pyramid_sides");
  names({.pyramid_sides = 7}, "pyramid_sides");
  for (const double bad : {-1e-3, kNaN, std::numeric_limits<double>::infinity()}) {
    names({.margin = bad}, "margin");
    names({.touching_tolerance = bad}, "touching_tolerance");
    names({.restitution_threshold = bad}, "restitution_threshold");
  }
  names({.solver = "no such solver"}, "no such solver");
  names({.lcp = {.tolerance = -1.0}}, "tolerance");
}

TEST(TimeStepper, BadBodiesStatesAndContactsAreRefusedBeforeAnythingChanges) {
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {}}});
  EXPECT_THROW(TimeStepper({fixed_body(), ball_body(-1.0, 0.5)}, finder, {}),
               std::invalid_argument);

  TimeStepper stepper({fixed_body(), ball_body(1.0, 0.5)}, finder, {});
  StepReport report;
  State state{at(Vec3::Zero()), at(Vec3(0, 0, kNaN))};
  EXPECT_THROW(stepper.step(state, report), std::invalid_argument);
  State short_state{at(Vec3::Zero())};
  EXPECT_THROW(stepper.step(short_state, report), std::invalid_argument);

  GivenContacts unfilled([](const State&) {
    ContactSet contacts(1);
    contacts[0].body_a = 1;
    contacts[0].body_b = 0;
    return contacts;
  });
  TimeStepper with_bad_contacts({fixed_body(), ball_body(1.0, 0.5)}, unfilled, {});
  State good{at(Vec3::Zero()), at(Vec3(0, 0, 5))};
  EXPECT_THROW(with_bad_contacts.step(good, report), std::invalid_argument);
  EXPECT_EQ(good[1].x, Vec3(0, 0, 5));
  EXPECT_EQ(good[1].p, Vec3::Zero());
}

}  // namespace
}  // namespace signorini
