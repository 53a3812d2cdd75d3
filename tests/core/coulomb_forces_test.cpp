#include <signorini/core/response/coulomb_forces.h>
#include <signorini/core/response/impact_without_collision.h>
#include <signorini/core/response/tangent_rows.h>

#include "response_scenes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace signorini {
namespace {

using scenes::Scene;

constexpr double kG = 9.81;

CoulombReport forces_of(const Scene& scene, const Vec3& gravity, const std::vector<bool>& slides,
                        const RestingSettings& settings = {}) {
  CoulombReport report;
  coulomb_forces(scene.bodies, scene.state, scene.contacts, slides,
                 gravity_loads(scene.bodies, gravity), {}, settings, report);
  return report;
}

/// v' and w' of a body under gravity and the forces.
BodyAcceleration motion_of(const Scene& scene, const Vec3& gravity, int body,
                           const std::vector<Vec3>& forces) {
  std::vector<Wrench> loads = gravity_loads(scene.bodies, gravity);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Contact& contact = scene.contacts[i];
    const double sign = contact.body_a == body ? 1.0 : contact.body_b == body ? -1.0 : 0.0;
    loads[body].force += sign * forces[i];
    loads[body].torque += (friction_point(contact) - scene.state[body].x).cross(sign * forces[i]);
  }
  return free_accelerations(scene.bodies, scene.state, loads, {})[body];
}

Vec3 on_slope(double tangent) {
  const double angle = std::atan(tangent);
  return kG * Vec3(std::sin(angle), 0.0, -std::cos(angle));
}

Scene rough_box(double mu, const Vec3& v) {
  Scene scene = scenes::box_on_ground(2.0, Vec3(1.0, 0.8, 0.3), 0.4, v, 0.0);
  for (Contact& contact : scene.contacts) {
    contact.owner = NormalOwner::kFaceB;
    contact.material.friction = mu;
  }
  return scene;
}

TEST(CoulombForces, ABoxOnASlopeSticksBelowItsFrictionAngleAndBeginsToSlideAboveIt) {
  for (const double tangent : {0.2, 0.499999, 0.500001, 0.9}) {
    const Scene scene = rough_box(0.5, Vec3::Zero());
    const Vec3 gravity = on_slope(tangent);
    const CoulombReport report = forces_of(scene, gravity, std::vector<bool>(4, false));
    ASSERT_TRUE(lcp::is_solved(report.status)) << report.result.detail;
    const BodyAcceleration a = motion_of(scene, gravity, 0, report.forces);
    const double pull = std::max(0.0, gravity.x() + 0.5 * gravity.z());
    EXPECT_NEAR((a.linear - pull * Vec3::UnitX()).norm(), 0.0, 1e-9) << tangent;
    EXPECT_NEAR(a.angular.norm(), 0.0, 1e-9);
    for (int i = 0; i < 4; ++i) {
      if (report.normal_forces[i] > 0.0) {
        EXPECT_EQ(report.modes[i], tangent < 0.5 ? ContactMode::kSticks : ContactMode::kSlides);
      }
    }
  }
}

TEST(CoulombForces, ABoxThatSlidesIsBrakedAgainstItsSlip) {
  for (const double heading : {0.0, 0.7, 2.9}) {
    const Vec3 e(std::cos(heading), std::sin(heading), 0.0);
    const Scene scene = rough_box(0.5, 3.0 * e);
    const CoulombReport report = forces_of(scene, Vec3(0, 0, -kG), std::vector<bool>(4, true));
    ASSERT_TRUE(lcp::is_solved(report.status)) << report.result.detail;
    EXPECT_NEAR((motion_of(scene, Vec3(0, 0, -kG), 0, report.forces).linear + 0.5 * kG * e).norm(),
                0.0, 1e-9);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(report.modes[i], ContactMode::kSlides);
      EXPECT_NEAR((report.directions[i] - e).norm(), 0.0, 1e-12);
    }
  }
}

/// A ball that touches the plane z = 0.
Scene rough_ball(double mu, const Velocity& motion) {
  Scene scene;
  const int ball = scene.add(scenes::ball(3.0, 0.5), Vec3(0, 0, 0.5), motion);
  const int ground = scene.add(scenes::fixed_body(), Vec3::Zero());
  Contact& contact = scene.touch(ball, ground, Vec3::Zero(), Vec3::UnitZ(), 0.0);
  contact.surface_a = LocalSurface::sphere(0.5);
  contact.surface_b = LocalSurface::face();
  contact.owner = NormalOwner::kFaceB;
  contact.material.friction = mu;
  return scene;
}

TEST(CoulombForces, ABallOnASlopeRollsUpToSevenHalvesOfMuAndSlidesBeyond) {
  for (const double tangent : {0.3, 0.69, 0.71, 1.5}) {
    const Scene scene = rough_ball(0.2, {});
    const Vec3 gravity = on_slope(tangent);
    const CoulombReport report = forces_of(scene, gravity, {false});
    ASSERT_TRUE(lcp::is_solved(report.status));
    const bool rolls = tangent < 3.5 * 0.2;
    EXPECT_EQ(report.modes[0], rolls ? ContactMode::kSticks : ContactMode::kSlides);
    const double a = rolls ? 5.0 / 7.0 * gravity.x() : gravity.x() + 0.2 * gravity.z();
    EXPECT_NEAR(motion_of(scene, gravity, 0, report.forces).linear.x(), a, 1e-10);
  }
}

TEST(CoulombForces, ABallThatRollsAndSpinsNeedsNoFriction) {
  // v = w x (r up): the point that touches does not move, and it wanders over the ball.
  const Vec3 w(1.0, 2.0, 30.0);
  const Scene scene = rough_ball(0.2, {w.cross(Vec3(0, 0, 0.5)), w});
  RestingSettings fine;
  fine.friction_lcp.tolerance = 1e-13;
  const CoulombReport report = forces_of(scene, Vec3(0, 0, -kG), {false}, fine);
  ASSERT_TRUE(lcp::is_solved(report.status));
  EXPECT_EQ(report.modes[0], ContactMode::kSticks);
  EXPECT_NEAR((report.forces[0] - Vec3(0, 0, 3.0 * kG)).norm(), 0.0, 1e-10);
  // As it comes: to 1e-10 of the accelerations.
  const CoulombReport plain = forces_of(scene, Vec3(0, 0, -kG), {false});
  ASSERT_TRUE(lcp::is_solved(plain.status));
  EXPECT_NEAR((plain.forces[0] - Vec3(0, 0, 3.0 * kG)).norm(), 0.0, 1e-10 * 3.0 * kG);
}

TEST(CoulombForces, AnAnisotropicContactSlidesByItsEllipse) {
  // F_k = -f mu_k^2 u_k / |(mu_1 u_1, mu_2 u_2)|.
  const Vec3 u(1.0, 2.0, 0.0);
  Scene scene = rough_ball(0.4, {u, Vec3::Zero()});
  scene.contacts[0].material.friction_ratio = 0.25;
  scene.contacts[0].friction_direction = Vec3::UnitX();
  const CoulombReport report = forces_of(scene, Vec3(0, 0, -kG), {true});
  ASSERT_TRUE(lcp::is_solved(report.status));
  const double size = std::hypot(0.4 * u.x(), 0.1 * u.y());
  const double f = 3.0 * kG;
  EXPECT_NEAR(report.forces[0].x(), -f * 0.16 * u.x() / size, 1e-10);
  EXPECT_NEAR(report.forces[0].y(), -f * 0.01 * u.y() / size, 1e-10);
  EXPECT_NEAR((report.directions[0] - u.normalized()).norm(), 0.0, 1e-12);
}

/// Painleve's rod: 2 m and 1 kg, slender, its lower end on the ground at `angle` from it, sliding
/// at speed v and turning at w about y.
Scene painleve_rod(double angle, double mu, double v, double w = 0.0) {
  const Vec3 r(-std::cos(angle), 0.0, -std::sin(angle));  // of the lower end
  Body rod;
  rod.mass = 1.0;
  rod.inertia = Vec3(1e-3, 1.0 / 3.0, 1.0 / 3.0).asDiagonal();  // along its x
  Scene scene;
  const Vec3 spin(0.0, w, 0.0);
  const int body = scene.add(rod, -r);
  scene.state[body].q = Quat(Eigen::AngleAxisd(-angle, Vec3::UnitY()));
  set_velocity(rod, {Vec3(v, 0.0, 0.0) - spin.cross(r), spin}, scene.state[body]);
  const int ground = scene.add(scenes::fixed_body(), Vec3::Zero());
  Contact& contact = scene.touch(body, ground, Vec3::Zero(), Vec3::UnitZ(), 0.0);
  contact.owner = NormalOwner::kFaceB;
  contact.material.friction = mu;
  return scene;
}

TEST(CoulombForces, PainlevesRodIsConsistentOrNotAsItsClosedFormSays) {
  // d'' = M f + b: M = 1 + 3 cos^2 + 3 s mu sin cos (1/kg) with s the sign of the slip, 1 towards
  // the centre's side, b = w^2 sin - g; M > 0 for all angles below mu = 4/3.
  int inconsistent = 0;
  for (const double angle : {0.3, std::atan(2.0), 1.3}) {
    for (const double mu : {0.5, 1.3, 1.4, 2.0}) {
      for (const double v : {-1.0, 1.0}) {
        for (const double w : {0.0, 5.0}) {
          const CoulombReport report =
              forces_of(painleve_rod(angle, mu, v, w), Vec3(0, 0, -kG), {true});
          const double M = 1.0 + 3.0 * std::pow(std::cos(angle), 2) +
                           3.0 * v * mu * std::sin(angle) * std::cos(angle);
          const double b = w * w * std::sin(angle) - kG;
          EXPECT_NEAR(report.b[0], b, 1e-12);
          if (M < 0.0 && b < 0.0) {
            ++inconsistent;
            EXPECT_EQ(report.status, lcp::Status::kInfeasible);
          } else {
            ASSERT_TRUE(lcp::is_solved(report.status));
            EXPECT_NEAR(report.normal_forces[0], b < 0.0 ? -b / M : 0.0, 1e-9 * kG);
            EXPECT_EQ(report.modes[0], b < 0.0 ? ContactMode::kSlides : ContactMode::kOpens);
          }
          if (mu < 4.0 / 3.0) {
            EXPECT_GT(M, 0.0);
          }
        }
      }
    }
  }
  EXPECT_EQ(inconsistent, 3);
}

TEST(ImpactWithoutCollision, EndsTheSlipOfPainlevesRod) {
  const double angle = std::atan(2.0);
  Scene scene = painleve_rod(angle, 1.6, -1.5);
  const CoulombReport report = forces_of(scene, Vec3(0, 0, -kG), {true});
  ASSERT_EQ(report.status, lcp::Status::kInfeasible);
  const double before = kinetic_energy(scene.bodies, scene.state);
  const ShockReport shock =
      impact_without_collision(scene.bodies, scene.contacts, report.b, {}, scene.state);
  ASSERT_TRUE(lcp::is_solved(shock.status)) << shock.result.detail;
  // z = -A^-1 u-, A = [[1 + 3 cos^2, -3 sin cos], [-3 sin cos, 1 + 3 sin^2]] over normal and
  // slip, its determinant 4.
  const double sine_cosine = std::sin(angle) * std::cos(angle);
  EXPECT_NEAR(shock.contact_impulses[0].z(), 1.5 * 3.0 * sine_cosine / 4.0, 1e-7);
  EXPECT_NEAR(shock.contact_impulses[0].x(), 1.5 * (1.0 + 3.0 * std::pow(std::cos(angle), 2)) / 4,
              1e-7);
  // What is left is h b, 1e-8 of the slip, along the normal.
  EXPECT_NEAR(slip_velocity(scene.bodies, scene.state, scene.contacts[0]).norm(), 1.5e-8, 1e-10);
  EXPECT_LT(shock.energy_change, 0.0);
  EXPECT_NEAR(kinetic_energy(scene.bodies, scene.state) - before, shock.energy_change, 1e-14);
}

TEST(ImpactWithoutCollision, TakesWhatRestsAsClosed) {
  Scene scene = painleve_rod(std::atan(2.0), 1.6, -1.5);
  scene.state[0].p.z() += 1e-5;  // opens at 1e-5 m/s: held by hysteresis
  const CoulombReport report = forces_of(scene, Vec3(0, 0, -kG), {true});
  ASSERT_EQ(report.status, lcp::Status::kInfeasible);
  const ShockReport shock =
      impact_without_collision(scene.bodies, scene.contacts, report.b, {}, scene.state);
  EXPECT_TRUE(lcp::is_solved(shock.status)) << shock.detail;
  EXPECT_NEAR(slip_velocity(scene.bodies, scene.state, scene.contacts[0]).norm(), 1e-5, 1e-7);
}

TEST(ImpactWithoutCollision, IsNoneWhereForcesExist) {
  Scene scene = painleve_rod(1.1, 0.5, 1.5);
  const State before = scene.state;
  const CoulombReport report = forces_of(scene, Vec3(0, 0, -kG), {true});
  const ShockReport shock =
      impact_without_collision(scene.bodies, scene.contacts, report.b, {}, scene.state);
  EXPECT_EQ(shock.status, lcp::Status::kStalled);
  EXPECT_NE(shock.detail.find("no impact"), std::string::npos);
  EXPECT_EQ(scene.state[0].p, before[0].p);
}

TEST(CoulombForces, BadInputIsNamed) {
  Scene scene = rough_box(0.5, Vec3(1, 0, 0));
  EXPECT_THROW(forces_of(scene, Vec3(0, 0, -kG), {true}), std::invalid_argument);
  EXPECT_THROW(forces_of(rough_box(0.5, Vec3::Zero()), Vec3::Zero(), std::vector<bool>(4, true)),
               std::invalid_argument);
  scene.contacts[2].material.rolling_friction = 0.1;
  EXPECT_THROW(forces_of(scene, Vec3(0, 0, -kG), std::vector<bool>(4, true)),
               std::invalid_argument);
}

}  // namespace
}  // namespace signorini
