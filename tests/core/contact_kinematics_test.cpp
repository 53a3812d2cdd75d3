// d, N' and d'' against finite differences of the true gap functions, for every pair of features.

#include <signorini/core/model/contact_kinematics.h>

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>

namespace signorini {
namespace {

using Rng = std::mt19937_64;

double uniform(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

Vec3 random_vector(Rng& rng, double size) {
  return {uniform(rng, -size, size), uniform(rng, -size, size), uniform(rng, -size, size)};
}

Vec3 random_direction(Rng& rng) {
  std::normal_distribution<double> normal;
  return Vec3(normal(rng), normal(rng), normal(rng)).normalized();
}

Mat3 exponential(const Vec3& turn) {
  const double angle = turn.norm();
  return angle == 0.0 ? Mat3::Identity()
                      : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

// A rigid motion with the given x, v, a, w, alpha at t = 0. The world frame is the body frame at
// t = 0, moved to x: a world point or direction at t = 0 is carried along.
struct RigidMotion {
  Vec3 x, v, a, w, alpha;

  // exp(w t + alpha t^2/2) has the angular velocity w + alpha t + O(t^2).
  [[nodiscard]] Vec3 direction(const Vec3& at_start, double t) const {
    return exponential(w * t + 0.5 * t * t * alpha) * at_start;
  }
  [[nodiscard]] Vec3 point(const Vec3& at_start, double t) const {
    return x + v * t + 0.5 * t * t * a + direction(at_start - x, t);
  }
  [[nodiscard]] BodyState state() const {
    BodyState state;
    state.x = x;
    return state;
  }
  [[nodiscard]] Velocity velocity() const { return {v, w}; }
  [[nodiscard]] Vec3 acceleration(const Vec3& at) const {
    const Vec3 r = at - x;
    return a + alpha.cross(r) + w.cross(w.cross(r));
  }
};

// Positions are within 1 m, speeds within 1 m/s and 1 rad/s and so on, unless a test says more.
RigidMotion random_motion(Rng& rng) {
  return {random_vector(rng, 1.0), random_vector(rng, 1.0), random_vector(rng, 1.0),
          random_vector(rng, 1.0), random_vector(rng, 1.0)};
}

// A contact, the motions of its bodies, and its gap and normal as functions of time.
struct Case {
  Contact contact{};
  RigidMotion motion_a{}, motion_b{};
  std::function<double(double)> gap{};
  std::function<Vec3(double)> normal{};
};

Contact contact_at(const Vec3& point_b, const Vec3& N, double gap, NormalOwner owner,
                   const LocalSurface& surface_a, const LocalSurface& surface_b) {
  Contact contact;
  contact.body_a = 0;
  contact.body_b = 1;
  contact.point_a = point_b + gap * N;
  contact.point_b = point_b;
  contact.normal = N;
  contact.gap = gap;
  contact.owner = owner;
  contact.surface_a = surface_a;
  contact.surface_b = surface_b;
  return contact;
}

// A's point (offset by radius along -N) over the face of B.
Case rounded_on_face_b(Rng& rng, double gap, double radius) {
  Case c{.motion_a = random_motion(rng), .motion_b = random_motion(rng)};
  const Vec3 N = random_direction(rng);
  const Vec3 foot = random_vector(rng, 1.0);
  const Vec3 centre = foot + (gap + radius) * N;
  c.contact = contact_at(foot, N, gap, NormalOwner::kFaceB, LocalSurface::sphere(radius),
                         LocalSurface::face());
  c.normal = [=, b = c.motion_b](double t) { return b.direction(N, t); };
  c.gap = [=, a = c.motion_a, b = c.motion_b](double t) {
    return b.direction(N, t).dot(a.point(centre, t) - b.point(foot, t)) - radius;
  };
  return c;
}

// The same with the roles exchanged: N is minus the outward normal of A's face.
Case rounded_on_face_a(Rng& rng, double gap, double radius) {
  Case c{.motion_a = random_motion(rng), .motion_b = random_motion(rng)};
  const Vec3 N = random_direction(rng);
  const Vec3 point_b = random_vector(rng, 1.0);
  const Vec3 foot = point_b + gap * N;
  const Vec3 centre = point_b - radius * N;
  c.contact = contact_at(point_b, N, gap, NormalOwner::kFaceA, LocalSurface::face(),
                         LocalSurface::sphere(radius));
  c.normal = [=, a = c.motion_a](double t) { return a.direction(N, t); };
  c.gap = [=, a = c.motion_a, b = c.motion_b](double t) {
    return a.direction(N, t).dot(a.point(foot, t) - b.point(centre, t)) - radius;
  };
  return c;
}

// Two balls; a vertex is a ball of radius 0. The centres stay N (radii + gap) apart, so that the
// signed distance is smooth whatever the sign of the gap.
Case round_on_round(Rng& rng, double gap, double radius_a, double radius_b) {
  Case c{.motion_a = random_motion(rng), .motion_b = random_motion(rng)};
  const Vec3 N = random_direction(rng);
  const Vec3 point_b = random_vector(rng, 1.0);
  const Vec3 centre_b = point_b - radius_b * N;
  const Vec3 centre_a = point_b + (gap + radius_a) * N;
  c.contact = contact_at(point_b, N, gap, NormalOwner::kCurved, LocalSurface::sphere(radius_a),
                         LocalSurface::sphere(radius_b));
  const auto between = [=, a = c.motion_a, b = c.motion_b](double t) -> Vec3 {
    return a.point(centre_a, t) - b.point(centre_b, t);
  };
  c.normal = [=](double t) -> Vec3 { return between(t).normalized(); };
  c.gap = [=](double t) { return between(t).norm() - radius_a - radius_b; };
  return c;
}

// A ball (or vertex) of A beside an edge of B; `exchange` makes the ball B's and the edge A's.
Case round_on_edge(Rng& rng, double gap, double radius, bool exchange) {
  Case c{.motion_a = random_motion(rng), .motion_b = random_motion(rng)};
  const RigidMotion ball = exchange ? c.motion_b : c.motion_a;
  const RigidMotion rail = exchange ? c.motion_a : c.motion_b;
  const Vec3 outward = random_direction(rng);  // from the edge to the ball
  const Vec3 e = outward.cross(random_direction(rng)).normalized();
  const Vec3 on_edge = random_vector(rng, 1.0);
  const Vec3 centre = on_edge + (gap + radius) * outward;
  const auto across = [=](double t) -> Vec3 {
    const Vec3 between = ball.point(centre, t) - rail.point(on_edge, t);
    const Vec3 direction = rail.direction(e, t);
    return between - between.dot(direction) * direction;
  };
  const double sign = exchange ? -1.0 : 1.0;
  const LocalSurface edge = LocalSurface::edge(e);
  const LocalSurface round = LocalSurface::sphere(radius);
  c.contact = exchange ? contact_at(on_edge + gap * outward, -outward, gap, NormalOwner::kCurved,
                                    edge, round)
                       : contact_at(on_edge, outward, gap, NormalOwner::kCurved, round, edge);
  c.normal = [=](double t) -> Vec3 { return sign * across(t).normalized(); };
  c.gap = [=](double t) { return across(t).norm() - radius; };
  return c;
}

Case edge_on_edge(Rng& rng, double gap) {
  Case c{.motion_a = random_motion(rng), .motion_b = random_motion(rng)};
  const Vec3 N = random_direction(rng);
  const Vec3 e_a = N.unitOrthogonal();
  const double angle = uniform(rng, 0.5, 2.6);  // rad between the edges
  const Vec3 e_b = Eigen::AngleAxisd(angle, N) * e_a;
  const Vec3 point_b = random_vector(rng, 1.0);
  const Vec3 point_a = point_b + gap * N;
  c.contact = contact_at(point_b, N, gap, NormalOwner::kEdgeEdge, LocalSurface::edge(e_a),
                         LocalSurface::edge(e_b));
  c.normal = [=, a = c.motion_a, b = c.motion_b](double t) -> Vec3 {
    return a.direction(e_a, t).cross(b.direction(e_b, t)).normalized();
  };
  c.gap = [=, normal = c.normal, a = c.motion_a, b = c.motion_b](double t) {
    return normal(t).dot(a.point(point_a, t) - b.point(point_b, t));
  };
  return c;
}

// Central differences of sixth order. With h = 0.005 s, rounding costs d'' some 10 eps |x|/h^2 =
// 1e-10 and truncation h^6/560 d^(8) = 3e-17 d^(8). The sharpest turn here is a relative speed u of
// up to 4 m/s past a centre r = 0.65 m away, where d^(8) is of the order 1000 u^8/r^7 = 1e9: 4e-8.
// The tolerance is 5 times that.
constexpr double kStep = 0.005;

template <typename Value>
Value first_difference(const std::function<Value(double)>& f) {
  const double h = kStep;
  return ((f(3 * h) - f(-3 * h)) / 60.0 - 3.0 * (f(2 * h) - f(-2 * h)) / 20.0 +
          3.0 * (f(h) - f(-h)) / 4.0) /
         h;
}

double second_difference(const std::function<double(double)>& f) {
  const double h = kStep;
  return ((f(3 * h) + f(-3 * h)) / 90.0 - 3.0 * (f(2 * h) + f(-2 * h)) / 20.0 +
          1.5 * (f(h) + f(-h)) - 49.0 / 18.0 * f(0.0)) /
         (h * h);
}

GapKinematics kinematics(const Case& c) {
  return gap_kinematics(c.contact, c.motion_a.state(), c.motion_a.velocity(), c.motion_b.state(),
                        c.motion_b.velocity());
}

double second_derivative(const Case& c, const GapKinematics& gap) {
  return c.contact.normal.dot(c.motion_a.acceleration(c.contact.point_a) -
                              c.motion_b.acceleration(c.contact.point_b)) +
         gap.curvature_acceleration;
}

struct FeaturePair {
  std::string name;
  std::function<Case(Rng&, double)> make;
  double least_gap;  // below this the true gap function of the pair is not smooth
};

class EveryFeaturePair : public testing::TestWithParam<FeaturePair> {};

TEST_P(EveryFeaturePair, AgreesWithFiniteDifferencesOfTheTrueGap) {
  constexpr double kTolerance = 2e-7;
  for (const double gap : {2.0, 0.3, 0.01, 0.0, -0.01, -0.05}) {
    if (gap < GetParam().least_gap) {
      continue;
    }
    for (unsigned seed = 0; seed < 100; ++seed) {
      SCOPED_TRACE("gap " + std::to_string(gap) + ", seed " + std::to_string(seed));
      Rng rng(seed);
      const Case c = GetParam().make(rng, gap);
      ASSERT_NEAR(c.gap(0.0), gap, 1e-14);
      ASSERT_LT((c.normal(0.0) - c.contact.normal).norm(), 1e-14);
      const GapKinematics computed = kinematics(c);
      EXPECT_FALSE(computed.degenerate);
      EXPECT_EQ(computed.d, gap);
      EXPECT_NEAR(computed.d_dot, first_difference<double>(c.gap), kTolerance);
      EXPECT_LT((computed.normal_dot - first_difference<Vec3>(c.normal)).norm(), kTolerance);
      EXPECT_NEAR(second_derivative(c, computed), second_difference(c.gap), kTolerance);
    }
  }
}

constexpr double kAnyGap = -std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    ContactKinematics, EveryFeaturePair,
    testing::Values(
        FeaturePair{"VertexOnFaceOfB",
                    [](Rng& rng, double gap) { return rounded_on_face_b(rng, gap, 0.0); }, kAnyGap},
        FeaturePair{"VertexOnFaceOfA",
                    [](Rng& rng, double gap) { return rounded_on_face_a(rng, gap, 0.0); }, kAnyGap},
        FeaturePair{"SphereOnFaceOfB",
                    [](Rng& rng, double gap) { return rounded_on_face_b(rng, gap, 0.7); }, kAnyGap},
        FeaturePair{"SphereOnFaceOfA",
                    [](Rng& rng, double gap) { return rounded_on_face_a(rng, gap, 0.7); }, kAnyGap},
        FeaturePair{"SphereOnSphere",
                    [](Rng& rng, double gap) { return round_on_round(rng, gap, 0.7, 0.4); },
                    kAnyGap},
        FeaturePair{"SphereOnVertex",
                    [](Rng& rng, double gap) { return round_on_round(rng, gap, 0.7, 0.0); },
                    kAnyGap},
        FeaturePair{"VertexOnSphere",
                    [](Rng& rng, double gap) { return round_on_round(rng, gap, 0.0, 0.7); },
                    kAnyGap},
        FeaturePair{"VertexOnVertex",
                    [](Rng& rng, double gap) { return round_on_round(rng, gap, 0.0, 0.0); }, 2.0},
        FeaturePair{"SphereOnEdge",
                    [](Rng& rng, double gap) { return round_on_edge(rng, gap, 0.7, false); },
                    kAnyGap},
        FeaturePair{"EdgeOnSphere",
                    [](Rng& rng, double gap) { return round_on_edge(rng, gap, 0.7, true); },
                    kAnyGap},
        FeaturePair{"VertexOnEdge",
                    [](Rng& rng, double gap) { return round_on_edge(rng, gap, 0.0, false); }, 2.0},
        FeaturePair{"EdgeOnEdge", edge_on_edge, kAnyGap}),
    [](const testing::TestParamInfo<FeaturePair>& pair) { return pair.param.name; });

TEST(ContactKinematics, FastRollingSphereHasTheAccelerationOfItsCentre) {
  constexpr double kRadius = 0.2;
  const Vec3 gravity(0.0, 0.0, -9.81);
  for (const double w : {1.0, 100.0, 1e4}) {
    const RigidMotion ball{Vec3(0, 0, kRadius), Vec3(w * kRadius, 0, 0), gravity, Vec3(0, w, 0),
                           Vec3::Zero()};
    const Contact contact = contact_at(Vec3::Zero(), Vec3::UnitZ(), 0.0, NormalOwner::kFaceB,
                                       LocalSurface::sphere(kRadius), LocalSurface::face());
    const GapKinematics gap =
        gap_kinematics(contact, ball.state(), ball.velocity(), BodyState{}, Velocity{});
    // N.a_A is -g + R w^2; two numbers of size R w^2 must cancel.
    const double d_ddot =
        contact.normal.dot(ball.acceleration(contact.point_a)) + gap.curvature_acceleration;
    EXPECT_NEAR(d_ddot, gravity.z(), 1e-15 * kRadius * w * w + 1e-14) << "w = " << w;
    EXPECT_EQ(gap.normal_dot, Vec3::Zero());
  }
}

TEST(ContactKinematics, VertexOnFaceIsTheTextbookFormula) {
  Rng rng(7);
  const Case c = rounded_on_face_b(rng, 0.25, 0.0);
  const GapKinematics gap = kinematics(c);
  const Vec3 u = c.motion_a.velocity().at(c.contact.point_a - c.motion_a.x) -
                 c.motion_b.velocity().at(c.contact.point_b - c.motion_b.x);
  const Vec3 n = c.motion_b.w.cross(c.contact.normal);
  EXPECT_NEAR(gap.curvature_acceleration, 2.0 * n.dot(u) - 0.25 * n.squaredNorm(), 1e-14);
}

TEST(ContactKinematics, ExchangingTheBodiesChangesNothing) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed);
    for (const Case& c : {rounded_on_face_b(rng, 0.1, 0.3), rounded_on_face_a(rng, -0.1, 0.0),
                          edge_on_edge(rng, 0.1), round_on_edge(rng, 0.1, 0.3, false)}) {
      Contact mirrored = c.contact;
      std::swap(mirrored.point_a, mirrored.point_b);
      std::swap(mirrored.surface_a, mirrored.surface_b);
      mirrored.normal = -c.contact.normal;
      if (c.contact.owner == NormalOwner::kFaceA) {
        mirrored.owner = NormalOwner::kFaceB;
      } else if (c.contact.owner == NormalOwner::kFaceB) {
        mirrored.owner = NormalOwner::kFaceA;
      }
      const GapKinematics one = kinematics(c);
      const GapKinematics other =
          gap_kinematics(mirrored, c.motion_b.state(), c.motion_b.velocity(), c.motion_a.state(),
                         c.motion_a.velocity());
      EXPECT_NEAR(one.d_dot, other.d_dot, 1e-14);
      EXPECT_LT((one.normal_dot + other.normal_dot).norm(), 1e-13);
      EXPECT_NEAR(one.curvature_acceleration, other.curvature_acceleration, 1e-12);
    }
  }
}

TEST(ContactKinematics, CurvedSolvesTheFaceToo) {
  // A face is a surface with two infinite radii: the general solve must agree with the face rule.
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed);
    for (Case c : {rounded_on_face_b(rng, 0.1, 0.3), rounded_on_face_a(rng, -0.1, 0.3),
                   rounded_on_face_b(rng, 0.0, 0.0)}) {
      const GapKinematics face = kinematics(c);
      c.contact.owner = NormalOwner::kCurved;
      const GapKinematics curved = kinematics(c);
      EXPECT_FALSE(curved.degenerate);
      EXPECT_LT((face.normal_dot - curved.normal_dot).norm(), 1e-13);
      EXPECT_NEAR(face.curvature_acceleration, curved.curvature_acceleration, 1e-12);
    }
  }
}

TEST(ContactKinematics, CylinderOnPlaneRollsLikeASphereAcrossItsAxis) {
  // Radii (infinity, R): flat along the axis, where the constraint n.t = n_A.t must agree with the
  // plane's, as it does when the cylinder rolls without tilting.
  constexpr double kRadius = 0.5;
  const RigidMotion roller{Vec3(0, 0, kRadius), Vec3(4.0, 0, 0), Vec3(0, 0, -9.81), Vec3(0, 8.0, 0),
                           Vec3::Zero()};
  Contact contact = contact_at(Vec3::Zero(), Vec3::UnitZ(), 0.0, NormalOwner::kFaceB, {}, {});
  contact.surface_a = {Vec3::UnitY(), std::numeric_limits<double>::infinity(), kRadius};
  contact.surface_b = LocalSurface::face();
  const GapKinematics gap =
      gap_kinematics(contact, roller.state(), roller.velocity(), BodyState{}, Velocity{});
  EXPECT_FALSE(gap.degenerate);
  EXPECT_NEAR(contact.normal.dot(roller.acceleration(contact.point_a)) + gap.curvature_acceleration,
              -9.81, 1e-12);
}

TEST(ContactKinematics, ParallelEdgesAreFlaggedAndFinite) {
  Rng rng(3);
  for (const double gap : {0.0, 0.2}) {
    Case c = edge_on_edge(rng, gap);
    c.contact.surface_b.direction = -c.contact.surface_a.direction;
    const GapKinematics k = kinematics(c);
    EXPECT_TRUE(k.degenerate);
    EXPECT_TRUE(k.normal_dot.allFinite());
    EXPECT_TRUE(std::isfinite(k.curvature_acceleration));
    // Along the common direction both edges turn the normal; neither is preferred.
    const Vec3 e = c.contact.surface_a.direction;
    const Vec3 mean = 0.5 * (c.motion_a.w + c.motion_b.w).cross(c.contact.normal);
    EXPECT_NEAR(k.normal_dot.dot(e), mean.dot(e), 1e-12);
  }
}

TEST(ContactKinematics, TouchingVerticesAreFlaggedAndDoNotTurnTheNormal) {
  Rng rng(3);
  const GapKinematics k = kinematics(round_on_round(rng, 0.0, 0.0, 0.0));
  EXPECT_TRUE(k.degenerate);
  EXPECT_EQ(k.normal_dot, Vec3::Zero());
  EXPECT_EQ(k.curvature_acceleration, 0.0);
}

TEST(ContactKinematics, AnEdgeAlongTheNormalIsFlagged) {
  Rng rng(3);
  Case c = round_on_edge(rng, 0.1, 0.3, false);
  c.contact.surface_b.direction = c.contact.normal;
  const GapKinematics k = kinematics(c);
  EXPECT_TRUE(k.degenerate);
  EXPECT_TRUE(k.normal_dot.allFinite());
}

TEST(ContactKinematics, AHugeRadiusActsAsAFace) {
  Rng rng(5);
  Case c = rounded_on_face_b(rng, 0.1, 0.3);
  const GapKinematics face = kinematics(c);
  c.contact.owner = NormalOwner::kCurved;
  c.contact.surface_b = LocalSurface::sphere(1e12);
  const GapKinematics huge = kinematics(c);
  EXPECT_FALSE(huge.degenerate);
  EXPECT_LT((face.normal_dot - huge.normal_dot).norm(), 1e-11);  // O(1/radius)
}

TEST(ContactKinematics, ClassifiesByTheSignWithAThreshold) {
  EXPECT_EQ(classify(-1e-300, 0.0), ContactClass::kColliding);
  EXPECT_EQ(classify(0.0, 0.0), ContactClass::kResting);
  EXPECT_EQ(classify(1e-300, 0.0), ContactClass::kSeparating);
  EXPECT_EQ(classify(-0.01, 0.01), ContactClass::kResting);
  EXPECT_EQ(classify(0.01, 0.01), ContactClass::kResting);
  EXPECT_EQ(classify(-0.0101, 0.01), ContactClass::kColliding);
  EXPECT_EQ(classify(0.0101, 0.01), ContactClass::kSeparating);
}

}  // namespace
}  // namespace signorini
