#include <signorini/core/model/unconstrained_motion.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/resting.h>

#include "response_scenes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

namespace signorini {
namespace {

using scenes::Scene;

constexpr double kG = 9.81;
const Vec3 kGravity(0, 0, -kG);

RestingReport rest(const Scene& scene, const Vec3& gravity = kGravity,
                   const std::vector<Wrench>& driven = {}) {
  RestingReport report;
  resting_forces(scene.bodies, scene.state, scene.contacts, gravity_loads(scene.bodies, gravity),
                 driven, {}, report);
  return report;
}

/// A ball of radius 0.5 that touches the ground and rolls along x with speed v.
Scene rolling_ball(double v) {
  const double radius = 0.5;
  Scene scene;
  scene.add(scenes::ball(2.0, radius), Vec3(0, 0, radius), {Vec3(v, 0, 0), Vec3(0, v / radius, 0)});
  scene.add(scenes::fixed_body(), Vec3::Zero());
  Contact& contact = scene.touch(0, 1, Vec3::Zero(), Vec3::UnitZ(), 0.0);
  contact.owner = NormalOwner::kFaceB;
  contact.surface_a = LocalSurface::sphere(radius);
  contact.surface_b = LocalSurface::face();
  return scene;
}

Scene resting_box() {
  Scene scene = scenes::box_on_ground(3.0, Vec3(0.8, 0.5, 0.4), 0.4, Vec3::Zero(), 0.0);
  for (Contact& contact : scene.contacts) {
    contact.owner = NormalOwner::kFaceB;
    contact.surface_a = LocalSurface::vertex();
    contact.surface_b = LocalSurface::face();
  }
  return scene;
}

// ---- the closed forms

TEST(RestingForces, ABallThatRollsFastHasBMinusG) {
  for (const double v : {0.0, 1.0, 100.0}) {
    const RestingReport report = rest(rolling_ball(v));
    EXPECT_TRUE(lcp::is_solved(report.status));
    EXPECT_NEAR(report.b[0], -kG, 1e-15 * (kG + v * v / 0.5) * 4);  // R w^2 comes and goes
    EXPECT_NEAR(report.forces[0], 2.0 * kG, 1e-11);
    EXPECT_NEAR(report.d_ddot[0], 0.0, 1e-12);
    EXPECT_EQ(report.redundancy, 0);
  }
}

TEST(RestingForces, ABoxOnAPlaneWeighsWhatItWeighs) {
  const RestingReport report = rest(resting_box());
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_NEAR(report.forces.sum(), 3.0 * kG, 1e-12 * 3.0 * kG);
  EXPECT_EQ(report.redundancy, 1);
  EXPECT_TRUE(lcp::is_solved(report.least_norm_status));
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(report.forces[i], 0.75 * kG, 1e-12 * kG);  // least norm: a quarter each
  }
  EXPECT_LE(report.d_ddot.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NE(report.detail.find("statically indeterminate"), std::string::npos);
}

TEST(RestingForces, DoNotDependOnTheOrderOfTheContacts) {
  Scene scene = resting_box();
  scene.contacts.push_back(Contact(scene.contacts[0]));
  scene.contacts[4].point_a = scene.contacts[4].point_b =
      0.7 * scene.contacts[0].point_a + 0.3 * scene.contacts[2].point_a;
  std::vector<Wrench> loads = gravity_loads(scene.bodies, kGravity);
  // Weight shifted nearly above an edge: the least norm without g >= 0 would pull somewhere.
  loads[0].torque = (scene.contacts[0].point_a - scene.state[0].x).cross(0.9 * loads[0].force);
  const ContactSet given = scene.contacts;
  std::vector<int> order{0, 1, 2, 3, 4};
  lcp::Vector reference;
  do {
    for (int i = 0; i < 5; ++i) {
      scene.contacts[i] = given[order[i]];
    }
    RestingReport report;
    resting_forces(scene.bodies, scene.state, scene.contacts, loads, {}, {}, report);
    ASSERT_TRUE(lcp::is_solved(report.status));
    EXPECT_EQ(report.redundancy, 2);
    EXPECT_GE(report.forces.minCoeff(), 0.0);
    lcp::Vector forces(5);
    for (int i = 0; i < 5; ++i) {
      forces[order[i]] = report.forces[i];
    }
    if (reference.size() == 0) {
      reference = forces;
    }
    EXPECT_LE((forces - reference).cwiseAbs().maxCoeff(), 1e-11);
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(reference.minCoeff(), 0.0);  // g >= 0 was needed
}

TEST(RestingForces, LeastNormIsNotBeatenByAnyOtherSolution) {
  Scene scene = resting_box();
  std::vector<Wrench> loads = gravity_loads(scene.bodies, kGravity);
  loads[0].torque = Vec3(1.5, -2.0, 0.0);
  RestingReport report;
  resting_forces(scene.bodies, scene.state, scene.contacts, loads, {}, {}, report);
  ASSERT_TRUE(lcp::is_solved(report.status));
  // The null space of four corners around a face is (1, -1, 1, -1).
  const Eigen::Vector4d null(1, -1, 1, -1);
  NormalRows rows;
  assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
  lcp::Vector A_null(4);
  rows.A.multiply(null.data(), A_null.data());
  ASSERT_LE(A_null.norm(), 1e-14);
  for (const double step : {-0.1, -0.001, 0.001, 0.1}) {
    const lcp::Vector other = report.forces + step * null;
    if (other.minCoeff() >= 0.0) {
      EXPECT_GT(other.norm(), report.forces.norm());
    }
  }
}

TEST(RestingForces, LetGoWhereTheLoadLifts) {
  Scene scene = resting_box();
  std::vector<Wrench> loads = gravity_loads(scene.bodies, kGravity);
  loads[0].force.z() = 5.0;
  RestingReport report;
  resting_forces(scene.bodies, scene.state, scene.contacts, loads, {}, {}, report);
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_EQ(report.forces.norm(), 0.0);
  EXPECT_LE((report.d_ddot - report.b).norm(), 0.0);
  EXPECT_GT(report.d_ddot.minCoeff(), 0.0);
}

TEST(RestingForces, TipOverTheEdgeThatIsLoaded) {
  // Torque so large that two corners lift: forces there are zero, g d'' = 0 at every contact.
  Scene scene = resting_box();
  std::vector<Wrench> loads = gravity_loads(scene.bodies, kGravity);
  loads[0].torque = scene.state[0].q * Vec3(0, 20.0, 0);
  RestingReport report;
  resting_forces(scene.bodies, scene.state, scene.contacts, loads, {}, {}, report);
  ASSERT_TRUE(lcp::is_solved(report.status));
  EXPECT_EQ((report.forces.array() == 0.0).count(), 2);
  EXPECT_EQ((report.d_ddot.array() > 1.0).count(), 2);
  EXPECT_LE(report.forces.cwiseProduct(report.d_ddot).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(RestingForces, OnALiftCarryItsAcceleration) {
  Scene scene = resting_box();
  scene.bodies[1].kind = BodyKind::kKinematic;
  std::vector<Wrench> driven(2);
  driven[1].force = Vec3(0, 0, 2.0);
  const RestingReport rising = rest(scene, kGravity, driven);
  EXPECT_NEAR(rising.forces.sum(), 3.0 * (kG + 2.0), 1e-11);
  const RestingReport uniform = rest(scene);
  EXPECT_NEAR(uniform.forces.sum(), 3.0 * kG, 1e-11);
  driven[1].force.z() = -kG - 1.0;
  EXPECT_EQ(rest(scene, kGravity, driven).forces.norm(), 0.0);
}

TEST(RestingForces, OnATurntablePushInwards) {
  // A ball on a turntable against its rim, turning with it: the rim gives m w^2 r.
  const double w = 3.0;
  const double r = 2.0;
  const double radius = 0.5;
  Scene scene;
  scene.add(scenes::ball(2.0, radius), Vec3(r, 0, radius), {Vec3(0, w * r, 0), Vec3(0, 0, w)});
  scene.add(scenes::kinematic_body(), Vec3::Zero(), {Vec3::Zero(), Vec3(0, 0, w)});
  Contact& floor = scene.touch(0, 1, Vec3(r, 0, 0), Vec3::UnitZ(), 0.0);
  floor.surface_a = LocalSurface::sphere(radius);
  floor.surface_b = LocalSurface::face();
  Contact& rim = scene.touch(0, 1, Vec3(r + radius, 0, radius), -Vec3::UnitX(), 0.0);
  rim.surface_a = LocalSurface::sphere(radius);
  rim.surface_b = LocalSurface::face();
  const RestingReport report = rest(scene);
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_NEAR(report.forces[0], 2.0 * kG, 1e-11);
  EXPECT_NEAR(report.forces[1], 2.0 * w * w * r, 1e-11);
}

TEST(RestingForces, AStackCarriesWhatIsAbove) {
  Scene scene;
  const int ground = scene.add(scenes::fixed_body(), Vec3::Zero());
  for (int i = 0; i < 5; ++i) {
    const int brick = scene.add(scenes::box(1.0 + i, Vec3(1, 1, 1)), Vec3(0, 0, 0.5 + i));
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
      Contact& contact =
          scene.touch(brick, i == 0 ? ground : brick - 1, Vec3(x, y, i), Vec3::UnitZ(), 0.0);
      contact.surface_b = LocalSurface::face();
    }
  }
  const RestingReport report = rest(scene);
  ASSERT_TRUE(lcp::is_solved(report.status));
  EXPECT_EQ(report.redundancy, 5);
  double above = 15.0 * kG;
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(report.forces[4 * i + k], above / 4.0, 1e-10);
    }
    above -= (1.0 + i) * kG;
  }
}

TEST(RestingForces, NoContactsNoForces) {
  Scene scene;
  scene.add(scenes::ball(), Vec3::Zero());
  const RestingReport report = rest(scene);
  EXPECT_EQ(report.status, lcp::Status::kSolved);
  EXPECT_EQ(report.forces.size(), 0);
}

TEST(RestingForces, FeaturesThatDoNotDetermineTheNormalAreNamed) {
  Scene scene = rolling_ball(1.0);
  scene.contacts[0].owner = NormalOwner::kCurved;
  scene.contacts[0].surface_a = LocalSurface::vertex();
  scene.contacts[0].surface_b = LocalSurface::vertex();
  const RestingReport report = rest(scene);
  EXPECT_EQ(report.degenerate_contacts, std::vector<int>{0});
  EXPECT_NE(report.detail.find("contact 0"), std::string::npos);
}

// ---- b against finite differences of the gap along the motion without contact forces

using Gap = std::function<double(const State&)>;

/// The poses after `time` seconds, which may be negative: the equations of motion with constant
/// loads are the same backwards with v and w reversed.
State moved(const Scene& scene, const std::vector<Wrench>& loads, double time) {
  constexpr int kSteps = 8;  // RK4: error (time / steps)^5, far below what is asked
  State state = scene.state;
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (time < 0.0) {
      state[k].p = -state[k].p;
      state[k].L = -state[k].L;
    }
    for (int i = 0; i < kSteps; ++i) {
      integrate_free(scene.bodies[k], loads[k].force, loads[k].torque, std::abs(time) / kSteps,
                     Integrator::kRungeKutta4, state[k]);
    }
  }
  return state;
}

/// d'' by central differences of sixth order, and d at the start, which must be the contact's gap.
void expect_b_is_the_second_derivative(const Scene& scene, const Gap& gap) {
  std::vector<Wrench> loads = gravity_loads(scene.bodies, kGravity);
  loads[0].torque = Vec3(0.3, -0.2, 0.5);
  RestingReport report;
  resting_forces(scene.bodies, scene.state, scene.contacts, loads, {}, {}, report);
  ASSERT_NEAR(gap(scene.state), scene.contacts[0].gap, 1e-14);
  const double h = 2e-3;
  std::array<double, 7> d;
  for (int i = -3; i <= 3; ++i) {
    d[i + 3] = gap(moved(scene, loads, i * h));
  }
  const double first = (45.0 * (d[4] - d[2]) - 9.0 * (d[5] - d[1]) + (d[6] - d[0])) / (60.0 * h);
  const double second =
      (270.0 * (d[4] + d[2]) - 27.0 * (d[5] + d[1]) + 2.0 * (d[6] + d[0]) - 490.0 * d[3]) /
      (180.0 * h * h);
  // Truncation h^6 D / 560, D the eighth derivative: 15^8 for the fastest gap here (edges at a
  // small angle), 3e-10. Rounding: 1100 eps / (180 h^2) of coordinates of some metres, 1e-9.
  EXPECT_NEAR(gap_velocity(scene.bodies, scene.state, scene.contacts[0]), first, 1e-8);
  EXPECT_NEAR(report.b[0], second, 1e-8 * (1.0 + std::abs(second)));
}

/// Two bodies in any motion, a box (dynamic) and another (dynamic or kinematic).
Scene two_moving_bodies(std::mt19937_64& random, BodyKind kind_of_b) {
  Scene scene;
  for (int i = 0; i < 2; ++i) {
    Body body = scenes::box(1.5, Vec3(0.9, 0.5, 0.3));
    if (i == 1) {
      body.kind = kind_of_b;
    }
    scene.add(body, scenes::random_vector(random));
    const Vec3 axis = scenes::random_vector(random).normalized();
    scene.state.back().q = Quat(Eigen::AngleAxisd(1.0 + i, axis));
    set_velocity(body, {scenes::random_vector(random), 1.5 * scenes::random_vector(random)},
                 scene.state.back());
  }
  return scene;
}

/// A point fixed in a body, in its axes.
Vec3 local(const BodyState& state, const Vec3& point) {
  return state.pose().inverse() * point;
}

class RestingGap : public testing::TestWithParam<int> {
 protected:
  std::mt19937_64 random_{static_cast<std::uint64_t>(GetParam())};
  Scene scene_ =
      two_moving_bodies(random_, GetParam() % 2 == 0 ? BodyKind::kDynamic : BodyKind::kKinematic);
};

INSTANTIATE_TEST_SUITE_P(RandomMotions, RestingGap, testing::Range(1, 9));

TEST_P(RestingGap, VertexOfAOnAFaceOfB) {
  const Vec3 point = scene_.state[0].x + 0.5 * scenes::random_vector(random_);
  const Vec3 normal = scenes::random_vector(random_).normalized();
  Contact& contact = scene_.touch(0, 1, point, normal, 0.0);
  contact.owner = NormalOwner::kFaceB;
  contact.surface_a = LocalSurface::vertex();
  contact.surface_b = LocalSurface::face();
  const Vec3 vertex = local(scene_.state[0], point);
  const Vec3 on_face = local(scene_.state[1], point);
  const Vec3 n = scene_.state[1].q.conjugate() * normal;
  expect_b_is_the_second_derivative(scene_, [=](const State& state) {
    return (state[1].q * n).dot(state[0].pose() * vertex - state[1].pose() * on_face);
  });
}

TEST_P(RestingGap, VertexOfBOnAFaceOfA) {
  const Vec3 point = scene_.state[1].x + 0.5 * scenes::random_vector(random_);
  const Vec3 normal = scenes::random_vector(random_).normalized();
  Contact& contact = scene_.touch(0, 1, point, normal, 0.0);
  contact.owner = NormalOwner::kFaceA;
  contact.surface_a = LocalSurface::face();
  contact.surface_b = LocalSurface::vertex();
  const Vec3 vertex = local(scene_.state[1], point);
  const Vec3 on_face = local(scene_.state[0], point);
  const Vec3 n = scene_.state[0].q.conjugate() * normal;
  expect_b_is_the_second_derivative(scene_, [=](const State& state) {
    return (state[0].q * n).dot(state[0].pose() * on_face - state[1].pose() * vertex);
  });
}

TEST_P(RestingGap, SphereOfAOnAFaceOfB) {
  const double radius = 0.4;
  const Vec3 centre = scene_.state[0].x + 0.3 * scenes::random_vector(random_);  // off the mass
  const Vec3 normal = scenes::random_vector(random_).normalized();
  Contact& contact = scene_.touch(0, 1, centre - radius * normal, normal, 0.0);
  contact.owner = NormalOwner::kFaceB;
  contact.surface_a = LocalSurface::sphere(radius);
  contact.surface_b = LocalSurface::face();
  const Vec3 in_a = local(scene_.state[0], centre);
  const Vec3 on_face = local(scene_.state[1], contact.point_b);
  const Vec3 n = scene_.state[1].q.conjugate() * normal;
  expect_b_is_the_second_derivative(scene_, [=](const State& state) {
    return (state[1].q * n).dot(state[0].pose() * in_a - state[1].pose() * on_face) - radius;
  });
}

TEST_P(RestingGap, SphereOnSphere) {
  const double radius_a = 0.4;
  const double radius_b = 0.9;
  const Vec3 normal = scenes::random_vector(random_).normalized();
  const Vec3 centre_a = scene_.state[0].x + 0.1 * scenes::random_vector(random_);
  const Vec3 point = centre_a - radius_a * normal;
  const Vec3 centre_b = point - radius_b * normal;
  Contact& contact = scene_.touch(0, 1, point, normal, 0.0);
  contact.owner = NormalOwner::kCurved;
  contact.surface_a = LocalSurface::sphere(radius_a);
  contact.surface_b = LocalSurface::sphere(radius_b);
  const Vec3 in_a = local(scene_.state[0], centre_a);
  const Vec3 in_b = local(scene_.state[1], centre_b);
  expect_b_is_the_second_derivative(scene_, [=](const State& state) {
    return (state[0].pose() * in_a - state[1].pose() * in_b).norm() - radius_a - radius_b;
  });
}

TEST_P(RestingGap, EdgeOnEdge) {
  const Vec3 point = scenes::random_vector(random_);
  const Vec3 along_a = scenes::random_vector(random_).normalized();
  const Vec3 along_b = scenes::random_vector(random_).normalized();
  ASSERT_GT(along_a.cross(along_b).norm(), 0.1);
  Contact& contact = scene_.touch(0, 1, point, along_a.cross(along_b).normalized(), 0.0);
  contact.owner = NormalOwner::kEdgeEdge;
  contact.surface_a = LocalSurface::edge(along_a);
  contact.surface_b = LocalSurface::edge(along_b);
  const Vec3 in_a = local(scene_.state[0], point);
  const Vec3 in_b = local(scene_.state[1], point);
  const Vec3 a = scene_.state[0].q.conjugate() * along_a;
  const Vec3 b = scene_.state[1].q.conjugate() * along_b;
  expect_b_is_the_second_derivative(scene_, [=](const State& state) {
    const Vec3 n = (state[0].q * a).cross(state[1].q * b).normalized();
    return n.dot(state[0].pose() * in_a - state[1].pose() * in_b);
  });
}

// ---- bad input

std::string refusal(const Scene& scene, const std::vector<Wrench>& loads,
                    const std::vector<Wrench>& driven = {}, const RestingSettings& settings = {}) {
  RestingReport report;
  report.detail = "untouched";
  try {
    resting_forces(scene.bodies, scene.state, scene.contacts, loads, driven, settings, report);
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(report.detail, "untouched");
    return error.what();
  }
  return "not refused";
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << text << "\" lacks \"" << part << "\"";
}

TEST(RestingInput, IsNamedWithValueAndBound) {
  const Scene good = rolling_ball(1.0);
  const std::vector<Wrench> loads = gravity_loads(good.bodies, kGravity);
  expect_contains(refusal(good, {}), "loads: must have one entry a body (2), got 0");
  expect_contains(refusal(good, loads, {Wrench{}}), "driven_acceleration: must have one entry");
  std::vector<Wrench> bad = loads;
  bad[1].torque.x() = std::numeric_limits<double>::infinity();
  expect_contains(refusal(good, bad), "loads: body 1: torque: must be finite, got (inf");
  expect_contains(refusal(good, loads, {}, {.solver = "oracle"}), "oracle");
  expect_contains(refusal(good, loads, {}, {.lcp = {.tolerance = -1.0}}), "tolerance");
  Scene scene = good;
  scene.bodies[0].mass = std::numeric_limits<double>::quiet_NaN();
  expect_contains(refusal(scene, loads), "mass");
  scene = good;
  scene.contacts[0].normal.setZero();
  expect_contains(refusal(scene, loads), "contact 0: normal");
  scene = good;
  scene.bodies[0].kind = BodyKind::kKinematic;
  expect_contains(refusal(scene, loads), "at least one must be dynamic");
}

TEST(GravityLoads, ScaleWithTheBodyAndLeaveOutWhatIsNotDynamic) {
  Bodies bodies{scenes::ball(2.0), scenes::fixed_body(), scenes::ball(3.0)};
  bodies[2].gravity_scale = 0.5;
  const std::vector<Wrench> loads = gravity_loads(bodies, kGravity);
  EXPECT_EQ(loads[0].force, Vec3(0, 0, -2.0 * kG));
  EXPECT_EQ(loads[1].force, Vec3::Zero());
  EXPECT_EQ(loads[2].force, Vec3(0, 0, -1.5 * kG));
  EXPECT_EQ(loads[0].torque, Vec3::Zero());
}

}  // namespace
}  // namespace signorini
