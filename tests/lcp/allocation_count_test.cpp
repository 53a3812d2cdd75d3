#include "allocation_count.h"

#include <signorini/lcp/back_end.h>
#include <signorini/lcp/types.h>

#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <thread>
#include <vector>

namespace signorini::lcp {
namespace {

/// Keeps the compiler from leaving an allocation out.
template <typename T>
void use(T* pointer) {
  asm volatile("" : : "g"(pointer) : "memory");
}

TEST(AllocationCount, StartsAtZeroAndCountsNothingWhereNothingIsAllocated) {
  const AllocationCount allocations;
  std::vector<double> empty;
  use(&empty);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(AllocationCount, CountsOperatorNewMallocAndTheirAlignedForms) {
  const AllocationCount allocations;
  const auto one = std::make_unique<int>(1);
  use(one.get());
  EXPECT_EQ(allocations.count(), 1);
  void* memory = std::malloc(100);
  use(memory);
  memory = std::realloc(memory, 100000);
  use(memory);
  EXPECT_EQ(allocations.count(), 3);
  std::free(memory);
  struct alignas(64) Wide {
    double values[8];
  };
  const auto wide = std::make_unique<Wide>();
  use(wide.get());
  EXPECT_EQ(allocations.count(), 4);
}

TEST(AllocationCount, CountsEigen) {
  const AllocationCount allocations;
  Vector v(10);
  use(v.data());
  EXPECT_EQ(allocations.count(), 1);
  v.setZero(10);
  EXPECT_EQ(allocations.count(), 1);
  v.setZero(11);
  use(v.data());
  EXPECT_EQ(allocations.count(), 2);
}

TEST(AllocationCount, CountsABackEndApart) {
  const AllocationCount allocations;
  {
    const BackEndScope scope;
    const auto one = std::make_unique<int>(1);
    use(one.get());
    EXPECT_EQ(allocations.back_end_count(), 1);
    EXPECT_EQ(allocations.count(), 0);
  }
  const auto two = std::make_unique<int>(2);
  use(two.get());
  EXPECT_EQ(allocations.back_end_count(), 1);
  EXPECT_EQ(allocations.count(), 1);
}

TEST(AllocationCount, CountsOtherThreads) {
  const AllocationCount allocations;
  std::thread([] {
    const auto one = std::make_unique<int>(1);
    use(one.get());
  }).join();
  EXPECT_GE(allocations.count(), 1);
}

}  // namespace
}  // namespace signorini::lcp
