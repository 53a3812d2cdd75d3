#include "pair_properties.h"

#include <cstdio>
#include <gtest/gtest.h>

namespace signorini::collision {
namespace {

using testing::ShapeKind;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr long kPoses = 100;
#else
constexpr long kPoses = 1500;
#endif

constexpr const char* kNames[] = {"Sphere", "Box",       "Capsule", "Cylinder",
                                  "Cone",   "Ellipsoid", "Hull",    "HalfSpace"};

class ConvexPairs : public ::testing::TestWithParam<ShapeKind> {};

INSTANTIATE_TEST_SUITE_P(Shapes, ConvexPairs,
                         ::testing::Values(ShapeKind::kCapsule, ShapeKind::kCylinder,
                                           ShapeKind::kCone, ShapeKind::kEllipsoid,
                                           ShapeKind::kHull),
                         [](const auto& kind) { return kNames[static_cast<int>(kind.param)]; });

// With every shape that comes before it, itself, and the half-space.
TEST_P(ConvexPairs, HoldEveryPropertyAtRandomAndKissingPoses) {
  for (int other = 0; other <= static_cast<int>(ShapeKind::kHalfSpace); ++other) {
    if (other > static_cast<int>(GetParam()) && other < static_cast<int>(ShapeKind::kHalfSpace)) {
      continue;
    }
    testing::PairCounts counts;
    const std::string broken = testing::check_poses(static_cast<ShapeKind>(other), GetParam(),
                                                    kPoses, 20261125u + other, counts);
    EXPECT_EQ(broken, "") << kNames[other] << " and " << kNames[static_cast<int>(GetParam())];
    std::printf("    %s: %ld poses, %ld apart, %ld contacts\n", kNames[other], counts.poses,
                counts.apart, counts.contacts);
  }
}

}  // namespace
}  // namespace signorini::collision
