#include <signorini/collision/hull.h>
#include <signorini/collision/pair_query.h>

#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

namespace signorini::collision {
namespace {

std::size_t count(const Shape& a, const Pose& pose_a, const Shape& b) {
  std::vector<Contact> contacts;
  find_intersection(a, pose_a, b, {}, 1e-9, contacts);
  for (const Contact& contact : contacts) {
    EXPECT_NEAR((contact.normal - Vec3::UnitZ()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(contact.gap, 0.0, 1e-12);
  }
  return contacts.size();
}

ConvexHull cube_hull() {
  std::vector<Vec3> points;
  for (int k = 0; k < 8; ++k) {
    points.emplace_back(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
  }
  return make_hull(
      points, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

TEST(ContactPatch, HasTheCornersOfWhatLiesOnAPlane) {
  const Pose upright{{0, 0, 0.5}, Quat::Identity()};
  EXPECT_EQ(count(Cylinder{0.3, 0.5}, upright, HalfSpace{}), 8u);
  EXPECT_EQ(count(Cone{0.3, 0.5}, upright, HalfSpace{}), 8u);
  EXPECT_EQ(count(cube_hull(), upright, HalfSpace{}), 4u);
  const Quat lying(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0);
  EXPECT_EQ(count(Cylinder{0.5, 0.7}, {{0, 0, 0.5}, lying}, HalfSpace{}), 2u);
  EXPECT_EQ(count(Capsule{0.5, 0.7}, {{0, 0, 0.5}, lying}, HalfSpace{}), 2u);
  EXPECT_EQ(count(Box{}, {{0, 0, 1.0}, Quat::Identity()}, cube_hull()), 4u);
}

TEST(Hull, OfACubeHasItsMassAndRefusesWhatIsFlatOrOpen) {
  const MassProperties hull = mass_properties(cube_hull(), 2.0);
  const MassProperties box = mass_properties(Box{}, 2.0);
  EXPECT_NEAR(hull.mass, box.mass, 1e-14);
  EXPECT_NEAR((hull.inertia - box.inertia).norm(), 0.0, 1e-14);
  EXPECT_THROW((void)make_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}), std::invalid_argument);
  EXPECT_THROW((void)make_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}),
               std::invalid_argument);
  EXPECT_THROW(validate(Shape(ConvexHull{})), std::invalid_argument);
}

}  // namespace
}  // namespace signorini::collision
