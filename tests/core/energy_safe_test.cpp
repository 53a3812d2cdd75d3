#include <signorini/core/response/energy_safe.h>
#include <signorini/core/response/impact_energy.h>
#include <signorini/core/response/newton_impulse.h>
#include <signorini/lcp/solver.h>

#include "response_scenes.h"

#include <gtest/gtest.h>

namespace signorini {
namespace {

using scenes::Scene;

double gain(const EnergyLine& line, double theta) {
  return line.plastic + line.slope * theta + 0.5 * line.curvature * theta * theta;
}

TEST(LargestTheta, IsTheRootWhereTheLineCrosses) {
  for (const EnergyLine& line :
       {EnergyLine{-1.0, 1.0, 4.0}, EnergyLine{-1.0, 0.0, 8.0}, EnergyLine{-1.0, 3.0, 0.0},
        EnergyLine{-1e-3, 1.0, 1e-9}, EnergyLine{-1e-9, 1e-3, 1e3}}) {
    const double theta = largest_theta(line);
    EXPECT_GT(theta, 0.0);
    EXPECT_LT(theta, 1.0);
    // Relative to the term that is largest: the root is good to some roundings.
    EXPECT_NEAR(gain(line, theta), 0.0, 1e-15 * -line.plastic * 4.0);
  }
}

TEST(LargestTheta, IsOneWhereTheWholeLineLoses) {
  EXPECT_EQ(largest_theta({-1.0, 0.5, 1.0}), 1.0);  // E(1) = 0
  EXPECT_EQ(largest_theta({-1.0, 0.0, 0.0}), 1.0);
  EXPECT_EQ(largest_theta({0.0, 0.0, 0.0}), 1.0);
  EXPECT_EQ(largest_theta({-1.0, -1e-17, 0.0}), 1.0);
}

TEST(LargestTheta, IsZeroWhereAnyStepGains) {
  EXPECT_EQ(largest_theta({0.0, 1.0, 0.0}), 0.0);
  EXPECT_EQ(largest_theta({0.0, 0.0, 1.0}), 0.0);
  EXPECT_EQ(largest_theta({1e-18, 1.0, 1.0}), 0.0);
}

TEST(LargestTheta, KeepsItsDigitsWhereTheTextbookRootCancels) {
  // (-slope + sqrt(slope^2 + 2 curvature c)) / curvature is 0 here in doubles.
  const EnergyLine line{-1e-20, 1.0, 1.0};
  EXPECT_NEAR(largest_theta(line), 1e-20, 1e-34);
}

TEST(EnergyLine, IsTheEnergyOfTheImpulsesAlongTheLine) {
  std::mt19937_64 random(6);
  const auto solver = lcp::make_solver("lemke", {.tolerance = 1e-12});
  int solved = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Scene scene = scenes::random_scene(random, 4, 8);
    NormalRows rows;
    assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
    lcp::Result plastic;
    lcp::Result newton;
    solver->solve(plastic_problem(rows), plastic);
    solver->solve(newton_problem(rows, scene.contacts, 0.0), newton);
    if (!lcp::is_solved(plastic.status) || !lcp::is_solved(newton.status)) {
      continue;
    }
    ++solved;
    const EnergyLine line = energy_line(rows, plastic.z, newton.z);
    const double size = std::abs(line.plastic) + std::abs(line.slope) + line.curvature;
    EXPECT_LE(line.plastic, 0.0);
    EXPECT_GE(line.slope, -1e-12 * size);
    for (const double theta : {0.0, 0.3, 1.0}) {
      const lcp::Vector f = plastic.z + theta * (newton.z - plastic.z);
      const ImpulseEnergy energy = impulse_energy(f, rows.d_dot, gap_velocities_after(rows, f));
      EXPECT_NEAR(energy.gain, gain(line, theta), 1e-11 * size);
    }
  }
  EXPECT_GT(solved, 15);
}

TEST(IsAdmissible, NeedsRepulsionAndNoApproach) {
  const Scene scene = scenes::wedge(1.0, 1.0);
  NormalRows rows;
  assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
  const Eigen::Matrix2d A = Eigen::MatrixXd(rows.A.form());
  const lcp::Vector stop = A.inverse() * -rows.d_dot;
  EXPECT_TRUE(is_admissible(rows, stop, 1e-12));
  EXPECT_TRUE(is_admissible(rows, 3.0 * stop, 1e-12));
  EXPECT_FALSE(is_admissible(rows, 0.999 * stop, 1e-12));
  EXPECT_FALSE(is_admissible(rows, lcp::Vector::Zero(2), 1e-12));
  EXPECT_FALSE(is_admissible(rows, lcp::Vector(Eigen::Vector2d(9.0, -1e-6)), 1e-12));
}

TEST(ImpulseEnergy, OfNoImpulsesIsZero) {
  const lcp::Vector none;
  EXPECT_EQ(impulse_energy(none, none, none).gain, 0.0);
  EXPECT_EQ(relative_energy_gain(0.0, 0.0, 0.0), 0.0);
  EXPECT_EQ(relative_energy_gain(1.0, 3.0, -1.0), 0.25);
}

}  // namespace
}  // namespace signorini
