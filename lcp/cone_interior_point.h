#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of ConeInteriorPoint. Dimensionless.
struct ConeInteriorPointSettings : SolverSettings {
  /// Interior point steps when max_iterations is -1; each is one factorisation.
  static constexpr int kDefaultIterations = 80;

  /// Most Newton steps of the polish, >= 0, each one factorisation; 0: no polish.
  int polish_steps = 200;
  /// Fraction of the way to the boundary that a step goes, in (0, 1): near 1 is fast and frail.
  double step_fraction = 0.99;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Interior point method over friction cones, finished by AlartCurnier.
///
/// The associated law is the optimality of a convex program where W is symmetric positive
/// semidefinite: minimise x.W x / 2 + b.x for x in K, that is u = W x + b in K*, x in K, x.u = 0.
/// Coulomb's law asks the same of De Saxce's u + mu |u_T| n in place of u, and is no optimum of
/// anything. In the scaled unknowns x, u of ScaledGroups the method follows
///
///     W x + b = v - sigma mu |v_T| n,   x o v = tau e,   x in int K, v in int K*,   tau -> 0,
///
/// with o the Jordan product in the coordinates (mu x_N, x_T), (v_N / mu, v_T), where K and K* are
/// the same second-order cone and e = (1, 0, 0). sigma = 0 is the associated law; sigma = 1
/// Coulomb's, whose shift is part of the Newton step. Steps are Mehrotra's predictor and corrector
/// under the scaling of Nesterov and Todd (Vandenberghe, The CVXOPT linear and quadratic cone
/// program solvers, 2010, sections 4 and 5; Alizadeh, Goldfarb, Second-order cone programming,
/// Mathematical Programming 95, 2003); they do not treat the shift, which is added here. Rows
/// outside cones, and the normal row of a cone with mu = 0, keep a barrier for each of their bounds
/// (cone_barrier.h).
///
/// Near tau = 0 the Newton matrix spans more digits than a double has. Where the path gets on no
/// longer, or its own number of steps is used up, AlartCurnier goes on from its best iterate with a
/// small proximal weight.
///
/// Made for symmetric positive semidefinite M and the associated law, where redundant contacts do
/// no harm. For Coulomb's law it is a fast attempt that may stall: the path can end at a fold, or
/// at no solution. Nothing is proven of a problem without one.
///
/// Takes all rows of problem.h but coupled limits. Statuses beside solved: kIterationLimit (the
/// caller's steps, or the polish's, are used up), kTimeLimit, kStalled (neither path nor polish
/// gets on), kNumericalBreakdown (a singular system, with no polish to follow); z is the best
/// iterate by certificate. A warm start is tried as an answer, and is where the polish starts if
/// the path finds nothing better; the path always starts cold. Cost: one sparse LU a step, in body
/// space of I + G^T D G for a factored M (BodyNewtonSystem), otherwise as NewtonSystem does it, and
/// two solves with it; statistics: iterations are interior point steps, factorizations those and
/// the polish's, factor_bytes what the sparse LU held. A problem of the last one's pattern
/// allocates nothing in body space, else what the analysis of an active set takes (unless
/// time_limit is set: the polish then gets what is left of it).
class ConeInteriorPoint : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit ConeInteriorPoint(const ConeInteriorPointSettings& settings = {});
  ~ConeInteriorPoint() override;

  [[nodiscard]] std::string_view name() const override { return "cone-interior-point"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;
  ConeInteriorPointSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
