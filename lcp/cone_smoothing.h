#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of ConeSmoothing.
struct ConeSmoothingSettings : SolverSettings {
  /// Newton steps when max_iterations is -1; each is one factorisation.
  static constexpr int kDefaultSteps = 100;
};

/// Newton's method along a smoothed path: exact Coulomb friction, the associated law, and rows with
/// bounds, for any M.
///
/// In the scaled unknowns of ScaledGroups, with F of SmoothedCones,
///
///     F(x, W x + b; mu) = 0,   mu -> 0,
///
/// from x = 0 (or a warm start) and the mu that is its error, the root of the mean square of F for
/// mu = 0. A step solves (A + B (W + alpha)) dx = -F - dF/dmu dmu, alpha = 1e-9 (which changes the
/// path, not the answer), and aims at half of mu where the error is below 3 % of mu, else at the
/// path; from a residual of 1e-4 on at the less the nearer the path is, down to 2 %. It is halved
/// until the error is within the mu it comes to or has fallen by a tenth of what it might; after
/// five steps in a row below a tenth mu is ten times as large. (Non-interior path following: Burke,
/// Xu, Math. Oper. Res. 23, 1998; over cones: Fukushima, Luo, Tseng, SIAM J. Optim. 12, 2001; they
/// do not treat De Saxce's shift.)
///
/// Unlike an interior point's, iterates may be outside their cones, so that any start is one;
/// unlike AlartCurnier's, its systems change smoothly where contacts come apart or begin to slide.
/// It takes 12 to 38 steps for stacks at rest, 24 to 79 for piles of 200 spheres, most of which
/// AlartCurnier takes hundreds for or does not solve; it may fail where that one does not.
///
/// No solution is promised: Coulomb's problem may have none, and the path may have a fold. Nothing
/// is proven of a problem without one. Takes no coupled limits. Statuses beside solved:
/// kIterationLimit, kTimeLimit, kStalled (F sees no error where the certificate does),
/// kNumericalBreakdown (a system that stays singular up to alpha = 1e-3, or a step that is not
/// finite); z is the best iterate by certificate. Cost: one sparse LU a step, or more where one is
/// singular and alpha is raised, which the result says, in body space for a factored M
/// (BodyNewtonSystem), otherwise as NewtonSystem does it; statistics: iterations are steps,
/// factor_bytes what the sparse LU held. A problem of the last one's
/// pattern allocates nothing in body space.
class ConeSmoothing : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit ConeSmoothing(const ConeSmoothingSettings& settings = {});
  ~ConeSmoothing() override;

  [[nodiscard]] std::string_view name() const override { return "cone-smoothing"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;
  ConeSmoothingSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
