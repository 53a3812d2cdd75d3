#include <signorini/collision/collision_world.h>
#include <signorini/collision/contact_time.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/collision/pair_query.h>

#include "random_pairs.h"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace signorini::collision {
namespace {

using testing::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// n x n cells of the plane z = 0, an edge of 4 m, each cell halved.
TriangleMesh flat_floor(int cells) {
  return make_height_field(std::vector<double>((cells + 1) * (cells + 1), 0.0), cells + 1,
                           cells + 1, 4.0 / cells, 4.0 / cells);
}

/// The surface of a box.
TriangleMesh box_surface(const Vec3& half) {
  std::vector<Vec3> vertices;
  for (int k = 0; k < 8; ++k) {
    vertices.push_back(
        half.cwiseProduct(Vec3(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0)));
  }
  const std::vector<std::array<int, 4>> faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                 {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  std::vector<std::array<int, 3>> triangles;
  for (const auto& f : faces) {
    triangles.push_back({f[0], f[1], f[2]});
    triangles.push_back({f[0], f[2], f[3]});
  }
  return make_mesh(vertices, triangles);
}

std::vector<Contact> find(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                          double margin) {
  std::vector<Contact> contacts;
  find_intersection(a, pose_a, b, pose_b, margin, contacts);
  return contacts;
}

Pose at(double x, double y, double z) {
  return {Vec3(x, y, z), Quat::Identity()};
}

std::set<std::uint64_t> ids(const std::vector<Contact>& contacts) {
  std::set<std::uint64_t> result;
  for (const Contact& contact : contacts) {
    result.insert(contact.feature_id);
  }
  return result;
}

TEST(Mesh, ABoxThatLandsFlatHasFourContactsAtItsCorners) {
  Random random(1);
  const Box box{Vec3(0.5, 0.3, 0.2)};
  for (const int cells : {1, 4, 7, 32}) {
    const TriangleMesh floor = flat_floor(cells);
    for (int k = 0; k < 40; ++k) {
      const Quat turn(
          Eigen::AngleAxisd(k % 4 == 0 ? 0.0 : testing::uniform(random, 0.0, 7.0), Vec3::UnitZ()));
      const double gap = k % 2 == 0 ? 0.0 : -1e-3;
      const Pose pose{Vec3(k % 3 == 0 ? 0.0 : testing::uniform(random, -1.0, 1.0),
                           testing::uniform(random, -1.0, 1.0), 0.2 + gap),
                      turn};
      const auto contacts = find(box, pose, floor, Pose{}, 0.01);
      ASSERT_EQ(contacts.size(), 4U) << cells << " cells, pose " << k;
      EXPECT_EQ(ids(contacts).size(), 4U);
      for (const Contact& contact : contacts) {
        EXPECT_LE((contact.normal - Vec3::UnitZ()).norm(), 1e-12);
        EXPECT_NEAR(contact.gap, gap, 1e-12);
        EXPECT_EQ(contact.owner, NormalOwner::kFaceB);
        const Vec3 local = (turn.conjugate() * (contact.point_a - pose.position)).cwiseAbs();
        EXPECT_LE((local - box.half_extents).norm(), 1e-9);
      }
    }
  }
}

TEST(Mesh, FeaturesOfASlidingBoxDoNotChangeInsideAFlatPiece) {
  const TriangleMesh floor = flat_floor(8);
  const Box box{Vec3(0.5, 0.3, 0.2)};
  const auto first = ids(find(box, at(-1.0, 0.2, 0.2), floor, Pose{}, 0.01));
  for (int k = 0; k < 200; ++k) {
    EXPECT_EQ(ids(find(box, at(-1.0 + 0.01 * k, 0.2 - 0.003 * k, 0.2), floor, Pose{}, 0.01)),
              first);
  }
}

TEST(Mesh, RollingOverInnerEdgesMeetsNoGhostNormal) {
  const TriangleMesh floor = flat_floor(8);
  for (int k = 0; k < 400; ++k) {
    const Pose pose = at(-1.0 + 0.005 * k, 0.1 + 0.001 * k, 0.5 - 1e-3);
    for (const Shape& shape : {Shape(Sphere{0.5}), Shape(Ellipsoid{Vec3(0.7, 0.6, 0.5)})}) {
      const auto contacts = find(shape, pose, floor, Pose{}, 0.01);
      ASSERT_EQ(contacts.size(), 1U) << k;
      EXPECT_LE((contacts[0].normal - Vec3::UnitZ()).norm(), 1e-9);
      EXPECT_NEAR(contacts[0].gap, -1e-3, 1e-12);
      EXPECT_NEAR(signed_distance(shape, pose, floor, Pose{}), -1e-3, 1e-12);
    }
  }
}

TEST(Mesh, ALyingCapsuleHasTwoContactsOnAFlatPiece) {
  const TriangleMesh floor = flat_floor(8);
  const Quat lying(Eigen::AngleAxisd(M_PI_2, Vec3::UnitY()));
  for (int k = 0; k < 100; ++k) {
    const Pose pose{Vec3(-0.5 + 0.01 * k, 0.3 - 0.007 * k, 0.2), lying};
    const auto contacts = find(Capsule{0.2, 0.6}, pose, floor, Pose{}, 1e-6);
    ASSERT_EQ(contacts.size(), 2U) << k;
    EXPECT_NEAR((contacts[0].point_b - contacts[1].point_b).norm(), 1.2, 1e-9);
  }
}

TEST(Mesh, AStepPushesABoxBackAlongTheFloor) {
  // Floor, riser at x = 0, and a step at z = 0.25; the box leans 1 mm into the riser.
  const std::vector<Vec3> profile = {{-2, 0, 0}, {0, 0, 0}, {0, 0, 0.25}, {2, 0, 0.25}};
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (const Vec3& p : profile) {
    vertices.push_back(p - Vec3(0, 1, 0));
    vertices.push_back(p + Vec3(0, 1, 0));
  }
  for (int k = 0; k < 6; k += 2) {
    triangles.push_back({k, k + 2, k + 3});
    triangles.push_back({k, k + 3, k + 1});
  }
  const TriangleMesh stairs = make_mesh(vertices, triangles);
  const Box box{Vec3::Constant(0.2)};
  const auto contacts = find(box, at(-0.199, 0.05, 0.2), stairs, Pose{}, 1e-6);
  int upward = 0;
  int backward = 0;
  for (const Contact& contact : contacts) {
    upward += (contact.normal - Vec3::UnitZ()).norm() <= 1e-9;
    backward += (contact.normal + Vec3::UnitX()).norm() <= 1e-9;
  }
  EXPECT_EQ(upward + backward, static_cast<int>(contacts.size()));
  EXPECT_GE(upward, 2);
  EXPECT_GE(backward, 2);
}

TEST(Mesh, OutsideAConvexSurfaceTheDistanceIsThatOfTheSolid) {
  Random random(3);
  const Vec3 half(0.7, 0.5, 0.3);
  const TriangleMesh surface = box_surface(half);
  int apart = 0;
  for (int k = 0; k < 3000; ++k) {
    const Pose pose_b{testing::uniform(random, 0.0, 100.0) * testing::random_direction(random),
                      testing::random_orientation(random)};
    const Pose pose_a{
        pose_b.position + testing::uniform(random, 0.0, 2.5) * testing::random_direction(random),
        testing::random_orientation(random)};
    const Shape shapes[] = {Sphere{0.3}, Box{Vec3(0.4, 0.3, 0.2)}, Capsule{0.2, 0.3},
                            Cylinder{0.3, 0.2}, Ellipsoid{Vec3(0.2, 0.3, 0.4)}};
    const Shape& a = shapes[k % 5];
    const double solid = signed_distance(a, pose_a, Box{half}, pose_b);
    if (solid <= 1e-9) {
      continue;
    }
    ++apart;
    ASSERT_NEAR(signed_distance(a, pose_a, surface, pose_b), solid, 1e-11) << k;
    EXPECT_FALSE(test_intersection(a, pose_a, surface, pose_b));
    EXPECT_TRUE(find(a, pose_a, surface, pose_b, solid * 0.999).empty());
    const auto contacts = find(a, pose_a, surface, pose_b, solid * 1.001);
    ASSERT_FALSE(contacts.empty());
    double least = kInfinity;
    for (const Contact& contact : contacts) {
      least = std::min(least, contact.gap);
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
      EXPECT_LE((contact.point_a - contact.point_b - contact.gap * contact.normal).norm(), 1e-9);
    }
    EXPECT_NEAR(least, solid, 1e-6);
    EXPECT_EQ(ids(contacts).size(), contacts.size());
  }
  EXPECT_GT(apart, 1000);
}

TEST(Mesh, OverlapShallowAndDeepIsConsistent) {
  Random random(4);
  const TriangleMesh surface = box_surface(Vec3(0.7, 0.5, 0.3));
  int touching = 0;
  for (int k = 0; k < 2000; ++k) {
    const Pose pose_a{testing::uniform(random, 0.0, 1.0) * testing::random_direction(random),
                      testing::random_orientation(random)};
    const Shape shapes[] = {Sphere{0.3}, Box{Vec3(0.4, 0.3, 0.2)}, Capsule{0.2, 0.3},
                            Cone{0.3, 0.2}, Ellipsoid{Vec3(0.2, 0.3, 0.4)}};
    const Shape& a = shapes[k % 5];
    const double d = signed_distance(a, pose_a, surface, Pose{});
    ASSERT_TRUE(std::isfinite(d));
    const auto contacts = find(a, pose_a, surface, Pose{}, 0.0);
    EXPECT_EQ(test_intersection(a, pose_a, surface, Pose{}), d <= 0.0) << k;
    EXPECT_EQ(contacts.empty(), d > 0.0) << k;
    EXPECT_EQ(ids(contacts).size(), contacts.size());
    touching += d <= 0.0;
    for (const Contact& contact : contacts) {
      EXPECT_GE(contact.gap, d - 1e-12);
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
      EXPECT_LE((contact.point_a - contact.point_b - contact.gap * contact.normal).norm(), 1e-9);
    }
  }
  EXPECT_GT(touching, 500);
}

// The cap is the face, and sees the triangles edge-on.
TEST(Mesh, ACylinderPushedIntoTheBorderMeetsItsEdge) {
  const TriangleMesh floor = flat_floor(4);
  const double border = floor.data->vertices.back().x();
  const Cylinder cylinder{1.4, 0.46};
  const Quat along_x(Eigen::AngleAxisd(M_PI_2, Vec3::UnitY()));
  for (const double height : {0.0, 0.3, -0.2}) {
    for (const double across : {0.1, 1.1}) {
      const auto contacts =
          find(cylinder, {Vec3(border + 0.2, across, height), along_x}, floor, Pose{}, 0.0);
      ASSERT_FALSE(contacts.empty());
      for (const Contact& contact : contacts) {
        EXPECT_LE((contact.normal - Vec3::UnitX()).norm(), 1e-12);
        EXPECT_NEAR(contact.gap, -0.26, 1e-12);
        EXPECT_NEAR(contact.point_b.x(), border, 1e-12);
        EXPECT_NEAR(contact.point_b.z(), 0.0, 1e-12);
      }
    }
  }
}

// An end hangs beside the border, far below the plane: no foot of it is on the mesh.
TEST(Mesh, ACapsuleThatPiercesTheBorderIsPushedFromAPointOfTheMesh) {
  const TriangleMesh floor = flat_floor(4);
  const double border = floor.data->vertices.back().x();
  const Capsule capsule{0.06, 1.5};
  for (const double inside : {0.02, 0.1, 0.3}) {
    for (const double shift : {-0.8, 0.0, 0.8}) {
      for (const double tilt : {0.3, 0.6, 0.9, 1.2}) {
        const Quat outwards(Eigen::AngleAxisd(M_PI - tilt, Vec3::UnitY()));
        const Vec3 centre = Vec3(border - inside, 0.1, 0.0) - shift * (outwards * Vec3::UnitZ());
        const auto contacts = find(capsule, {centre, outwards}, floor, Pose{}, 0.0);
        ASSERT_FALSE(contacts.empty());
        for (const Contact& contact : contacts) {
          EXPECT_LE(contact.point_b.x(), border + 1e-9) << inside << " " << shift << " " << tilt;
          EXPECT_NEAR(contact.point_b.z(), 0.0, 1e-9);
          EXPECT_LE(contact.gap, 0.0);
        }
      }
    }
  }
}

TEST(Mesh, ContactTimeOfAFallingBallIsThatOfThePlane) {
  const TriangleMesh floor = flat_floor(8);
  const ConstantVelocityMotion falling(at(0.123, 0.077, 2.0), Vec3(0.1, 0.0, -3.0), Vec3(1, 2, 3));
  const StillMotion still{Pose{}};
  for (const Shape& shape : {Shape(Sphere{0.2}), Shape(Box{Vec3(0.2, 0.1, 0.3)})}) {
    const auto onto_mesh = contact_time(shape, falling, floor, still, 1.0);
    const auto onto_plane = contact_time(shape, falling, HalfSpace{}, still, 1.0);
    ASSERT_TRUE(onto_mesh && onto_plane);
    EXPECT_NEAR(*onto_mesh, *onto_plane, 1e-9);
  }
  // A bullet does not pass the surface.
  const ConstantVelocityMotion bullet(at(0.1, 0.1, 100.0), Vec3(0.0, 0.0, -1000.0), Vec3::Zero());
  const auto hit = contact_time(Sphere{0.01}, bullet, floor, still, 1.0);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(*hit, (100.0 - 0.01) / 1000.0, 1e-9);
}

template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Mesh, NamesWhatIsWrong) {
  const std::vector<Vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(refusal([&] {
              (void)make_mesh({{0, 0, 0}, {1, 0, 0}, {kInfinity, 1, 0}}, {{0, 1, 2}});
            }),
            "mesh: vertex 2: must be finite, got (inf, 1, 0) m");
  EXPECT_EQ(refusal([&] {
              (void)make_mesh(square, {{0, 1, 2}, {0, 2, 4}});
            }),
            "mesh: triangle 1: vertex: must be in [0, 4), got 4");
  EXPECT_EQ(refusal([&] {
              (void)make_mesh(square, {{0, 1, 1}});
            }),
            "mesh: triangles: at least one must have an area, got 1 without");
  EXPECT_EQ(make_mesh(square, {{0, 1, 1}, {0, 1, 2}}).data->degenerate, 1);
  EXPECT_EQ(
      refusal([&] {
        (void)make_height_field({0, 0, 0}, 2, 2, 1.0, 1.0);
      }),
      "height field: columns, rows: must be >= 2 with a height each, got 2 x 2 and 3 heights");
  EXPECT_EQ(refusal([&] {
              (void)make_height_field({0, 0, 0, 0}, 2, 2, 0.0, 1.0);
            }),
            "height field: dx: must be finite and > 0, got 0 m");
  EXPECT_EQ(refusal([&] { (void)signed_distance(Sphere{}, {}, TriangleMesh{}, {}); }),
            "mesh: data: must not be null");
  const Bodies bodies(1);
  EXPECT_EQ(refusal([&] {
              CollisionWorld(bodies, {{0, flat_floor(1), {}, {}, "m"}}, PairingRule::kMultiply);
            }),
            "collider 'm': body: a mesh is immovable, body 0 is dynamic");
}

}  // namespace
}  // namespace signorini::collision
