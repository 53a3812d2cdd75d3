#pragma once

namespace signorini::lcp {

/// Counts every allocation of the process (malloc, calloc, realloc, aligned forms, hence operator
/// new and Eigen) while it lives, on all threads. Link allocation_count.cpp into the test.
/// What a sparse back-end allocates (lcp/back_end.h) is counted apart. signorini_test() keeps
/// OpenBLAS from starting threads of its own, which allocate when they please; by hand, set
/// OPENBLAS_NUM_THREADS=1.
class AllocationCount {
 public:
  AllocationCount();
  [[nodiscard]] long count() const;
  [[nodiscard]] long back_end_count() const;

 private:
  long at_start_;
  long back_end_at_start_;
};

}  // namespace signorini::lcp
