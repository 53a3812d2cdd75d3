#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of AlartCurnier. Lengths are those of the scaled problem: dimensionless.
struct AlartCurnierSettings : SolverSettings {
  /// Newton steps when max_iterations is -1; each is one factorisation.
  static constexpr int kDefaultSteps = 10000;

  /// The first proximal weight alpha, > 0: large makes the Newton systems well conditioned and the
  /// outer iteration slow. It follows the inner iterations from there.
  double proximal = 0.1;
  /// Newton steps of one proximal problem, >= 1, before alpha is raised. What converges does so in
  /// few; the rest cycles between states of the contacts.
  int inner_steps = 12;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Proximal-point regularised Alart-Curnier Newton: exact Coulomb friction, and every other row of
/// problem.h (bounds, free rows, coupled limits, associated cones), for any M.
///
/// In unknowns scaled so that every diagonal block of M has the largest eigenvalue 1, with F of
/// AlartCurnierFunction,
///
///     x_k+1: F(x, W x + b + alpha_k (x - x_k)) = 0,
///
/// each found by a semismooth Newton method (Alart, Curnier 1991; proximal form: Acary, Bremond,
/// Huber, On solving contact problems with Coulomb friction, 2018, section 5.2). Redundant
/// contacts, for which plain Newton has a singular matrix, only make alpha matter. A step is halved
/// where |F| would be above its largest of the last four, once: shorter steps find minima of |F|
/// that are no zeros. u weighs rho = max(alpha, min(1, error))^-1/2 there. alpha falls while the
/// inner iterations succeed, fastest where they are few, and rises when they fail; where it failed
/// it does not come back at once. A start from which 20 proximal steps bring less than a tenth, or
/// that the largest alpha or the finest tolerance does not help, is given up for 0 (once): forces
/// that strain against each other, once there, stay.
///
/// No solution is promised: Coulomb's problem may have none, and the proximal iteration is known to
/// converge only where W is monotone on the cones. Statuses beside solved: kIterationLimit,
/// kTimeLimit, kStalled (alpha at its largest and no progress); z is the best iterate by
/// certificate.
/// Cost: one sparse LU a Newton step, in body space for a factored M (BodyNewtonSystem), else of
/// the active rows (NewtonSystem; dense up to its kDenseRows); statistics: iterations are proximal
/// steps, factorizations Newton steps, factor_bytes what the sparse LU held. A problem of the last
/// one's pattern allocates nothing in body space, else what the analysis of an active set takes.
class AlartCurnier : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit AlartCurnier(const AlartCurnierSettings& settings = {});
  ~AlartCurnier() override;

  [[nodiscard]] std::string_view name() const override { return "alart-curnier"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;
  AlartCurnierSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
