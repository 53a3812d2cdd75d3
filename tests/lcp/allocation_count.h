#pragma once

namespace signorini::lcp {

/// Counts every allocation of the process (malloc, calloc, realloc, aligned forms, hence operator
/// new and Eigen) while it lives, on all threads. Link allocation_count.cpp into the test.
class AllocationCount {
 public:
  AllocationCount();
  [[nodiscard]] long count() const;

 private:
  long at_start_;
};

}  // namespace signorini::lcp
