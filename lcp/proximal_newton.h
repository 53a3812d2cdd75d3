#pragma once

#include <signorini/lcp/body_space_system.h>
#include <signorini/lcp/scaled_problem.h>
#include <signorini/lcp/solver.h>
#include <signorini/lcp/types.h>

#include <utility>
#include <vector>

namespace signorini::lcp {

/// Proximal points for a factored M,
///
///     x <- argmin over lower <= x <= upper of 1/2 x.A x + g.x + delta/2 |x - x_k|^2,
///
/// each by semismooth Newton on its dual, the convex piecewise quadratic
///
///     phi(u) = 1/2 |u|^2 + delta/2 |c(u)|^2 + ...,   x(u) = clamp(x_k - (G u + w_k) / (C +
///     delta)), grad phi(u) = u - G^T (x(u) - x_k),
///
/// in which u is the change of the bodies' velocity, with an exact line search (Rockafellar 1976;
/// Li, Sun, Toh, SIAM J. Optim. 28, 2018). Everything is an increment to x_k, so that nothing large
/// cancels. From a start that is nearly right it reaches the rounding floor in a few
/// factorisations, whatever is redundant.
class ProximalNewton {
 public:
  /// Outer steps from the problem's best x until the residual no longer halves or is a tenth of the
  /// tolerance.
  /// @param proximal delta > 0, of a unit diagonal
  /// @param most_steps outer steps
  /// @param most_factorizations of all steps together
  void improve(ScaledProblem& problem, BodySpaceSystem& system, double proximal, int most_steps,
               int most_factorizations, double tolerance, const Deadline& deadline);

 private:
  [[nodiscard]] bool step(ScaledProblem& problem, BodySpaceSystem& system, double proximal,
                          int most_factorizations, const Deadline& deadline);
  void dual_gradient(const ScaledProblem& problem, const WhitenedRows& rows, const Vector& u,
                     Vector& gradient);
  double line_search(const ScaledProblem& problem, const WhitenedRows& rows);

  Vector x_, point_, base_slack_, weight_, velocity_, slack_, change_, gradient_, direction_,
      g_direction_, e_, last_e_;
  std::vector<std::pair<double, double>> breaks_;
};

}  // namespace signorini::lcp
