#include <signorini/collision/shape.h>

#include "random_pairs.h"

#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

namespace signorini::collision {
namespace {

using testing::Random;

TEST(MassProperties, MatchClosedForms) {
  const MassProperties ball = mass_properties(Sphere{0.5}, 1000.0);
  EXPECT_NEAR(ball.mass, 1000.0 * M_PI / 6.0, 1e-10);
  EXPECT_NEAR((ball.inertia - Mat3::Identity() * 0.1 * ball.mass).norm(), 0.0, 1e-12);
  const MassProperties brick = mass_properties(Box{{0.5, 1.0, 1.5}}, 2.0);
  EXPECT_DOUBLE_EQ(brick.mass, 12.0);
  EXPECT_NEAR((brick.inertia - Mat3(Vec3(13.0, 10.0, 5.0).asDiagonal())).norm(), 0.0, 1e-14);
}

TEST(MassProperties, AreRefusedForHalfSpacesAndBadDensities) {
  EXPECT_THROW((void)mass_properties(HalfSpace{}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)mass_properties(Sphere{1.0}, 0.0), std::invalid_argument);
  EXPECT_THROW((void)mass_properties(Sphere{1.0}, std::nan("")), std::invalid_argument);
  EXPECT_THROW((void)mass_properties(Sphere{0.0}, 1.0), std::invalid_argument);
}

/// The 8 corners.
std::vector<Vec3> corners(const Box& box, const Pose& pose) {
  std::vector<Vec3> result;
  for (int k = 0; k < 8; ++k) {
    const Vec3 signs(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0);
    result.push_back(pose * box.half_extents.cwiseProduct(signs));
  }
  return result;
}

TEST(Shape, BoundingRadiusAndSupportAreTheFurthestCorners) {
  Random random(3);
  for (int k = 0; k < 1000; ++k) {
    const Box box{{testing::uniform(random, 0.1, 2.0), testing::uniform(random, 0.1, 2.0),
                   testing::uniform(random, 0.1, 2.0)}};
    const Pose pose{3.0 * testing::random_direction(random), testing::random_orientation(random)};
    const Vec3 n = testing::random_direction(random);
    double furthest = 0.0;
    double highest = -1e9;
    for (const Vec3& corner : corners(box, pose)) {
      furthest = std::max(furthest, corner.norm());
      highest = std::max(highest, n.dot(corner));
    }
    EXPECT_NEAR(bounding_radius(box, pose), furthest, 1e-14);
    EXPECT_NEAR(support(box, pose, n), highest, 1e-14);
    EXPECT_NEAR(bounding_radius(Sphere{0.7}, pose), 3.7, 1e-14);
    EXPECT_NEAR(support(Sphere{0.7}, pose, n), n.dot(pose.position) + 0.7, 1e-14);
    EXPECT_TRUE(std::isinf(bounding_radius(HalfSpace{}, pose)));
    EXPECT_TRUE(std::isinf(support(HalfSpace{}, pose, n)));
    const Vec3 up = pose.orientation * Vec3::UnitZ();
    EXPECT_NEAR(support(HalfSpace{}, pose, up), up.dot(pose.position), 1e-14);
  }
}

TEST(Validate, RefusesBadShapes) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(validate(Shape(Sphere{1e-3})));
  EXPECT_NO_THROW(validate(Shape(HalfSpace{})));
  EXPECT_THROW(validate(Shape(Sphere{infinity})), std::invalid_argument);
  EXPECT_THROW(validate(Shape(Box{{1.0, 1.0, -1.0}})), std::invalid_argument);
  EXPECT_THROW(validate(Shape(Box{{std::nan(""), 1.0, 1.0}})), std::invalid_argument);
}

}  // namespace
}  // namespace signorini::collision
