#include <signorini/collision/segments.h>

#include "random_pairs.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

namespace signorini::collision {
namespace {

using testing::Random;
using testing::random_direction;
using testing::uniform;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Triangle random_triangle(Random& random) {
  Triangle triangle;
  for (Vec3& corner : triangle.corners) {
    corner = uniform(random, 0.3, 1.0) * random_direction(random);
  }
  const Vec3 area =
      (triangle.corners[1] - triangle.corners[0]).cross(triangle.corners[2] - triangle.corners[0]);
  triangle.normal = area.normalized();
  return triangle;
}

/// Free; parallel to the triangle; or a point.
LineSegment random_segment(Random& random, const Triangle& triangle, int number) {
  LineSegment segment{uniform(random, 0.0, 2.0) * random_direction(random),
                      random_direction(random), uniform(random, 0.1, 1.0)};
  if (number % 3 == 1) {
    segment.axis = triangle.edge_of(number % 9 / 3).axis;
  } else if (number % 3 == 2) {
    segment.half = 0.0;
  }
  return segment;
}

// Convex duality: the two points are the nearest ones if and only if a plane across what joins them
// has the segment on one side of the first and the triangle on the other side of the second.
TEST(Segments, PointsOfASegmentAndATriangleAreTheNearest) {
  Random random(11);
  int apart = 0;
  int meeting = 0;
  int inside = 0;
  for (int k = 0; k < 20000; ++k) {
    const Triangle triangle = random_triangle(random);
    const LineSegment segment = random_segment(random, triangle, k);
    SegmentOnTriangle nearest;
    ASSERT_TRUE(nearest_points(segment, triangle, kInfinity, nearest));
    ASSERT_LE(std::abs(nearest.s), segment.half);
    const Vec3 on_segment = segment.at(nearest.s);
    const Vec3 on_triangle = on_segment - nearest.between;
    if (nearest.edge >= 0) {
      const LineSegment edge = triangle.edge_of(nearest.edge);
      ASSERT_LE(std::abs(nearest.t), edge.half);
      ASSERT_LE((edge.at(nearest.t) - on_triangle).norm(), 1e-14);
    } else {
      ++inside;
      ASSERT_LE(std::abs(triangle.normal.dot(on_triangle - triangle.corners[0])), 1e-14);
      for (int side = 0; side < 3; ++side) {
        ASSERT_LE(triangle.outward_of(side).dot(on_triangle - triangle.corners[side]), 1e-14);
      }
    }
    const double distance = nearest.between.norm();
    if (distance < 1e-9) {
      ++meeting;
      continue;
    }
    ++apart;
    const Vec3 N = nearest.between / distance;
    const double rounding = 1e-14 + 1e-15 / distance;  // of N, which is the nearer the less certain
    for (const double end : {-segment.half, segment.half}) {
      ASSERT_GE(N.dot(segment.at(end) - on_segment), -rounding) << k;
    }
    for (const Vec3& corner : triangle.corners) {
      ASSERT_LE(N.dot(corner - on_triangle), rounding) << k;
    }
    // Further than `reach` may be said; nearer must not.
    SegmentOnTriangle within;
    ASSERT_TRUE(nearest_points(segment, triangle, distance * (1.0 + 1e-12), within)) << k;
    ASSERT_EQ(within.between, nearest.between);
  }
  EXPECT_GT(apart, 10000);
  EXPECT_GT(meeting, 300);
  EXPECT_GT(inside, 1500);
}

TEST(Segments, FarFromATriangleIsSaidWithoutASearch) {
  const Triangle triangle{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, Vec3::UnitZ()};
  SegmentOnTriangle nearest;
  EXPECT_FALSE(nearest_points({{0.2, 0.2, 0.5}, Vec3::UnitX(), 0.1}, triangle, 0.4, nearest));
  EXPECT_FALSE(nearest_points({{-0.5, 0.2, 0.0}, Vec3::UnitY(), 0.1}, triangle, 0.4, nearest));
  ASSERT_TRUE(nearest_points({{0.2, 0.2, 0.5}, Vec3::UnitX(), 0.1}, triangle, 0.6, nearest));
  EXPECT_EQ(nearest.edge, -1);
  EXPECT_EQ(nearest.between, Vec3(0, 0, 0.5));
}

}  // namespace
}  // namespace signorini::collision
