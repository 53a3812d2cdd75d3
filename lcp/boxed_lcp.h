#pragma once

#include <signorini/lcp/solver.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace signorini::lcp {

/// The mixed LCP that engines form for themselves (ODE, DART, Bullet), with their signs: find x
/// with w = A x - b and, for every row,
///
///     lower_i <= x_i <= upper_i,
///     w_i >= 0 where x_i = lower_i,   w_i <= 0 where x_i = upper_i,   w_i = 0 in between;
///
/// a row with a normal row n (ODE's findex) has the bounds -+ upper_i x_n instead, x_n of the
/// answer: friction. A: n x n, dense. Units are the host's: with x in N s and b in m/s, A is in
/// 1/kg.
struct BoxedLcp {
  Matrix A;                     ///< n x n
  Vector b;                     ///< n
  Vector lower, upper;          ///< n; coupled rows: -mu and mu
  std::vector<int> normal_row;  ///< n; -1: none
  Vector x;  ///< n; where to start from, if anything in it is not zero; receives the answer

  /// All members for n rows; keeps their memory.
  void resize(Index n);
};

/// Solves boxed LCPs for a host that knows "solved" and "not solved", and keeps what it needs to
/// tell more: the last result, counters, and a visitor for what was not solved. Not for two threads
/// at once.
class BoxedLcpSolver {
 public:
  /// How many problems ended how.
  struct Counters {
    static constexpr std::size_t kStatuses = static_cast<std::size_t>(Status::kInvalidInput) + 1;
    std::int64_t problems = 0;
    std::array<std::int64_t, kStatuses> by_status{};  ///< indexed by Status

    [[nodiscard]] std::int64_t count(Status status) const {
      return by_status[static_cast<std::size_t>(status)];
    }
    [[nodiscard]] std::int64_t not_solved() const {
      return problems - count(Status::kSolved) - count(Status::kSolvedToRounding);
    }
  };
  /// Who is told of a problem that was not solved.
  using NotSolved = std::function<void(const Result& result)>;

  /// Problems are handed to the solver `auto`. @throws std::invalid_argument for a setting out of
  /// its range.
  explicit BoxedLcpSolver(const SolverSettings& settings = {});

  /// @param lcp its x receives the answer or the best iterate; it stays as it was where the data
  /// make no problem (sizes that differ, a normal row out of range or on a row that itself has one,
  /// coupled bounds other than -+mu: kInvalidInput, detail names the row), and is NaN where they
  /// hold NaN or infinity (kInvalidInput)
  /// @return whether last_result() is solved: the certificate of x, recomputed from A, b, the
  /// bounds and the normal rows, meets the tolerance
  bool solve(BoxedLcp& lcp);

  /// For a host whose data cannot be made a BoxedLcp: ends as kInvalidInput, counted and told like
  /// every other problem. @return false
  bool refuse(std::string why);

  /// Of the last problem: status, certificate, statistics, z = x.
  [[nodiscard]] const Result& last_result() const { return result_; }
  /// Sums since the solver was made.
  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// Is called for every problem that was not solved. null: nobody.
  void set_not_solved(NotSolved visitor) { not_solved_ = std::move(visitor); }

 private:
  std::string read(const BoxedLcp& lcp);
  bool count();

  std::unique_ptr<Solver> solver_;
  Problem problem_;
  Result result_;
  Counters counters_;
  NotSolved not_solved_;
};

}  // namespace signorini::lcp
