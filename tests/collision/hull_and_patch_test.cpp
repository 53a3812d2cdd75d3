#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
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

ConvexHull prism_of_eight() {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces(2);
  for (int k = 0; k < 8; ++k) {
    const double angle = (k + 0.5) * M_PI_4;
    points.emplace_back(0.4 * std::cos(angle), 0.4 * std::sin(angle), -0.5);
    points.emplace_back(0.4 * std::cos(angle), 0.4 * std::sin(angle), 0.5);
    faces[0].push_back(2 * (7 - k));
    faces[1].push_back(2 * k + 1);
    const int next = (k + 1) % 8;
    faces.push_back({2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
  }
  return make_hull(points, faces);
}

/// Level ground at z = 0 as every kind of shape that can be flat.
std::vector<Shape> grounds() {
  const double w = 2.0;
  return {HalfSpace{},
          make_hull(
              {{-w, -w, -1},
               {w, -w, -1},
               {w, w, -1},
               {-w, w, -1},
               {-w, -w, 0},
               {w, -w, 0},
               {w, w, 0},
               {-w, w, 0}},
              {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}),
          make_mesh({{-w, -w, 0}, {w, -w, 0}, {w, w, 0}, {-w, w, 0}}, {{0, 1, 2}, {0, 2, 3}}),
          make_height_field(std::vector<double>(25, 0.0), 5, 5, 1.0, 1.0)};
}

struct Landing {
  Shape shape;
  Pose pose;
  std::size_t contacts;
};

TEST(ContactPatch, OfEveryLandingHasAllItsCornersAtOnceAndOneNormal) {
  const Quat yaw(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  const Quat lying = yaw * Quat(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0);
  const Landing landings[] = {
      {Box{}, {{0.1, 0.2, 0.5}, yaw}, 4},
      {prism_of_eight(), {{0.1, 0.2, 0.5}, yaw}, 8},
      {Cylinder{0.4, 0.5}, {{0.1, 0.2, 0.5}, yaw}, 8},
      {Cylinder{0.4, 0.5}, {{0.1, 0.2, 0.4}, lying}, 2},
      {Capsule{0.4, 0.5}, {{0.1, 0.2, 0.4}, lying}, 2},
      {Cone{0.4, 0.5}, {{0.1, 0.2, 0.5}, yaw}, 8},
      {Ellipsoid{{0.4, 0.5, 0.6}}, {{0.1, 0.2, 0.6}, yaw}, 1},
  };
  for (const Landing& landing : landings) {
    for (const Shape& ground : grounds()) {
      std::vector<Contact> contacts;
      find_intersection(landing.shape, landing.pose, ground, {}, 1e-6, contacts);
      EXPECT_EQ(contacts.size(), landing.contacts)
          << "shape " << landing.shape.index() << " on " << ground.index();
      for (const Contact& contact : contacts) {
        EXPECT_NEAR((contact.normal - Vec3::UnitZ()).norm(), 0.0, 1e-12);
        EXPECT_NEAR(contact.gap, 0.0, 1e-9);
        EXPECT_NEAR(contact.point_b.z(), 0.0, 1e-9);
      }
    }
  }
}

TEST(ContactPatch, OfAnUprightCylinderIsSpreadOverItsRim) {
  std::vector<Contact> contacts;
  find_intersection(Cylinder{0.4, 0.5}, {{0, 0, 0.5}, Quat::Identity()}, Box{{1.0, 1.0, 0.5}},
                    {{0, 0, -0.5}, Quat::Identity()}, 1e-9, contacts);
  ASSERT_GE(contacts.size(), 6u);
  for (const Contact& contact : contacts) {
    EXPECT_NEAR(contact.point_a.head<2>().norm(), 0.4, 1e-12);
    // No other within 41 degrees.
    for (const Contact& other : contacts) {
      if (&other != &contact) {
        EXPECT_GT((other.point_a - contact.point_a).norm(), 2.0 * 0.4 * std::sin(0.36));
      }
    }
  }
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
