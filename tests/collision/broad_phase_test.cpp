#include <signorini/collision/broad_phase.h>

#include "random_pairs.h"
#include "tests/lcp/allocation_count.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace signorini::collision {
namespace {

using testing::Random;
using Pairs = std::vector<std::pair<int, int>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Pairs all_overlaps(const std::vector<Bounds>& bounds, const std::vector<std::uint8_t>& fixed) {
  Pairs pairs;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (std::size_t j = i + 1; j < bounds.size(); ++j) {
      const bool both_fixed = !fixed.empty() && fixed[i] != 0 && fixed[j] != 0;
      if (!both_fixed && bounds[i].overlaps(bounds[j])) {
        pairs.emplace_back(i, j);
      }
    }
  }
  return pairs;
}

Bounds around(const Vec3& centre, const Vec3& half) {
  return {centre - half, centre + half};
}

Vec3 random_in(Random& random, const Vec3& half) {
  return {testing::uniform(random, -half.x(), half.x()),
          testing::uniform(random, -half.y(), half.y()),
          testing::uniform(random, -half.z(), half.z())};
}

/// What a scene may look like to a broad phase.
struct Crowd {
  const char* name;
  int count;
  Vec3 room;           ///< half extents of where the centres are
  double least, most;  ///< half extents, exponents of 10
  Vec3 offset;         ///< of all
};

class BroadPhaseOnCrowds : public ::testing::TestWithParam<Crowd> {};

TEST_P(BroadPhaseOnCrowds, FindsTheOverlapsOfAllPairsInOrder) {
  const Crowd& crowd = GetParam();
  Random random(5);
  BroadPhase broad_phase;
  for (int round = 0; round < 5; ++round) {
    std::vector<Bounds> bounds;
    std::vector<std::uint8_t> fixed;
    for (int i = 0; i < crowd.count; ++i) {
      const Vec3 half(testing::log_uniform(random, crowd.least, crowd.most),
                      testing::log_uniform(random, crowd.least, crowd.most),
                      testing::log_uniform(random, crowd.least, crowd.most));
      bounds.push_back(around(crowd.offset + random_in(random, crowd.room), half));
      fixed.push_back(i % 3 == 0 ? 1 : 0);
    }
    if (round % 2 == 1 && crowd.count > 0) {
      bounds[crowd.count / 2] = around(Vec3::Zero(), Vec3::Constant(kInfinity));
      bounds[crowd.count / 3].high.y() = kInfinity;
    }
    Pairs found{{7, 7}};
    broad_phase.find(bounds, fixed, found);
    EXPECT_EQ(found, all_overlaps(bounds, fixed)) << "round " << round;
    broad_phase.find(bounds, {}, found);
    EXPECT_EQ(found, all_overlaps(bounds, {})) << "round " << round;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BroadPhaseOnCrowds,
    ::testing::Values(Crowd{"none", 0, Vec3::Ones(), 0, 0, Vec3::Zero()},
                      Crowd{"one", 1, Vec3::Ones(), 0, 0, Vec3::Zero()},
                      Crowd{"few", 60, Vec3(3, 1, 2), -2, -0.3, Vec3::Zero()},
                      Crowd{"cube", 1500, Vec3(6, 6, 6), -0.5, -0.3, Vec3::Zero()},
                      Crowd{"plane", 1500, Vec3(20, 20, 0), -0.5, -0.3, Vec3::Zero()},
                      Crowd{"column", 1500, Vec3(0, 0, 200), -0.5, -0.3, Vec3::Zero()},
                      Crowd{"sizes_1e-3_to_1e3", 1500, Vec3(500, 500, 500), -3, 3, Vec3::Zero()},
                      Crowd{"far_away", 1500, Vec3(6, 6, 6), -3, -0.3, Vec3(1e6, -1e6, 1e6)},
                      Crowd{"one_place", 300, Vec3(0, 0, 0), -3, 3, Vec3::Zero()},
                      Crowd{"beyond_float", 300, Vec3(1e39, 1e39, 1e39), 38, 39, Vec3::Zero()}),
    [](const auto& param) {
      std::string name = param.param.name;
      std::replace(name.begin(), name.end(), '-', 'm');
      return name;
    });

TEST(BroadPhase, TouchingCountsAndAnUlpApartDoesNot) {
  Random random(8);
  BroadPhase broad_phase;
  Pairs pairs;
  for (int k = 0; k < 1000; ++k) {
    const Bounds a = around(random_in(random, Vec3::Constant(1e3)), Vec3::Constant(0.5));
    Bounds b{a.low, a.high};
    const int axis = k % 3;
    b.low[axis] = a.high[axis];
    b.high[axis] = b.low[axis] + 1.0;
    broad_phase.find({a, b}, {}, pairs);
    EXPECT_EQ(pairs.size(), 1U);
    b.low[axis] = std::nextafter(b.low[axis], kInfinity);
    broad_phase.find({a, b}, {}, pairs);
    EXPECT_TRUE(pairs.empty());
  }
}

TEST(BroadPhase, AWarmSearchAllocatesNothing) {
  Random random(9);
  std::vector<Bounds> bounds;
  for (int i = 0; i < 2000; ++i) {
    bounds.push_back(around(random_in(random, Vec3::Constant(10)), Vec3::Constant(0.5)));
  }
  BroadPhase broad_phase;
  Pairs pairs;
  broad_phase.find(bounds, {}, pairs);
  const lcp::AllocationCount allocations;
  broad_phase.find(bounds, {}, pairs);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace signorini::collision
