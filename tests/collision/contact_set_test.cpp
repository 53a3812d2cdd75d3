#include <signorini/collision/pair_query.h>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>

namespace signorini::collision {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Quat turn(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis));
}

std::vector<Contact> find(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                          double margin = 0.01) {
  std::vector<Contact> contacts;
  find_intersection(a, pose_a, b, pose_b, margin, contacts);
  return contacts;
}

std::set<std::uint64_t> ids(const std::vector<Contact>& contacts) {
  std::set<std::uint64_t> result;
  for (const Contact& contact : contacts) {
    result.insert(contact.feature_id);
  }
  return result;
}

/// Every wanted point is P_B of a contact, and there are no others.
void expect_points(const std::vector<Contact>& contacts, const std::vector<Vec3>& wanted,
                   double tolerance) {
  EXPECT_EQ(contacts.size(), wanted.size());
  for (const Vec3& point : wanted) {
    EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), [&](const Contact& contact) {
      return (contact.point_b - point).norm() <= tolerance;
    })) << point.transpose();
  }
}

const Box kCube{Vec3::Constant(0.5)};

TEST(ContactSet, BoxFlatOnHalfSpaceTouchesAtItsFourCorners) {
  const auto contacts = find(kCube, {{0, 0, 0.5}, Quat::Identity()}, HalfSpace{}, {});
  expect_points(contacts, {{0.5, 0.5, 0}, {0.5, -0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}}, 1e-15);
  for (const Contact& contact : contacts) {
    EXPECT_EQ(contact.normal, Vec3::UnitZ());
    EXPECT_EQ(contact.gap, 0.0);
    EXPECT_EQ(contact.owner, NormalOwner::kFaceB);
  }
}

TEST(ContactSet, ThinPlateWithinTheMarginTouchesWithItsLowerFaceOnly) {
  const Box plate{{0.5, 0.5, 0.0005}};
  EXPECT_EQ(find(plate, {{0, 0, 0.0005}, Quat::Identity()}, HalfSpace{}, {}).size(), 4u);
  EXPECT_EQ(find(plate, {{0, 0, 0.5005}, Quat::Identity()}, kCube, {}).size(), 4u);
}

TEST(ContactSet, BoxFlatOnEqualBoxTouchesAtItsFourCorners) {
  const auto contacts = find(kCube, {{0, 0, 1.0}, Quat::Identity()}, kCube, {});
  expect_points(contacts, {{0.5, 0.5, 0.5}, {0.5, -0.5, 0.5}, {-0.5, 0.5, 0.5}, {-0.5, -0.5, 0.5}},
                1e-6);
  for (const Contact& contact : contacts) {
    EXPECT_EQ(contact.normal, Vec3::UnitZ());
    EXPECT_NEAR(contact.gap, 0.0, 1e-15);
  }
}

TEST(ContactSet, BoxOnLargerTurnedBoxTouchesAtItsOwnCorners) {
  const Box table{{2.0, 2.0, 0.5}};
  const Quat yaw = turn(0.7, Vec3::UnitZ());
  const auto contacts = find(kCube, {{0.3, -0.2, 1.0}, yaw}, table, {});
  ASSERT_EQ(contacts.size(), 4u);
  for (const Contact& contact : contacts) {
    const Vec3 local = yaw.conjugate() * (contact.point_a - Vec3(0.3, -0.2, 1.0));
    EXPECT_NEAR(std::abs(local.x()), 0.5, 1e-14);
    EXPECT_NEAR(std::abs(local.y()), 0.5, 1e-14);
    EXPECT_EQ(contact.owner, NormalOwner::kFaceB);
  }
}

TEST(ContactSet, EqualSquaresTurnedByAnEighthTouchInAnOctagon) {
  const auto contacts = find(kCube, {{0, 0, 1.0}, turn(M_PI / 4, Vec3::UnitZ())}, kCube, {});
  // |x| = 1/2 meets |x| + |y| = 1/sqrt 2.
  const double s = std::sqrt(0.5) - 0.5;
  std::vector<Vec3> octagon;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      octagon.emplace_back(0.5 * x, s * y, 0.5);
      octagon.emplace_back(s * x, 0.5 * y, 0.5);
    }
  }
  expect_points(contacts, octagon, 3e-6);  // the clipping's slack, 1e-6 of the half diagonal
  EXPECT_EQ(ids(contacts).size(), 8u);
}

TEST(ContactSet, LargerFaceOverSmallerListsTheSmallerFacesCorners) {
  const Box table{{2.0, 2.0, 0.5}};
  const auto contacts = find(table, {{0.3, 0.2, 1.0}, turn(0.2, Vec3::UnitZ())}, kCube, {});
  expect_points(contacts, {{0.5, 0.5, 0.5}, {0.5, -0.5, 0.5}, {-0.5, 0.5, 0.5}, {-0.5, -0.5, 0.5}},
                1e-6);
}

TEST(ContactSet, CrossedEdgesTouchInOnePoint) {
  const double half_diagonal = std::sqrt(0.5);
  const Pose upper{{0.1, 0.05, 2.0 * half_diagonal}, turn(M_PI / 4, Vec3::UnitX())};
  const Pose lower{Vec3::Zero(), turn(M_PI / 4, Vec3::UnitY())};
  const auto contacts = find(kCube, upper, kCube, lower);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].owner, NormalOwner::kEdgeEdge);
  EXPECT_NEAR((contacts[0].normal - Vec3::UnitZ()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((contacts[0].point_b - Vec3(0.0, 0.05, half_diagonal)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(std::abs(contacts[0].surface_a.direction.x()), 1.0, 1e-15);
  EXPECT_NEAR(std::abs(contacts[0].surface_b.direction.y()), 1.0, 1e-15);
}

TEST(ContactSet, EdgeLyingOnAFaceTouchesAtItsEnds) {
  const Pose on_edge{{0.0, 0.0, 0.5 + std::sqrt(0.5)}, turn(M_PI / 4, Vec3::UnitX())};
  const Box table{{2.0, 2.0, 0.5}};
  const auto contacts = find(kCube, on_edge, table, {});
  expect_points(contacts, {{0.5, 0, 0.5}, {-0.5, 0, 0.5}}, 1e-15);
  const auto overhanging =
      find(kCube, {{2.2, 0.0, 0.5 + std::sqrt(0.5)}, on_edge.orientation}, table, {});
  expect_points(overhanging, {{1.7, 0, 0.5}, {2.0, 0, 0.5}}, 1e-6);
}

TEST(ContactSet, ParallelEdgesCornerToCornerTouchAtTheEndsOfTheirOverlap) {
  const auto contacts = find(kCube, {{1.003, 0.3, 1.004}, Quat::Identity()}, kCube, {});
  expect_points(contacts, {{0.5, -0.2, 0.5}, {0.5, 0.5, 0.5}}, 1e-6);
  for (const Contact& contact : contacts) {
    EXPECT_EQ(contact.owner, NormalOwner::kCurved);
    EXPECT_NEAR(contact.gap, 0.005, 1e-15);
    EXPECT_NEAR((contact.normal - Vec3(0.6, 0.0, 0.8)).norm(), 0.0, 1e-12);
  }
}

TEST(ContactSet, CornersApartMeetInTheirNearestPoints) {
  const Quat tumbled = turn(0.3, Vec3(1, 2, 3).normalized());
  const Vec3 corner = tumbled * Vec3::Constant(-0.5);
  const Vec3 direction(2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0);
  const Pose pose{Vec3::Constant(0.5) + 0.006 * direction - corner, tumbled};
  const auto contacts = find(kCube, pose, kCube, {});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].owner, NormalOwner::kCurved);
  EXPECT_NEAR(contacts[0].gap, 0.006, 1e-15);
  EXPECT_NEAR((contacts[0].normal - direction).norm(), 0.0, 1e-12);
  EXPECT_EQ(contacts[0].surface_a.radius_along, 0.0);
  EXPECT_NEAR(signed_distance(kCube, pose, kCube, {}), 0.006, 1e-15);
}

TEST(ContactSet, StackKeepsItsFeaturesUnderJitter) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1e-8);
  std::set<std::uint64_t> first;
  for (int step = 0; step < 20000; ++step) {
    const Vec3 axis(noise(random), noise(random), noise(random));
    const Pose upper{Vec3(noise(random), noise(random), 1.0 + noise(random)),
                     Quat(1.0, axis.x(), axis.y(), axis.z()).normalized()};
    const auto now = ids(find(kCube, upper, kCube, {}));
    if (step == 0) {
      first = now;
      ASSERT_EQ(first.size(), 4u);
    }
    ASSERT_EQ(now, first) << "step " << step;
  }
}

TEST(ContactSet, BoxInsideABoxLeavesThroughTheNearestFace) {
  const Box room{{2.0, 3.0, 4.0}};
  const Pose inside{{1.0, 0.2, -0.3}, Quat::Identity()};
  EXPECT_DOUBLE_EQ(signed_distance(kCube, inside, room, {}), -1.5);
  const auto contacts = find(kCube, inside, room, {});
  ASSERT_FALSE(contacts.empty());
  for (const Contact& contact : contacts) {
    EXPECT_EQ(contact.normal, Vec3::UnitX());
  }
}

TEST(ContactSet, ConcentricShapesHaveAStatedNormal) {
  const auto spheres = find(Sphere{1.0}, {}, Sphere{2.0}, {});
  ASSERT_EQ(spheres.size(), 1u);
  EXPECT_EQ(spheres[0].normal, Vec3::UnitZ());
  EXPECT_EQ(spheres[0].gap, -3.0);
  const auto in_box = find(Sphere{0.1}, {}, kCube, {});
  ASSERT_EQ(in_box.size(), 1u);
  EXPECT_EQ(in_box[0].normal, Vec3::UnitX());
  EXPECT_DOUBLE_EQ(in_box[0].gap, -0.6);
  EXPECT_EQ(find(kCube, {}, kCube, {}).size(), 4u);
}

TEST(ContactSet, SphereCentreOnAFaceOrEdgeLeavesThroughAFace) {
  const auto on_face = find(Sphere{0.1}, {{0.1, -0.5, 0.2}, Quat::Identity()}, kCube, {});
  ASSERT_EQ(on_face.size(), 1u);
  EXPECT_EQ(on_face[0].normal, -Vec3::UnitY());
  EXPECT_EQ(on_face[0].gap, -0.1);
  EXPECT_EQ(on_face[0].owner, NormalOwner::kFaceB);
  const auto on_edge = find(Sphere{0.1}, {{0.1, -0.5, 0.5}, Quat::Identity()}, kCube, {});
  ASSERT_EQ(on_edge.size(), 1u);
  EXPECT_EQ(on_edge[0].normal, -Vec3::UnitY());
}

TEST(ContactSet, SphereBesideEdgeAndVertexSeesThem) {
  const Pose by_edge{{0.5 + 0.3, 0.1, 0.5 + 0.4}, Quat::Identity()};
  const auto edge = find(Sphere{0.5}, by_edge, kCube, {});
  ASSERT_EQ(edge.size(), 1u);
  EXPECT_EQ(edge[0].owner, NormalOwner::kCurved);
  EXPECT_NEAR((edge[0].normal - Vec3(0.6, 0, 0.8)).norm(), 0.0, 1e-15);
  EXPECT_EQ(edge[0].surface_b.direction, Vec3::UnitY());
  EXPECT_TRUE(std::isinf(edge[0].surface_b.radius_along));
  EXPECT_EQ(edge[0].surface_b.radius_across, 0.0);
  const Pose by_vertex{{0.7, 0.7, 0.6}, Quat::Identity()};
  const auto vertex = find(Sphere{0.5}, by_vertex, kCube, {});
  ASSERT_EQ(vertex.size(), 1u);
  EXPECT_NEAR(vertex[0].gap, 0.3 - 0.5, 1e-15);
  EXPECT_EQ(vertex[0].surface_b.radius_along, 0.0);
}

TEST(ContactSet, HalfSpacesMeetUnlessTheyFaceEachOther) {
  const Pose down{{0, 0, 2.0}, turn(M_PI, Vec3::UnitX())};
  EXPECT_FALSE(test_intersection(HalfSpace{}, down, HalfSpace{}, {}));
  EXPECT_NEAR(signed_distance(HalfSpace{}, down, HalfSpace{}, {}), 2.0, 1e-15);
  const Pose tilted{{0, 0, 2.0}, turn(3.0, Vec3::UnitX())};
  EXPECT_TRUE(test_intersection(HalfSpace{}, tilted, HalfSpace{}, {}));
  EXPECT_TRUE(find(HalfSpace{}, tilted, HalfSpace{}, {}).empty());
}

/// The message of the std::invalid_argument that a call throws.
template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(BadInput, IsNamedBeforeTheContactsChange) {
  const Pose bad_position{{0.0, kNaN, 0.0}, Quat::Identity()};
  const Pose bad_turn{Vec3::Zero(), Quat(2.0, 0.0, 0.0, 0.0)};
  const Pose nan_turn{Vec3::Zero(), Quat(kNaN, 0.0, 0.0, 0.0)};
  std::vector<Contact> contacts(3);
  const auto with_pose = [&](const Pose& pose) {
    return refusal([&] { find_intersection(kCube, {}, kCube, pose, 0.0, contacts); });
  };
  EXPECT_EQ(with_pose(bad_position), "pose: position: must be finite, got (0, nan, 0) m");
  EXPECT_EQ(with_pose(bad_turn),
            "pose: orientation: must be a unit quaternion to 1e-6, its norm is 2");
  EXPECT_EQ(with_pose(nan_turn),
            "pose: orientation: must be a unit quaternion to 1e-6, its norm is nan");
  EXPECT_EQ(refusal([&] { find_intersection(kCube, {}, kCube, {}, -0.5, contacts); }),
            "find_intersection: margin: must be >= 0, got -0.5 m");
  EXPECT_EQ(refusal([&] { find_intersection(kCube, {}, kCube, {}, kNaN, contacts); }),
            "find_intersection: margin: must be >= 0, got nan m");
  EXPECT_EQ(refusal([&] { (void)signed_distance(Sphere{-1.0}, {}, kCube, {}); }),
            "sphere: radius: must be finite and > 0, got -1");
  EXPECT_EQ(refusal([&] {
              (void)test_intersection(kCube, {}, Box{{1.0, 0.0, 1.0}}, {});
            }),
            "box: half_extents.y: must be finite and > 0, got 0");
  EXPECT_EQ(contacts.size(), 3u);
}

}  // namespace
}  // namespace signorini::collision
