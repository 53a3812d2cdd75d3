#pragma once

#include <signorini/lcp/symmetric_lcp.h>

#include <vector>

namespace signorini::lcp {

/// A set C of rows with regular M_CC and the principal pivot transform that belongs to it: with
/// z_C and w_N basic (N: the rows outside C),
///
///     z_C = M_CC^-1 (w_C - M_CN z_N - q_C),   w_N = q_N + M_NC z_C + M_NN z_N.
///
/// What the symmetric pivoting methods need of it, however it is kept. M is symmetric positive
/// semidefinite.
class PrincipalBasis {
 public:
  virtual ~PrincipalBasis() = default;

  /// Takes a problem, with empty C. Keeps a reference.
  virtual void reset(const SymmetricLcp& problem) = 0;
  /// The rate of every basic variable with the non-basic one of row j (z_j for j in N, w_j for
  /// j in C), n numbers. rate[j] is the Schur complement M_jj - M_jC M_CC^-1 M_Cj, which is 0 where
  /// row j depends on C, or (M_CC^-1)_jj; if it is 0 so is the rate of all w.
  virtual void column(int j, double* rate) = 0;
  /// column(j)[j] where it is at hand, else 1.
  [[nodiscard]] virtual double pivot(int j) const = 0;
  /// Moves j into C or out of it; column(j)[j] must be > 0. @return false if M_CC has no factor
  /// L D L^T with D > 0 afterwards, not even anew: M is not semidefinite, or C was dependent.
  [[nodiscard]] virtual bool exchange(int j) = 0;
  /// Makes C the wanted rows, without those that depend on the ones before them (pivots of at most
  /// `least_pivot`, M scaled to M_ii near 1). @return how many C has
  virtual int load(const std::vector<char>& wanted, double least_pivot) = 0;
  /// x_C = M_CC^-1 x_C; the other entries are neither read nor written.
  virtual void solve(double* x) = 0;
  /// Forms the transform of the present C anew. @return false if M_CC has no factor.
  [[nodiscard]] virtual bool refactor() = 0;
  /// Factorisations from scratch since reset().
  [[nodiscard]] virtual int factorizations() const = 0;

  [[nodiscard]] bool contains(int j) const { return member_[j] != 0; }

 protected:
  std::vector<char> member_;
};

}  // namespace signorini::lcp
