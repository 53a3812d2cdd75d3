#include <signorini/collision/contact_time.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/pair_query.h>

#include "random_pairs.h"
#include "random_throws.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

namespace signorini::collision {
namespace {

using testing::Random;
using testing::random_throw;
using testing::ShapeKind;
using testing::Throw;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr int kThrows = 200;
#else
constexpr int kThrows = 4000;
#endif

ConstantVelocityMotion straight(const Vec3& from, const Vec3& velocity,
                                const Vec3& spin = Vec3::Zero(),
                                const Quat& orientation = Quat::Identity()) {
  return {{from, orientation}, velocity, spin};
}

/// Free flight under gravity: x(t) = x0 + v t + g t^2 / 2, constant spin.
class FreeFlight final : public Motion {
 public:
  FreeFlight(const Vec3& from, const Vec3& velocity, const Vec3& gravity, const Vec3& spin)
      : from_(from), velocity_(velocity), gravity_(gravity), spin_({}, Vec3::Zero(), spin) {}

  [[nodiscard]] Pose pose(double t) const override {
    return {from_ + t * velocity_ + 0.5 * t * t * gravity_, spin_.pose(t).orientation};
  }
  [[nodiscard]] SpeedBound speed_bound(double t0, double t1) const override {
    // |v| is convex in t: largest at an end.
    return {std::max((velocity_ + t0 * gravity_).norm(), (velocity_ + t1 * gravity_).norm()),
            spin_.speed_bound(t0, t1).angular};
  }

 private:
  Vec3 from_;
  Vec3 velocity_;
  Vec3 gravity_;
  ConstantVelocityMotion spin_;
};

/// Counts how often its pose is asked for.
class CountingMotion final : public Motion {
 public:
  explicit CountingMotion(const Motion& motion) : motion_(motion) {}
  [[nodiscard]] Pose pose(double t) const override {
    ++count;
    return motion_.pose(t);
  }
  [[nodiscard]] SpeedBound speed_bound(double t0, double t1) const override {
    return motion_.speed_bound(t0, t1);
  }
  mutable int count = 0;

 private:
  const Motion& motion_;
};

const StillMotion kStill{Pose{}};
const Box kCube{Vec3::Constant(0.5)};

TEST(ContactTime, BallFallingOnAPlaneMeetsTheClosedForm) {
  const Vec3 gravity(0.0, 0.0, -9.81);
  for (const double up : {-3.0, 0.0, 2.0}) {
    const double height = 1.7;
    const FreeFlight flight({0.3, 0.2, height + 0.25}, {4.0, 0.0, up}, gravity, {1.0, 2.0, 3.0});
    const double wanted = (up + std::sqrt(up * up + 2.0 * 9.81 * height)) / 9.81;
    const auto time = contact_time(Sphere{0.25}, flight, HalfSpace{}, kStill, 5.0);
    ASSERT_TRUE(time.has_value());
    // The gap is found to eps of the coordinates, the time to that over the speed.
    EXPECT_NEAR(*time, wanted, 1e-14 * wanted);
    EXPECT_FALSE(contact_time(Sphere{0.25}, flight, HalfSpace{}, kStill, 0.99 * wanted));
  }
}

TEST(ContactTime, BulletDoesNotTunnelThroughAThinPlate) {
  const Box plate{{0.5, 0.5, 0.0005}};
  for (const double speed : {1.0, 1e3, 1e6}) {
    const auto bullet = straight({0.0, 0.0, 0.8}, {0.0, 0.0, -speed});
    const auto time = contact_time(Sphere{0.005}, bullet, plate, kStill, 1.0);
    ASSERT_TRUE(time.has_value()) << speed;
    EXPECT_NEAR(*time, (0.8 - 0.0055) / speed, 1e-14 / speed);
  }
  const auto oblique = straight({-0.8, 0.1, 0.4}, {1000.0, 0.0, -500.0}, {0, 0, 300.0});
  EXPECT_TRUE(contact_time(Box{Vec3::Constant(0.005)}, oblique, plate, kStill, 0.01).has_value());
}

ConvexHull wedge(double size) {
  return make_hull({{-size, -size, -size}, {size, -size, -size}, {0, size, -size}, {0, 0, size}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

TEST(ContactTime, BulletsOfEveryShapeStrikePlatesOfEveryShape) {
  const double r = 0.005;
  const Shape bullets[] = {Capsule{r, r}, Cylinder{r, r}, Cone{r, r}, Ellipsoid{{r, 0.5 * r, r}},
                           wedge(r)};
  const double thin = 0.0005;
  const Shape plates[] = {
      Box{{0.5, 0.5, thin}}, Cylinder{0.5, thin}, Ellipsoid{{0.5, 0.5, thin}},
      make_hull({{-1, -1, -thin},
                 {1, -1, -thin},
                 {0, 1, -thin},
                 {-1, -1, thin},
                 {1, -1, thin},
                 {0, 1, thin}},
                {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}})};
  for (const Shape& bullet : bullets) {
    for (const Shape& plate : plates) {
      for (const double speed : {1.0, 1e3, 1e6}) {
        const auto flight = straight({0.0, 0.0, 0.8}, {0.0, 0.0, -speed}, {0.0, 0.0, 100.0});
        const auto time = contact_time(bullet, flight, plate, kStill, 1.0);
        ASSERT_TRUE(time.has_value()) << bullet.index() << " on " << plate.index();
        const double low =
            -support(bullet, {}, -Vec3::UnitZ());  // the lowest point lies on the axis
        EXPECT_NEAR(*time * speed, 0.8 + low - thin, 1e-9)
            << bullet.index() << " on " << plate.index();
      }
    }
  }
}

TEST(ContactTime, SpinningRodStrikesAPostWhenItsAngleSays) {
  // A rod of half length 1 along x turns about z; its side |y| = 0.01 meets a ball of radius 0.1
  // at (0, 0.9): with the rod at angle phi the ball's centre is at height 0.9 cos(phi) over the
  // rod's axis and 0.9 sin(phi) along it.
  const Box rod{{1.0, 0.01, 0.01}};
  const double spin = 40.0;
  const auto turning = straight(Vec3::Zero(), Vec3::Zero(), {0.0, 0.0, spin});
  const StillMotion post{{{0.0, 0.9, 0.0}, Quat::Identity()}};
  const auto time = contact_time(rod, turning, Sphere{0.1}, post, 1.0);
  ASSERT_TRUE(time.has_value());
  EXPECT_NEAR(*time * spin, std::acos(0.11 / 0.9), 1e-13);
}

TEST(ContactTime, TouchingStartCountsOnlyIfApproaching) {
  const auto ball = [](double speed) { return straight({0.0, 0.0, 0.5}, {0.3, 0.0, speed}); };
  EXPECT_EQ(contact_time(Sphere{0.5}, ball(-1.0), HalfSpace{}, kStill, 1.0), 0.0);
  EXPECT_EQ(contact_time(Sphere{0.5}, ball(0.0), HalfSpace{}, kStill, 1.0), std::nullopt);
  EXPECT_EQ(contact_time(Sphere{0.5}, ball(1.0), HalfSpace{}, kStill, 1.0), std::nullopt);
  EXPECT_EQ(contact_time(Sphere{0.5}, StillMotion{{{0, 0, 0.5}, Quat::Identity()}}, HalfSpace{},
                         kStill, 1.0),
            std::nullopt);
}

TEST(ContactTime, SeparatingPairReportsItsNextApproach) {
  const FreeFlight hop({0.0, 0.0, 0.5}, {0.0, 0.0, 2.0}, {0.0, 0.0, -10.0}, Vec3::Zero());
  const auto time = contact_time(Sphere{0.5}, hop, HalfSpace{}, kStill, 1.0);
  ASSERT_TRUE(time.has_value());
  EXPECT_NEAR(*time, 0.4, 1e-14);
}

TEST(ContactTime, OverlappingPairReportsWhenItDeepens) {
  const FreeFlight hop({0.0, 0.0, 0.4}, {0.0, 0.0, 0.1}, {0.0, 0.0, -10.0}, Vec3::Zero());
  const auto time = contact_time(Sphere{0.5}, hop, HalfSpace{}, kStill, 1.0);
  ASSERT_TRUE(time.has_value());
  EXPECT_NEAR(*time, 0.01, 1e-5);  // the turning point is flat: eps = 1e-9 there is 1e-5 s
  const auto sinking = straight({0.0, 0.0, 0.4}, {0.0, 0.0, -0.1});
  EXPECT_EQ(contact_time(Sphere{0.5}, sinking, HalfSpace{}, kStill, 1.0), 0.0);
}

/// Pose evaluations that a search without contact takes.
int evaluations(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b,
                double duration) {
  const CountingMotion counting(motion_a);
  EXPECT_EQ(contact_time(a, counting, b, motion_b, duration), std::nullopt);
  return counting.count;
}

TEST(ContactTime, RestingSlidingAndRollingPairsArePassedInFewSteps) {
  const Pose on_plane{{0.0, 0.0, 0.5}, Quat::Identity()};
  EXPECT_LE(evaluations(kCube, StillMotion{on_plane}, HalfSpace{}, kStill, 1.0), 10);
  const auto sliding = straight({0, 0, 0.5}, {5.0, 1.0, 0.0}, {0.0, 0.0, 2.0});
  EXPECT_LE(evaluations(kCube, sliding, HalfSpace{}, kStill, 1.0), 30000);
  const auto rolling = straight({0, 0, 0.5}, {5.0, 0.0, 0.0}, {0.0, 10.0, 0.0});
  EXPECT_LE(evaluations(Sphere{0.5}, rolling, HalfSpace{}, kStill, 1.0), 300);
  // Two boxes that fly together, touching.
  const auto lower = straight({0, 0, 0.0}, {3.0, 2.0, 100.0});
  const auto upper = straight({0, 0, 1.0}, {3.0, 2.0, 100.0});
  EXPECT_LE(evaluations(kCube, upper, kCube, lower, 1.0), 3000);
}

TEST(ContactTime, GrazingPassesAboveTheToleranceAndStrikesBelowIt) {
  for (const double clearance : {1e-3, 1e-6, 1e-8}) {
    const auto above = straight({-3.0, 0.0, 1.0 + clearance}, {10.0, 0.0, 0.0});
    EXPECT_LE(evaluations(Sphere{0.5}, above, Sphere{0.5}, kStill, 1.0), 3000) << clearance;
    const auto below = straight({-3.0, 0.0, 1.0 - clearance}, {10.0, 0.0, 0.0});
    const auto time = contact_time(Sphere{0.5}, below, Sphere{0.5}, kStill, 1.0);
    ASSERT_TRUE(time.has_value()) << clearance;
    const double wanted = 0.3 - std::sqrt(1.0 - (1.0 - clearance) * (1.0 - clearance)) / 10.0;
    EXPECT_NEAR(*time, wanted, 1e-12) << clearance;
  }
}

TEST(ContactTime, KinematicPlaneThatTurnsStrikesABox) {
  // The plane z = 0 turns about y; the ball's centre at (1, 0, 0.5) meets it when
  // cos(phi) 0.5 - sin(phi) 1 = 0.1.
  const auto plane = straight(Vec3::Zero(), Vec3::Zero(), {0.0, -0.7, 0.0});
  const StillMotion ball{{{1.0, 0.0, 0.5}, Quat::Identity()}};
  const auto time = contact_time(Sphere{0.1}, ball, HalfSpace{}, plane, 2.0);
  ASSERT_TRUE(time.has_value());
  const double wanted = std::atan2(0.5, 1.0) - std::asin(0.1 / std::hypot(0.5, 1.0));
  EXPECT_NEAR(*time * 0.7, wanted, 1e-13);
}

/// Slides on the plane z = 0 far from the origin for half a second, then sinks.
class SlideThenSink final : public Motion {
 public:
  [[nodiscard]] Pose pose(double t) const override {
    return {{1000.3 + 3.0 * t, -700.1, 0.7 - std::max(0.0, t - 0.5)}, tilt_};
  }
  [[nodiscard]] SpeedBound speed_bound(double, double t1) const override {
    return {t1 <= 0.5 ? 3.0 : std::hypot(3.0, 1.0), 0.0};
  }

 private:
  Quat tilt_ = Quat(Eigen::AngleAxisd(M_PI / 7, Vec3::UnitZ()));
};

TEST(ContactTime, RoundingOfARestingGapIsNoApproach) {
  const SlideThenSink motion;
  const auto time = contact_time(Box{{0.3, 0.4, 0.7}}, motion, HalfSpace{}, kStill, 1.0);
  ASSERT_TRUE(time.has_value());
  EXPECT_NEAR(*time, 0.5, 1e-9);  // eps is 1e-9 m, the approach speed 1 m/s
}

/// The gap along two motions.
double gap_at(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b,
              double t) {
  return signed_distance(a, motion_a.pose(t), b, motion_b.pose(t));
}

// The reference samples the gap densely and bisects the first change of sign.
TEST(ContactTime, AgreesWithDenseSamplingOnRandomThrows) {
  Random random(20260110);
  int hits = 0;
  int evaluated = 0;
  int most = 0;
  for (int k = 0; k < kThrows; ++k) {
    constexpr ShapeKind kKinds[] = {ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kHalfSpace};
    const auto pair = testing::random_pair(random, kKinds[k % 2], kKinds[(k / 2) % 3],
                                           testing::Placement::kAnywhere);
    const double size = pair.size;
    // Apart by up to two sizes, thrown at each other, more or less.
    std::vector<Contact> contacts;
    find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b, 1e9, contacts);
    const Contact& contact = contacts.front();
    const Vec3 from = pair.pose_a.position +
                      (testing::uniform(random, 0.0, 2.0) * size - contact.gap) * contact.normal;
    const auto spin = [&] {
      return Vec3(testing::uniform(random, 0.0, 10.0) * testing::random_direction(random));
    };
    const auto speed = [&] {
      return Vec3(size * testing::uniform(random, 0.0, 3.0) * testing::random_direction(random));
    };
    const bool on_plane = std::holds_alternative<HalfSpace>(pair.b);
    const ConstantVelocityMotion motion_a({from, pair.pose_a.orientation},
                                          speed() - 2.0 * size * contact.normal, spin());
    const ConstantVelocityMotion motion_b(pair.pose_b, on_plane ? Vec3(Vec3::Zero()) : speed(),
                                          on_plane ? Vec3(Vec3::Zero()) : spin());
    const double start = gap_at(pair.a, motion_a, pair.b, motion_b, 0.0);
    if (start <= 0.0) {
      continue;
    }
    const CountingMotion counting(motion_a);
    const auto time = contact_time(pair.a, counting, pair.b, motion_b, 1.0);
    evaluated += counting.count;
    most = std::max(most, counting.count);
    const double tolerance = 1e-9 * size + 64.0 * pair.rounding;
    hits += time.has_value();
    if (time) {
      EXPECT_NEAR(gap_at(pair.a, motion_a, pair.b, motion_b, *time), 0.0, tolerance)
          << describe(pair);
    }
    const double until = time.value_or(1.0);
    for (int i = 0; i < 1000; ++i) {
      const double t = until * i / 1000.0;
      EXPECT_GE(gap_at(pair.a, motion_a, pair.b, motion_b, t), -tolerance)
          << describe(pair) << "missed at t = " << t;
    }
  }
  std::printf("    %d throws, %d contacts; %.1f poses a throw, at most %d\n", kThrows, hits,
              1.0 * evaluated / kThrows, most);
  EXPECT_GT(hits, kThrows / 4);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr int kNewThrows = 40;
#else
constexpr int kNewThrows = 100;
#endif

/// None of sphere, box and half-space.
constexpr ShapeKind kNew[] = {ShapeKind::kCapsule, ShapeKind::kCylinder, ShapeKind::kCone,
                              ShapeKind::kEllipsoid, ShapeKind::kHull};

// The gap is sampled up to the time, and the time compared with a bisection of the gap.
TEST(ContactTime, OfTheOtherShapesAgreesWithBisectionOnRandomThrows) {
  Random random(20261125);
  int hits = 0;
  double worst = 0.0;
  for (int k = 0; k < kNewThrows; ++k) {
    const Throw thrown = random_throw(random, kNew[k % 5], static_cast<ShapeKind>(k / 5 % 8),
                                      testing::uniform(random, 0.01, 2.0));
    const auto& [pair, a, b] = thrown;
    const auto gap = [&](double t) { return gap_at(pair.a, a, pair.b, b, t); };
    const auto time = contact_time(pair.a, a, pair.b, b, 1.0);
    const double tolerance = 1e-8 * pair.size + 64.0 * pair.rounding;
    const double until = time.value_or(1.0);
    for (int i = 0; i <= 60; ++i) {
      ASSERT_GE(gap(until * i / 60.0), -tolerance) << describe(pair) << "missed";
    }
    if (!time) {
      continue;
    }
    ++hits;
    EXPECT_LE(std::abs(gap(*time)), tolerance) << describe(pair);
    const double h = 1e-5;
    const double approach = (gap(*time - h) - gap(*time + h)) / (2.0 * h);
    if (*time < h || !(approach > 0.05 * pair.size) || !(gap(*time + h) < -tolerance)) {
      continue;  // grazing
    }
    double low = *time - h;
    double high = *time + h;
    while (high - low > 1e-15) {
      const double middle = 0.5 * (low + high);
      if (!(middle > low && middle < high)) {
        break;
      }
      (gap(middle) > 0.0 ? low : high) = middle;
    }
    const double error = std::abs(low - *time);
    worst = std::max(worst, error);
    EXPECT_LE(error, 1e-9 + 2.0 * tolerance / approach) << describe(pair);
  }
  std::printf("    %d throws, %d contacts, time off by at most %.1e s\n", kNewThrows, hits, worst);
  EXPECT_GT(hits, kNewThrows / 4);
}

TEST(ContactTime, FromAnOverlapNothingBecomesDeeperUnnoticed) {
  Random random(7);
  for (int k = 0; k < kNewThrows / 4; ++k) {
    const Throw thrown = random_throw(random, kNew[k % 5], static_cast<ShapeKind>(k / 5 % 8),
                                      -testing::uniform(random, 1e-3, 0.5));
    const auto& [pair, a, b] = thrown;
    const double start = gap_at(pair.a, a, pair.b, b, 0.0);
    const double until = contact_time(pair.a, a, pair.b, b, 1.0).value_or(1.0);
    for (int i = 0; i <= 100; ++i) {
      const double d = gap_at(pair.a, a, pair.b, b, until * i / 100.0);
      ASSERT_GE(d, std::min(0.0, start) - 1e-8 * pair.size - 64.0 * pair.rounding)
          << describe(pair);
    }
  }
}

// What the collision fuzzer's bytes drew: a flat cone in a ball, and a narrow one in a disk, coming
// out while they turn.
TEST(ContactTime, OutOfAnOverlapWhileTurningTakesBoundedSteps) {
  const auto poses_of = [](const Shape& a, const ConstantVelocityMotion& motion, const Shape& b) {
    const CountingMotion counting(motion);
    EXPECT_EQ(contact_time(a, counting, b, kStill, 0.5), std::nullopt);
    return counting.count;
  };
  EXPECT_LT(poses_of(Cone{0.0316, 0.001},
                     {{{0, 0.03163, 0.03163}, Quat::Identity()}, {0.3163, 0, 0}, {-4, 0, -4}},
                     Sphere{0.0316}),
            20000);
  EXPECT_LT(poses_of(Cone{1.0, 0.0316},
                     {{{0, 0.516, 0}, Quat::Identity()}, {-1.032, 0, -1.032}, {-2, 2, -4}},
                     Cone{0.0316, 0.001}),
            20000);
}

TEST(ContactTime, BadInputIsRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)contact_time(kCube, kStill, kCube, kStill, -1.0), std::invalid_argument);
  EXPECT_THROW((void)contact_time(kCube, kStill, kCube, kStill, kNaN), std::invalid_argument);
  const auto endless = straight({0, 0, 3}, {std::numeric_limits<double>::infinity(), 0, 0});
  EXPECT_THROW((void)contact_time(kCube, endless, kCube, kStill, 1.0), std::invalid_argument);
  EXPECT_EQ(contact_time(HalfSpace{}, kStill, HalfSpace{}, kStill, 1.0), std::nullopt);
}

}  // namespace
}  // namespace signorini::collision
