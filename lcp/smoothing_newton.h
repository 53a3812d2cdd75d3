#pragma once

#include <signorini/lcp/scaled_problem.h>
#include <signorini/lcp/solver.h>
#include <signorini/lcp/types.h>

namespace signorini::lcp {

/// Newton's method on smoothed complementarity conditions, from a start that is near:
///
///     x = p(x - r),   r = A x + g,   p of smooth_clamp.h with mu > 0
///
/// (as a path to mu = 0: Burke, Xu, Math. Oper. Res. 23, 1998). Its solutions for mu > 0 are the
/// central path of an interior point, (x_i - lower_i) r_i = mu^2 where there is no upper bound, but
/// iterates may be beyond their bounds: a start need not be moved away from them, and no step is
/// cut where a row reaches one. A step solves the interior point's system, (A + diag(e) + proximal)
/// dx = h with e = (1 - p') / p', and aims at a twentieth of mu.
class SmoothingNewton {
 public:
  /// Memory for problems of this size: improve() then takes none.
  void reserve(Index rows);
  /// Steps from x until the residual (ScaledProblem::consider, x moved inside its bounds) is within
  /// the tolerance, two steps were short, a factorisation failed, time is over or most_steps were
  /// made, a factorisation each.
  /// @param x in: the start; out: of no use
  /// @return whether the problem's best residual is within the tolerance
  bool improve(ScaledProblem& problem, Vector& x, int most_steps, double tolerance,
               const Deadline& deadline);

 private:
  void linearise(const ScaledProblem& problem, const Vector& x, double mu, double next_mu);
  [[nodiscard]] double search(const ScaledProblem& problem, const Vector& x, double mu,
                              double next_mu);

  Vector r_, e_, h_, dx_, dr_, next_x_, next_r_, inside_;
};

}  // namespace signorini::lcp
