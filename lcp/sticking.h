#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of Sticking.
struct StickingSettings : SolverSettings {
  /// Sets tried when max_iterations is -1; each is one factorisation.
  static constexpr int kDefaultSets = 25;
};

/// Newton's method on the set of contacts that stick: with every contact in one of
///
///     open:     z_c = 0,                     wants w_N >= 0
///     sticking: w_c = 0,                     wants |z_T| <= mu z_N
///     sliding:  w_N = 0, z_T = -mu z_N w_T/|w_T|
///
/// the linear system is solved and contacts whose wish is not granted change sides, until none
/// does. That solves Coulomb's problem exactly; where nothing slides it solves the associated one
/// too, and the system is symmetric: one sparse Cholesky in body space a set. The friction of
/// sliding contacts is a fixed point around it, with the same factor; a slip below a hundredth of
/// the tolerance (times |q|) has no direction of its own, and friction keeps the one it has.
///
/// Where contacts are redundant the linear system has a plane of solutions. From the one next to
/// the start it is searched for one inside the cones by reflections (Motzkin, Schoenberg, The
/// relaxation method for linear inequalities, 1954), as ActiveSetNewton does with bounds.
///
/// Where the set is right and rounding hides the rest (a heavy body on light ones), one more factor
/// and residuals in long double find the last digits.
///
/// A warm start far below the tolerance is the answer, without a factorisation: what a stack at
/// rest costs. Made for resting and sticking contacts; with many that slide, or from a bad start,
/// the sets may cycle, and it gives up soon, from a start after three sets that are ten times worse
/// than it (one, if the start is solved): an attempt before a solver that does not (AutoSolver).
///
/// Takes factored M, cones, LCP rows and free rows. Endings beside solved: kIterationLimit,
/// kTimeLimit, kStalled, kNumericalBreakdown if a factorisation failed; z is the best iterate.
/// Cost: a factorisation a set and some solves; statistics: iterations are sets.
class Sticking : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit Sticking(const StickingSettings& settings = {});
  ~Sticking() override;

  [[nodiscard]] std::string_view name() const override { return "sticking"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;
  StickingSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
