#include <signorini/lcp/thread_team.h>

#include "tests/lcp/allocation_count.h"

#include <atomic>
#include <gtest/gtest.h>
#include <vector>

namespace signorini::lcp {
namespace {

TEST(ThreadTeam, EveryMemberWorksOnceARun) {
  for (const int size : {1, 2, 3, 4}) {
    ThreadTeam team(size);
    EXPECT_EQ(team.size(), size);
    std::vector<int> calls(size, 0);
    auto work = [&](int member) { ++calls[member]; };
    for (int k = 0; k < 200; ++k) {
      team.run(work);
    }
    EXPECT_EQ(calls, std::vector<int>(size, 200));
  }
}

/// What a member wrote before wait() every member reads after it.
TEST(ThreadTeam, MembersSeeEachOthersWorkAfterWaiting) {
  constexpr int kSize = 3;
  constexpr int kSteps = 300;
  ThreadTeam team(kSize);
  std::vector<int> value(kSize, 0);
  std::atomic<int> wrong{0};
  auto work = [&](int member) {
    for (int step = 1; step <= kSteps; ++step) {
      value[member] = step;
      team.wait();
      for (const int seen : value) {
        wrong += seen == step ? 0 : 1;
      }
      team.wait();
    }
  };
  team.run(work);
  EXPECT_EQ(wrong.load(), 0);
}

TEST(ThreadTeam, RunsAllocateNothing) {
  ThreadTeam team(3);
  std::atomic<int> count{0};
  auto work = [&](int) { ++count; };
  team.run(work);
  const AllocationCount allocations;
  team.run(work);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(count.load(), 6);
}

TEST(ThreadTeam, IdleTeamsEnd) {
  for (int k = 0; k < 20; ++k) {
    const ThreadTeam team(4);
  }
}

}  // namespace
}  // namespace signorini::lcp
