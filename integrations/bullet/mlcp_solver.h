#pragma once

#include <signorini/lcp/solver.h>

#include <BulletDynamics/MLCPSolvers/btMLCPSolverInterface.h>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>

namespace signorini::bullet {

/// Solves the mixed LCP that btMLCPSolver forms, for whoever uses that already:
///
///     MlcpSolver mlcp;
///     btMLCPSolver solver(&mlcp);
///
/// Find x with w = A x - b and lo <= x <= hi; w_i >= 0 where x_i = lo_i, w_i <= 0 where x_i = hi_i,
/// w_i = 0 in between. A row with a limit dependency n has the bounds lo_i x_n and hi_i x_n with
/// x_n of the answer: friction is coupled to the normal impulse (Bullet's own Lemke ignores the
/// dependency). A: n x n, dense, 1/kg; b in m/s; x in N s. Bounds of 1e10 and more, which Bullet
/// writes for infinity, are infinite.
///
/// ConstraintSolver does the same without the dense matrix (n^2 numbers) and takes rolling
/// friction, per-row cfm and cones too: prefer it.
class MlcpSolver : public btMLCPSolverInterface {
 public:
  struct Counters {
    static constexpr std::size_t kStatuses =
        static_cast<std::size_t>(lcp::Status::kInvalidInput) + 1;
    std::int64_t problems = 0;
    std::array<std::int64_t, kStatuses> by_status{};  ///< indexed by lcp::Status

    [[nodiscard]] std::int64_t count(lcp::Status status) const {
      return by_status[static_cast<std::size_t>(status)];
    }
    [[nodiscard]] std::int64_t not_solved() const {
      return problems - count(lcp::Status::kSolved) - count(lcp::Status::kSolvedToRounding);
    }
  };
  using NotSolved = std::function<void(const lcp::Result& result)>;

  /// Problems are handed to the solver `auto`. @throws std::invalid_argument for a setting out of
  /// its range.
  explicit MlcpSolver(const lcp::SolverSettings& settings = {});

  /// @param x where to start from, if anything in it is not zero; receives the answer, or the best
  /// iterate
  /// @param iteration_count @param use_sparsity not used
  /// @return true only if last_result() is solved: the certificate of x, recomputed from A, b, lo,
  /// hi and the dependencies in double (before a float build rounds x), meets the tolerance.
  /// Otherwise btMLCPSolver falls back to sequential impulses and counts it in getNumFallbacks().
  /// Data that make no problem (sizes that differ, a dependency out of range or on a row that
  /// itself depends, coupled bounds other than -+mu) end as kInvalidInput, detail names the row.
  bool solveMLCP(const btMatrixXu& A, const btVectorXu& b, btVectorXu& x, const btVectorXu& lo,
                 const btVectorXu& hi, const btAlignedObjectArray<int>& limit_dependencies,
                 int iteration_count, bool use_sparsity = true) override;

  /// Of the last problem: status, certificate, statistics and, in double, z = x.
  [[nodiscard]] const lcp::Result& last_result() const { return result_; }
  /// Sums since the solver was made. (btMLCPSolver with split impulse asks twice a group.)
  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// Is called for every problem that was not solved. null: nobody.
  void set_not_solved(NotSolved visitor) { not_solved_ = std::move(visitor); }

 private:
  std::string read(const btMatrixXu& A, const btVectorXu& b, const btVectorXu& lo,
                   const btVectorXu& hi, const btAlignedObjectArray<int>& limit_dependencies);

  std::unique_ptr<lcp::Solver> solver_;
  lcp::Problem problem_;
  lcp::Vector start_;
  lcp::Result result_;
  Counters counters_;
  NotSolved not_solved_;
};

}  // namespace signorini::bullet
