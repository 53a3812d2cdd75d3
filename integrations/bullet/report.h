#pragma once

#include <signorini/integrations/bullet/contact_solver.h>
#include <signorini/lcp/result.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace signorini::bullet {

/// How one island of a group was solved.
struct IslandReport {
  bool is_push = false;  ///< the split impulse's problem, not that of the velocities
  int bodies = 0;        ///< movable ones
  int contacts = 0;
  int joint_rows = 0;
  int rows = 0;  ///< of the problem: joints, normals, tangents, rolling
  Route route = Route::kNone;
  /// Whether the impulses that Bullet was given are an answer. If not, they are the best iterate;
  /// after kInvalidInput they are 0.
  lcp::Status status = lcp::Status::kNotRun;
  /// Of the impulses in double, whatever precision Bullet stores. Quick where it is solved: small
  /// residuals are bounds (lcp::Certifier::certify_quickly()).
  lcp::Certificate certificate;
  lcp::Statistics statistics;
  std::string solver;  ///< the name of the lcp solver that gave the impulses
  std::string detail;  ///< why it ended so; empty if there is nothing to add
};

/// What was done in a step: one entry an island with rows, and one more where the split impulse
/// had something to push.
struct StepReport {
  std::vector<IslandReport> islands;
  double seconds = 0.0;  ///< wall time of all solveGroup()

  /// False if any island was not.
  [[nodiscard]] bool is_solved() const;
  /// Nothing done yet; keeps the memory.
  void clear() {
    islands.clear();
    seconds = 0.0;
  }
};

/// Sums since the solver was made, or reset().
struct Counters {
  static constexpr std::size_t kStatuses = static_cast<std::size_t>(lcp::Status::kInvalidInput) + 1;
  static constexpr std::size_t kRoutes = static_cast<std::size_t>(Route::kCoupled) + 1;

  std::int64_t groups = 0;                          ///< calls of solveGroup() with rows to solve
  std::int64_t groups_solved = 0;                   ///< those with every island solved
  std::int64_t islands = 0;                         ///< problems: islands, and their split impulses
  std::array<std::int64_t, kStatuses> by_status{};  ///< islands, indexed by lcp::Status
  std::array<std::int64_t, kRoutes> by_route{};     ///< islands, indexed by Route
  double seconds = 0.0;                             ///< wall time of all solveGroup()

  [[nodiscard]] std::int64_t count(lcp::Status status) const {
    return by_status[static_cast<std::size_t>(status)];
  }
  [[nodiscard]] std::int64_t count(Route route) const {
    return by_route[static_cast<std::size_t>(route)];
  }
  /// Islands whose impulses are not an answer.
  [[nodiscard]] std::int64_t not_solved() const {
    return islands - count(lcp::Status::kSolved) - count(lcp::Status::kSolvedToRounding);
  }
};

}  // namespace signorini::bullet
