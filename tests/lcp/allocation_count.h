#pragma once

namespace signorini::lcp {

/// Counts every allocation of the process (malloc, calloc, realloc, aligned forms, hence operator
/// new and Eigen) while it lives, on all threads. Link allocation_count.cpp into the test.
/// What a sparse back-end allocates (lcp/back_end.h) is counted apart.
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
