#include <signorini/lcp/row_coloring.h>

#include <gtest/gtest.h>
#include <random>
#include <set>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr unsigned kSeed = 20240701;

struct Groups {
  std::vector<int> starts{0};
  std::vector<int> resources;
  void add(std::initializer_list<int> used) {
    resources.insert(resources.end(), used);
    starts.push_back(static_cast<int>(resources.size()));
  }
  [[nodiscard]] int count() const { return static_cast<int>(starts.size()) - 1; }
};

TEST(RowColoring, GroupsOfOneColourShareNothing) {
  std::mt19937 random(kSeed);
  Groups groups;
  for (int k = 0; k < 500; ++k) {
    groups.add({static_cast<int>(random() % 100), static_cast<int>(random() % 100)});
  }
  RowColoring coloring;
  coloring.set(groups.starts, groups.resources, 100);
  ASSERT_LT(coloring.color_count(), RowColoring::kColors);
  for (int color = 0; color < coloring.color_count(); ++color) {
    std::set<int> seen;
    int count = 0;
    for (int k = 0; k < groups.count(); ++k) {
      if (coloring.colors()[k] != color) {
        continue;
      }
      ++count;
      const std::set<int> mine(groups.resources.begin() + groups.starts[k],
                               groups.resources.begin() + groups.starts[k + 1]);
      for (const int resource : mine) {
        EXPECT_TRUE(seen.insert(resource).second) << "colour " << color << ", group " << k;
      }
    }
    EXPECT_GT(count, 0) << "colour " << color << " is empty";
  }
}

TEST(RowColoring, AChainTakesTwoColours) {
  Groups groups;
  for (int k = 0; k < 10; ++k) {
    groups.add({k, k + 1});
  }
  RowColoring coloring;
  coloring.set(groups.starts, groups.resources, 11);
  EXPECT_EQ(coloring.color_count(), 2);
  EXPECT_EQ(coloring.colors()[0], 0);
  EXPECT_EQ(coloring.colors()[1], 1);
  EXPECT_EQ(coloring.colors()[2], 0);
}

TEST(RowColoring, MoreGroupsOnABlockThanColoursAreLeftToTheRest) {
  Groups groups;
  for (int k = 0; k < 100; ++k) {
    groups.add({0, 1 + k});
  }
  groups.add({200, 201});
  RowColoring coloring;
  coloring.set(groups.starts, groups.resources, 202);
  EXPECT_EQ(coloring.color_count(), RowColoring::kColors);
  EXPECT_EQ(coloring.colors()[RowColoring::kColors - 1], RowColoring::kColors - 1);
  EXPECT_EQ(coloring.colors()[RowColoring::kColors], RowColoring::kColors);
  EXPECT_EQ(coloring.colors()[99], RowColoring::kColors);
  EXPECT_EQ(coloring.colors()[100], 0);
}

TEST(RowColoring, NoGroupsTakeNoColours) {
  RowColoring coloring;
  coloring.set({}, {}, 0);
  EXPECT_EQ(coloring.color_count(), 0);
  const std::vector<int> starts{0};
  coloring.set(starts, {}, 5);
  EXPECT_EQ(coloring.color_count(), 0);
  EXPECT_TRUE(coloring.colors().empty());
}

}  // namespace
}  // namespace signorini::lcp
