#pragma once

#include <signorini/lcp/alart_curnier_function.h>
#include <signorini/lcp/body_newton_system.h>
#include <signorini/lcp/newton_system.h>
#include <signorini/lcp/sparse_form.h>
#include <signorini/lcp/whitened_rows.h>

#include <vector>

namespace signorini::lcp {

/// A problem in the unknowns of AlartCurnierFunction: x = z / (s t), u = s w / t = W x + b, with
/// one s a group that makes the group's diagonal block of W about 1 and t = |s q|_inf (1 if that is
/// 0), and the linear systems of Newton's method on it.
///
/// A factored M stays factored, unless a row's limits follow a row that has coupled limits itself.
class ScaledGroups {
 public:
  /// Takes over M, q and everything else. Reuses memory.
  void set(const Problem& problem);

  [[nodiscard]] const AlartCurnierFunction& function() const { return function_; }
  [[nodiscard]] const Vector& b() const { return b_; }

  /// u = W x.
  void multiply(const Vector& x, Vector& u);
  /// Factors A + B (W + alpha I) + couplings; where B = 0, A must be I. Keeps B until the last
  /// solve(). @return false if the matrix is singular; solve() must then not be called.
  [[nodiscard]] bool factor(const std::vector<AlartCurnierFunction::Block>& A,
                            const std::vector<AlartCurnierFunction::Block>& B,
                            const std::vector<AlartCurnierFunction::Coupling>& couplings,
                            double alpha) {
    return in_body_space_ ? body_system_.factor(A, B, couplings, alpha)
                          : system_.factor(A, B, couplings, alpha);
  }
  /// dx with that matrix times dx = -F. @return false if dx is not finite; it is then of no use.
  [[nodiscard]] bool solve(const Vector& F, Vector& dx) {
    return in_body_space_ ? body_system_.solve(F, dx) : system_.solve(F, dx);
  }

  /// What the factors hold, or held at most since set(); 0 if all matrices were dense.
  [[nodiscard]] std::int64_t factor_bytes() const {
    return in_body_space_ ? body_system_.factor_bytes() : system_.factor_bytes();
  }

  /// z = s t x.
  void to_caller(const Vector& x, Vector& z) const { z = t_ * s_.cwiseProduct(x); }
  /// x = z / (s t).
  void from_caller(const Vector& z, Vector& x) const { x = z.cwiseQuotient(s_) / t_; }

 private:
  [[nodiscard]] bool has_chained_limits(const Problem& problem);
  void set_given(const Problem& problem);
  void set_bodies(const Problem& problem);

  Vector s_, b_;
  double t_ = 1.0;
  bool in_body_space_ = false;
  std::vector<char> is_coupled_;  // of every row
  WhitenedRows rows_;             // of a factored problem, or
  SparseMatrix W_;                // the matrix, scaled
  SparseForm sparse_form_;
  Vector work_;
  std::vector<int> group_start_;  // of rows_
  Vector velocity_;
  AlartCurnierFunction function_;
  NewtonSystem system_;
  BodyNewtonSystem body_system_;
};

}  // namespace signorini::lcp
