#include <signorini/lcp/friction_cone.h>

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace signorini::lcp {
namespace {

using Point = std::array<double, 3>;

double dot(int d, const Point& a, const Point& b) {
  double sum = 0.0;
  for (int k = 0; k < d; ++k) sum += a[k] * b[k];
  return sum;
}

Point projected(double mu, int d, const Point& x) {
  Point p{};
  project_on_cone(mu, d, x.data(), p.data());
  return p;
}

TEST(FrictionCone, KeepsItsOwnPointsAndSendsThePolarConeToZero) {
  EXPECT_EQ(projected(0.5, 3, {2, 0.6, -0.8}), (Point{2, 0.6, -0.8}));
  EXPECT_EQ(projected(0.5, 2, {-1, 1.9, 0}), (Point{0, 0, 0}));
  EXPECT_EQ(projected(0.0, 3, {3, 4, 5}), (Point{3, 0, 0}));
  EXPECT_EQ(projected(0.0, 3, {-3, 4, 5}), (Point{0, 0, 0}));
  EXPECT_EQ(projected(0.0, 3, {-3, 0, 0}), (Point{0, 0, 0}));
  EXPECT_EQ(projected(1e-200, 3, {-1e-200, 0, 0}), (Point{0, 0, 0}));
}

// Moreau: x = p + m with p in K, m in the polar cone, p.m = 0.
TEST(FrictionCone, ProjectionIsMoreausDecomposition) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 2000; ++trial) {
    const int d = 2 + trial % 2;
    const double mu = trial % 7 == 0 ? 0.0 : std::exp(2.0 * normal(random));
    const double unit = std::pow(10.0, trial % 5 == 0 ? 150 : (trial % 5 == 1 ? -150 : 0));
    Point x{};
    for (int k = 0; k < d; ++k) x[k] = unit * normal(random);
    const Point p = projected(mu, d, x);
    Point minus{};
    for (int k = 0; k < d; ++k) minus[k] = p[k] - x[k];
    const double size = std::sqrt(dot(d, {x[0] / unit, x[1] / unit, x[2] / unit},
                                      {x[0] / unit, x[1] / unit, x[2] / unit})) *
                        unit;
    EXPECT_LE(cone_violation(mu, d, p.data()), 1e-15 * (1 + mu) * size);
    // -m in the dual cone {w_N >= mu |w_T|}
    EXPECT_GE(minus[0] - mu * tangential_norm(d, minus.data()), -1e-15 * (1 + mu * mu) * size);
    Point unit_p{};
    Point unit_m{};
    for (int k = 0; k < d; ++k) {
      unit_p[k] = p[k] / size;
      unit_m[k] = minus[k] / size;
    }
    EXPECT_NEAR(dot(d, unit_p, unit_m), 0.0, 1e-15);
  }
}

TEST(FrictionCone, ViolationIsZeroInsideAndADistanceOutside) {
  const Point inside{1, 0.3, 0.4};
  const Point outside{1, 3, 4};
  const Point below{-2, 0, 0};
  EXPECT_EQ(cone_violation(0.5, 3, inside.data()), 0.0);
  EXPECT_EQ(cone_violation(0.5, 3, outside.data()), 4.5);
  EXPECT_EQ(cone_violation(0.5, 3, below.data()), 2.0);
}

}  // namespace
}  // namespace signorini::lcp
