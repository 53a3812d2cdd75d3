#pragma once

#include <signorini/lcp/row_groups.h>
#include <signorini/lcp/solver.h>
#include <signorini/lcp/sweeps.h>

#include <cstdint>
#include <memory>

namespace signorini::lcp {

/// The number type of an iterate.
enum class Precision : std::uint8_t { kDouble, kFloat };

/// Settings that all solvers by sweeps share.
struct SweepSettings : SolverSettings {
  /// Iterations when max_iterations is -1. Piles of boxes with equal masses need 1e2 to 1e4 sweeps
  /// to 1e-8, tall towers and mass ratios far more. A row of contact costs 4 to 9 ns a sweep.
  static constexpr int kDefaultIterations = 10000;

  /// Iterations between two looks at the residual, >= 1. A look costs two to four sweeps and also
  /// recomputes what is kept of M z; larger spends less on looking and overshoots more. The first
  /// looks come earlier, at iterations 0, 1, 2, 4, ...
  int check_period = 16;
  /// Of the iterate and of what is kept of M z. Float moves half the memory, and its iterate stops
  /// getting better at residuals of 1e-7 to 1e-4; certificates are from double whatever this says.
  Precision precision = Precision::kDouble;
  /// Of factored problems; a given M is swept in its own order. A coloured sweep takes half to two
  /// thirds of the time of a natural one, whose rows wait for each other. To 1e-2 .. 1e-6 natural
  /// Pgs needs as many sweeps on piles of spheres and up to 40 % fewer on pyramids listed from the
  /// ground up, so that coloured ends first; tall towers are the exception (a third of the sweeps).
  RowOrder row_order = RowOrder::kColoured;
  /// Threads that share the rows of a colour, >= 1; the bits are the same for any number. Only for
  /// factored problems in coloured order, and only worth it for many thousand rows: members of the
  /// team meet after every colour, and looks at the residual take one thread. The threads live as
  /// long as the solver.
  int threads = 1;
  /// Lets a processor that can multiply and add in one operation do so: 1.15 (natural) to 1.4 times
  /// (coloured) as fast over factored problems, but then the bits depend on the processor.
  bool fused = false;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// @throws std::invalid_argument unless omega is in (0, 2).
void check_relaxation(double omega);

/// What the solvers by sweeps share: everything but the step from one iterate to the next.
///
/// Takes every problem of problem.h but cones. Over a factored M the rows are packed
/// (packed_rows.h) and body-space velocities are kept, so that a sweep is O(entries of J); over a
/// dense or sparse M, M z is kept (column_sweeps.h). Coupled rows use the bounds -+ mu z_n of the
/// newest z_n; free rows are not clamped. What is kept drifts by rounding and is recomputed from z
/// at every look at the residual.
///
/// Rows without a usable diagonal (M_ii <= 0, or 1 / M_ii overflows): the row's own one-dimensional
/// problem is solved by the bound w_i points to (lower_i where w_i > 0, upper_i where w_i < 0);
/// where that bound is infinite no step exists and z_i is kept. Result::detail then says so.
///
/// Endings beside solved (which certify() and judge() alone can give): kIterationLimit, kTimeLimit,
/// kStalled only if the iterate repeats itself bit for bit, so that more sweeps are proven useless,
/// kNumericalBreakdown if a number overflowed or the residual grew by 1 / eps (M is then not
/// positive semidefinite). z is the iterate with the smallest residual that was looked at.
/// Deterministic but for time_limit; the bits are the same on every x86-64 processor unless
/// `fused`.
class SweepSolver : public Solver {
 public:
  ~SweepSolver() override;
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  SweepSolver();

  [[nodiscard]] virtual const SweepSettings& sweep_settings() const = 0;
  /// omega of every step, in (0, 2).
  [[nodiscard]] virtual double relaxation() const { return 1.0; }
  /// Called before the first iteration of a solve.
  virtual void begin() {}
  /// One iteration.
  virtual void advance(Sweeps<double>& sweeps) = 0;
  virtual void advance(Sweeps<float>& sweeps) = 0;
  /// Forgets what the next iteration depends on beside the iterate. @return whether there was any.
  virtual bool forget() { return false; }

  [[nodiscard]] const SolverSettings& settings() const final { return sweep_settings(); }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) final;

 private:
  class Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
