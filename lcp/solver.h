#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solve_recorder.h>

#include <chrono>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace signorini::lcp {

/// What every solver is told. Its own settings derive from these.
struct SolverSettings {
  /// Both residuals of the certificate must be at most this. Dimensionless, in (0, 1): z = 0 always
  /// has a unit-free residual of at most 1. 1e-8 is what the field's exact solvers aim at; below
  /// 1e-12 most contact problems meet their rounding floor.
  double tolerance = 1e-8;
  /// Pivots, sweeps or iterations, the solver's own unit; -1: the solver's own default.
  int max_iterations = -1;
  /// Seconds of wall time, > 0. A solve limited by time does not give the same answer twice.
  double time_limit = std::numeric_limits<double>::infinity();
  /// Is told of every solve; null: nobody. Not owned: it must outlive the solver, and be safe for
  /// threads if solvers of several threads share it.
  SolveRecorder* recorder = nullptr;
  /// Fills Result::island_certificates. Doubles the cost of certifying; the status is that of the
  /// whole problem either way. With it a repeated solve allocates nothing more either.
  bool certify_islands = false;
  /// Certifies by Certifier::certify_quickly(): the same verdict and the same bound on what is
  /// solved, at O(n) instead of a product with |M|; floors and small residuals are bounds, the
  /// backward error is left out. For many solves a second.
  bool quick_certificate = false;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// A clock that a solver asks now and then.
class Deadline {
 public:
  explicit Deadline(double seconds);
  [[nodiscard]] bool passed() const;
  /// passed() of steps that cost little more than a look at the clock does: at every eighth, where
  /// a problem has few rows. @param step counts every look
  [[nodiscard]] bool passed_at(int step, int rows) const {
    constexpr int kFewRows = 100;
    return (rows > kFewRows || step % 8 == 0) && passed();
  }
  [[nodiscard]] double elapsed_seconds() const;
  /// Below 0 once it has passed.
  [[nodiscard]] double left_seconds() const { return seconds_ - elapsed_seconds(); }

 private:
  std::chrono::steady_clock::time_point start_;
  double seconds_;
};

/// One solver: its settings and its workspace, which grows to the largest problem it has seen. Not
/// for two threads at once; two solvers share nothing.
class Solver {
 public:
  virtual ~Solver() = default;

  /// The name used by make_solver() and signorini-solve.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Why this solver cannot take this problem ("takes an LCP; row 3 is free"), or empty if it can.
  [[nodiscard]] virtual std::string refuses(const Problem& problem) const = 0;

  /// Solves the problem; whatever the solver believes, status and certificate come from certify(),
  /// judge() and judge_ray() on the caller's data.
  ///
  /// @param warm_start null, or n numbers to start from, for solvers that can use them; others
  /// ignore it
  /// @throws std::invalid_argument for wrong shapes, for wrong settings, and for a problem that
  /// refuses() names; result is then untouched. Bad values (NaN) end in kInvalidInput instead.
  void solve(const Problem& problem, Result& result, const Vector* warm_start = nullptr);
  /// solve() as a part of something larger that has `seconds` of wall time left: ends by then, if
  /// the time limit of the settings is not before. With 0 or less it ends at the first look at the
  /// clock. Solver and workspace stay as they are, so that parts may share them.
  void solve_within(double seconds, const Problem& problem, Result& result,
                    const Vector* warm_start = nullptr);

 protected:
  virtual const SolverSettings& settings() const = 0;
  /// The iteration. Writes result.z (n finite numbers: the best iterate; solve() makes it 0, and
  /// says so, where they are not finite), result.ray if it ended on one, result.detail and
  /// result.statistics, and returns what ended it if the certificate does not say solved:
  /// kIterationLimit, kTimeLimit, kStalled, kNumericalBreakdown, or kRayUnproven together with
  /// result.ray. Called with n >= 1 and finite data.
  virtual Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                         Result& result) = 0;
  /// Fills certificate and w of result.z. A solver whose z was certified on the way, as its
  /// settings say, may take that over.
  virtual void certify(const Problem& problem, Result& result);
  /// What is in the result from before, whose texts have room to write new ones into.
  virtual void recycle(std::vector<Attempt>& /*attempts*/) {}

 private:
  void judge_result(const Problem& problem, Status ending, Result& result) const;
  void record(const Problem& problem, double seconds, const Vector* warm_start,
              Result& result) const;
  void certify_islands(const Problem& problem, Result& result);

  Certifier certifier_;
  Islands islands_;
};

/// Names that make_solver() knows, in the order to show them.
[[nodiscard]] std::span<const std::string_view> solver_names();

/// A solver by name, with its default settings but these.
/// @throws std::invalid_argument that lists the known names.
[[nodiscard]] std::unique_ptr<Solver> make_solver(std::string_view name,
                                                  const SolverSettings& settings = {});

}  // namespace signorini::lcp
