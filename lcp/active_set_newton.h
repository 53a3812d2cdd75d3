#pragma once

#include <signorini/lcp/scaled_problem.h>
#include <signorini/lcp/types.h>

#include <cstdint>
#include <vector>

namespace signorini::lcp {

/// Where a row of a bounded problem stands.
enum class RowState : std::uint8_t {
  kAtLower,  ///< x = lower, gradient >= 0
  kBetween,  ///< gradient = 0
  kAtUpper,  ///< x = upper, gradient <= 0
};

/// Newton's method on the active set (the primal-dual active set method: Hintermueller, Ito,
/// Kunisch, SIAM J. Optim. 13, 2003): rows at a bound stay there, the gradient of the others is
/// made zero, and rows whose sign is wrong change sides. From the right set it ends after one
/// factorisation; from one that is nearly right usually after a few; from any other it may cycle.
///
/// The linear systems may be singular (redundant rows): they are solved by proximal steps
/// x <- x - (A_BB + delta)^-1 gradient_B with one factor, which converge to the solution next to
/// the start where there is one.
class ActiveSetNewton {
 public:
  struct Limits {
    int factorizations = 6;    ///< >= 1
    double wrong_share = 0.1;  ///< gives up where more of the rows have a wrong sign at first
    int rounds = 4;            ///< of looking for an inside of what redundant rows leave open
  };

  /// Gives up early where the number of wrong rows does not fall.
  /// @param x in: the values of the rows between their bounds, to start from; out: of no use
  /// @param state in: the guess; out: the last set
  /// @return the residual of the last set (ScaledProblem::consider), +infinity if a factorisation
  /// failed
  double improve(ScaledProblem& problem, Vector& x, std::vector<RowState>& state,
                 const Limits& limits, double tolerance);

 private:
  double gradient_on_set(ScaledProblem& problem, const Vector& x,
                         const std::vector<RowState>& state);
  void solve_on_set(ScaledProblem& problem, Vector& x, const std::vector<RowState>& state);
  void seek_inside(ScaledProblem& problem, Vector& x, const std::vector<RowState>& state,
                   int rounds, double most_outside);
  int correct_set(const ScaledProblem& problem, const Vector& x, std::vector<RowState>& state);

  Vector e_, h_, dx_, gradient_, clamped_;
};

}  // namespace signorini::lcp
