#include <signorini/collision/compound.h>
#include <signorini/collision/mesh.h>
#include <signorini/collision/pair_query.h>

#include "random_pairs.h"
#include "tests/lcp/allocation_count.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace signorini::collision {
namespace {

using testing::Random;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr int kPoses = 18;
#else
constexpr int kPoses = 60;
#endif

std::vector<Shape> convex_shapes() {
  Random random(1);
  return {Sphere{0.4},
          Box{{0.4, 0.3, 0.5}},
          Capsule{0.2, 0.5},
          Cylinder{0.3, 0.4},
          Cone{0.4, 0.4},
          Ellipsoid{{0.3, 0.4, 0.5}},
          testing::random_hull(random, 0.5)};
}

TriangleMesh bumps() {
  std::vector<double> heights;
  for (int k = 0; k < 121; ++k) {
    heights.push_back(k % 11 < 5 ? 0.0 : 0.15 * std::sin(1.3 * k));
  }
  return make_height_field(heights, 11, 11, 0.4, 0.4);
}

/// Sums what the three queries say of each shape at each pose; `found` says how often they touch.
double ask_all(const std::vector<Shape>& shapes, const Shape& other, const std::vector<Pose>& poses,
               std::vector<Contact>& contacts, int& found) {
  double sum = 0.0;
  for (const Shape& shape : shapes) {
    for (const Pose& pose : poses) {
      for (const double margin : {0.0, 0.1}) {
        find_intersection(shape, pose, other, Pose{}, margin, contacts);
        sum += static_cast<double>(contacts.size());
      }
      found += test_intersection(shape, pose, other, Pose{}) ? 1 : 0;
      sum += signed_distance(other, Pose{}, shape, pose);
    }
  }
  return sum;
}

void expect_no_allocation(const std::vector<Shape>& shapes, const Shape& other) {
  Random random(5);
  std::vector<Pose> poses;
  for (int k = 0; k < kPoses; ++k) {
    poses.push_back({Vec3(testing::uniform(random, -1.5, 1.5), testing::uniform(random, -1.5, 1.5),
                          testing::uniform(random, -0.3, 0.8)),
                     k % 3 == 0 ? Quat::Identity() : testing::random_orientation(random)});
  }
  std::vector<Contact> contacts;
  int found = 0;
  const double first = ask_all(shapes, other, poses, contacts, found);
  const lcp::AllocationCount allocations;
  const double second = ask_all(shapes, other, poses, contacts, found);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(first, second);
  EXPECT_GT(found, static_cast<int>(shapes.size()) * kPoses / 6);
}

TEST(QueryAllocation, NoneAgainstAMeshOnceMemoryHasGrown) {
  expect_no_allocation(convex_shapes(), bumps());
}

TEST(QueryAllocation, NoneAgainstACompoundOnceMemoryHasGrown) {
  std::vector<CompoundPart> parts;
  std::vector<Shape> shapes = convex_shapes();
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    parts.push_back(
        {shapes[k], {Vec3(0.5 * static_cast<double>(k) - 1.5, 0.0, 0.0), {1, 0, 0, 0}}});
  }
  const Compound compound = make_compound(parts);
  shapes.push_back(compound);
  expect_no_allocation(shapes, compound);
  expect_no_allocation({compound}, bumps());
}

}  // namespace
}  // namespace signorini::collision
