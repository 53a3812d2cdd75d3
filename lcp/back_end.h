#pragma once

namespace signorini::lcp {

/// Stands around the work of a sparse factorisation's back-end (Eigen's, CHOLMOD), and around the
/// analysis of a new pattern by ours: what this thread allocates meanwhile is the back-end's,
/// reported as Statistics::factor_bytes, and not ours. The tests that count our allocations leave
/// it out.
class BackEndScope {
 public:
  BackEndScope() { ++depth(); }
  ~BackEndScope() { --depth(); }
  BackEndScope(const BackEndScope&) = delete;
  BackEndScope& operator=(const BackEndScope&) = delete;

  /// Whether one stands around the caller.
  [[nodiscard]] static bool is_active() { return depth() > 0; }

 private:
  static int& depth() {
    static thread_local int depth = 0;
    return depth;
  }
};

}  // namespace signorini::lcp
