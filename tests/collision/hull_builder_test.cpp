#include <signorini/collision/hull.h>
#include <signorini/collision/hull_builder.h>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <stdexcept>

namespace signorini::collision {
namespace {

TEST(HullOfPoints, CubeHasSixFacesAndDropsWhatIsInside) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 4; ++i) {
    for (int j = 0; j <= 4; ++j) {
      for (int k = 0; k <= 4; ++k) points.emplace_back(0.25 * i, 0.25 * j, 0.25 * k);
    }
  }
  const ConvexHull hull = hull_of_points(points);
  EXPECT_EQ(hull.data->vertices.size(), 8u);
  EXPECT_EQ(hull.data->faces.size(), 6u);
  EXPECT_EQ(hull.data->edges.size(), 12u);
  EXPECT_NEAR(hull.data->volume, 1.0, 1e-14);
  EXPECT_NEAR((hull.data->centre - Vec3::Constant(0.5)).norm(), 0.0, 1e-14);
}

TEST(HullOfPoints, HoldsAllPointsAndIsNoLargerThanTheyAre) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (const double size : {1e-3, 1.0, 1e3}) {
    for (int n : {4, 5, 20, 300}) {
      std::vector<Vec3> points;
      for (int i = 0; i < n; ++i) {
        points.push_back(size * Vec3(normal(random), normal(random), normal(random)));
      }
      const ConvexHull hull = hull_of_points(points);
      const HullData& data = *hull.data;
      for (std::size_t f = 0; f < data.faces.size(); ++f) {
        double most = -std::numeric_limits<double>::infinity();
        for (const Vec3& point : points) most = std::max(most, data.normals[f].dot(point));
        EXPECT_NEAR(most, data.offsets[f], 1e-9 * size);
      }
      // Euler's formula: the faces close the surface.
      EXPECT_EQ(data.vertices.size() + data.faces.size(), data.edges.size() + 2);
    }
  }
}

TEST(HullOfPoints, RefusesWhatHasNoVolume) {
  EXPECT_THROW((void)hull_of_points({}), std::invalid_argument);
  EXPECT_THROW((void)hull_of_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), std::invalid_argument);
  EXPECT_THROW((void)hull_of_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 3, 0}}),
               std::invalid_argument);
  EXPECT_THROW((void)hull_of_points(std::vector<Vec3>(9, Vec3::Ones())), std::invalid_argument);
  EXPECT_THROW((void)hull_of_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace signorini::collision
