#pragma once

namespace signorini::lcp {

/// Counts every allocation of the process (malloc, calloc, realloc, aligned forms, hence operator
/// new and Eigen) while it lives, on all threads; while none lives, none is counted, so that times
/// are what they are without. Link allocation_count.cpp into the test.
/// What a sparse back-end allocates (lcp/back_end.h) is counted apart. signorini_test() keeps
/// OpenBLAS from starting threads of its own, which allocate when they please; by hand, set
/// OPENBLAS_NUM_THREADS=1.
class AllocationCount {
 public:
  AllocationCount();
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;
  [[nodiscard]] long count() const;
  [[nodiscard]] long back_end_count() const;

 private:
  long at_start_;
  long back_end_at_start_;
};

/// While it lives, this thread is given no memory after its next `allowed` allocations: malloc and
/// its like return null, operator new throws. A sparse back-end (lcp/back_end.h) is given what it
/// asks for: Eigen's SparseLU writes through a null of malloc. Not under the sanitizers, which own
/// malloc.
class NoMemoryAfter {
 public:
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr bool kWorks = false;
#else
  static constexpr bool kWorks = true;
#endif
  explicit NoMemoryAfter(long allowed);
  ~NoMemoryAfter();
  NoMemoryAfter(const NoMemoryAfter&) = delete;
  NoMemoryAfter& operator=(const NoMemoryAfter&) = delete;
};

}  // namespace signorini::lcp
