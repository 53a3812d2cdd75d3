#include <signorini/core/response/assembly.h>

#include "response_scenes.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace signorini {
namespace {

using scenes::Scene;

/// J of the definition, over the dynamic bodies in body order.
Eigen::MatrixXd reference_rows(const Scene& scene) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(scene.contacts.size(), 6 * scene.bodies.size());
  for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
    const Contact& c = scene.contacts[i];
    J.block<1, 3>(i, 6 * c.body_a) = c.normal.transpose();
    J.block<1, 3>(i, 6 * c.body_a + 3) =
        (c.point_a - scene.state[c.body_a].x).cross(c.normal).transpose();
    J.block<1, 3>(i, 6 * c.body_b) = -c.normal.transpose();
    J.block<1, 3>(i, 6 * c.body_b + 3) =
        -(c.point_b - scene.state[c.body_b].x).cross(c.normal).transpose();
  }
  return J;
}

Eigen::MatrixXd reference_inverse_mass(const Scene& scene) {
  const std::size_t n = scene.bodies.size();
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  for (std::size_t k = 0; k < n; ++k) {
    W.block<3, 3>(6 * k, 6 * k) = inverse_mass(scene.bodies[k]) * Mat3::Identity();
    W.block<3, 3>(6 * k + 3, 6 * k + 3) = inverse_inertia_world(scene.bodies[k], scene.state[k]);
  }
  return W;
}

Eigen::VectorXd reference_velocities(const Scene& scene) {
  Eigen::VectorXd u(6 * scene.bodies.size());
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    const Velocity motion = scene.velocity_of(static_cast<int>(k));
    u.segment<6>(6 * k) << motion.linear, motion.angular;
  }
  return u;
}

TEST(Assembly, RowsAreTheDefinitionWithDrivenVelocitiesInTheirRightHandSide) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Scene scene = scenes::random_scene(random, 4, 12);
    NormalRows rows;
    assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
    const Eigen::MatrixXd J = reference_rows(scene);
    const Eigen::MatrixXd A = J * reference_inverse_mass(scene) * J.transpose();
    const Eigen::VectorXd d_dot = J * reference_velocities(scene);
    // Some hundred operations on numbers of the size of the largest entry: 1e-13 of it.
    EXPECT_LE((Eigen::MatrixXd(rows.A.form()) - A).cwiseAbs().maxCoeff(),
              1e-13 * A.cwiseAbs().maxCoeff());
    EXPECT_LE((rows.d_dot - d_dot).cwiseAbs().maxCoeff(),
              1e-13 * (1 + d_dot.cwiseAbs().maxCoeff()));
  }
}

TEST(Assembly, OnlyDynamicBodiesThatTouchHaveABlock) {
  Scene scene;
  const int ground = scene.add(scenes::fixed_body(), Vec3::Zero());
  const int alone = scene.add(scenes::ball(), Vec3(9, 9, 9));
  const int rests = scene.add(scenes::ball(), Vec3(0, 0, 0.5));
  const int paddle = scene.add(scenes::kinematic_body(), Vec3(0, 0, 2));
  scene.touch(rests, ground, Vec3::Zero(), Vec3::UnitZ(), 0.0);
  NormalRows rows;
  assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
  EXPECT_EQ(rows.block_of_body[ground], -1);
  EXPECT_EQ(rows.block_of_body[alone], -1);
  EXPECT_EQ(rows.block_of_body[rests], 0);
  EXPECT_EQ(rows.block_of_body[paddle], -1);
  EXPECT_EQ(rows.A.degrees_of_freedom(), 6);
}

TEST(Assembly, ImpulsesChangeGapVelocitiesByAf) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    Scene scene = scenes::random_scene(random, 5, 15);
    NormalRows rows;
    assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
    const lcp::Vector f = lcp::Vector::NullaryExpr(
        15, [&] { return std::uniform_real_distribution<double>(0.0, 2.0)(random); });
    const State before = scene.state;
    apply_impulses(scene.bodies, scene.contacts, f, scene.state);
    const lcp::Vector after = gap_velocities(scene.bodies, scene.state, scene.contacts);
    const double scale = 1.0 + after.cwiseAbs().maxCoeff();
    EXPECT_LE((after - gap_velocities_after(rows, f)).cwiseAbs().maxCoeff(), 1e-12 * scale);
    for (int k : {5, 6}) {  // the fixed and the kinematic one
      EXPECT_EQ(scene.state[k].p, before[k].p);
      EXPECT_EQ(scene.state[k].L, before[k].L);
    }
  }
}

TEST(Assembly, InternalImpulsesKeepMomentumAndAngularMomentum) {
  std::mt19937_64 random(3);
  Scene scene = scenes::random_scene(random, 4, 0);
  for (int i = 0; i < 6; ++i) {
    scene.touch(i % 4, (i + 1) % 4, scenes::random_vector(random),
                scenes::random_vector(random).normalized(), 0.0);
  }
  const auto totals = [&] {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (int k = 0; k < 4; ++k) {
      const BodyState& s = scene.state[k];
      sum.head<3>() += s.p;
      sum.tail<3>() += s.L + s.x.cross(s.p);
    }
    return sum;
  };
  const Eigen::Matrix<double, 6, 1> before = totals();
  apply_impulses(scene.bodies, scene.contacts, lcp::Vector::LinSpaced(6, 1.0, 3.0), scene.state);
  EXPECT_LE((totals() - before).cwiseAbs().maxCoeff(), 1e-13 * (1 + before.cwiseAbs().maxCoeff()));
}

TEST(Assembly, TwoBodiesThatCannotMoveAreRefusedByNumber) {
  Scene scene;
  const int ground = scene.add(scenes::fixed_body(), Vec3::Zero());
  const int paddle = scene.add(scenes::kinematic_body(), Vec3::Zero());
  const int mass = scene.add(scenes::ball(), Vec3::Zero());
  scene.touch(mass, ground, Vec3::Zero(), Vec3::UnitZ(), 0.0);
  NormalRows rows;
  assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
  scene.touch(paddle, ground, Vec3::Zero(), Vec3::UnitZ(), 0.0);
  try {
    assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("contact 1"), std::string::npos) << error.what();
  }
  EXPECT_EQ(rows.A.rows(), 1);  // untouched
}

TEST(ConnectedSets, ShareADynamicBodyAndAreNumberedByFirstContact) {
  Scene scene;
  const int ground = scene.add(scenes::fixed_body(), Vec3::Zero());
  for (int i = 0; i < 5; ++i) {
    scene.add(scenes::ball(), Vec3(i, 0, 0));
  }
  for (const auto& [a, b] : {std::pair{5, ground}, {1, ground}, {3, 2}, {ground, 2}, {1, 4}}) {
    scene.touch(a, b, Vec3::Zero(), Vec3::UnitZ(), 0.0);
  }
  EXPECT_EQ(connected_sets(scene.bodies, scene.contacts), (std::vector<int>{0, 1, 2, 2, 1}));
  scene.touch(3, 5, Vec3::Zero(), Vec3::UnitZ(), 0.0);
  EXPECT_EQ(connected_sets(scene.bodies, scene.contacts), (std::vector<int>{0, 1, 0, 0, 1, 0}));
}

TEST(ConnectedSets, NoContactsNoSets) {
  EXPECT_TRUE(connected_sets({scenes::ball()}, {}).empty());
  NormalRows rows;
  assemble_normals({scenes::ball()}, State(1), {}, rows);
  EXPECT_EQ(rows.A.rows(), 0);
  EXPECT_EQ(rows.d_dot.size(), 0);
}

}  // namespace
}  // namespace signorini
