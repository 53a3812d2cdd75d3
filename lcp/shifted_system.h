#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/types.h>

#include <cstdint>
#include <memory>

namespace signorini::lcp {

/// The linear algebra of Newton's method on w = M z + q, in coordinates in which the diagonal is
/// one: A = S^-1 M S^-1, x = S z, S_i = sqrt(M_ii) (1 where M_ii is not positive). One
/// implementation factors in body space, the other factors the matrix that is given.
class ShiftedSystem {
 public:
  virtual ~ShiftedSystem() = default;

  /// Takes over the matrix. Reuses memory.
  virtual void set(const MatrixForm& M) = 0;
  /// Whether A is symmetric.
  [[nodiscard]] virtual bool is_symmetric() const = 0;
  /// S.
  [[nodiscard]] virtual const Vector& scale() const = 0;
  /// out = A x.
  virtual void multiply(const Vector& x, Vector& out) = 0;

  /// Factors A + diag(e) + proximal I. @param e >= 0; rows with e = +infinity do not move.
  /// Does nothing if that is what is factored. @return false if it cannot be factored
  [[nodiscard]] bool factor(const Vector& e, double proximal);
  /// Solves (A + diag(e) + proximal I) dx = h; dx_i = 0 where e_i = +infinity.
  /// @pre factor() returned true.
  virtual void solve(const Vector& h, Vector& dx) = 0;

  /// How many solves a factorisation costs, roughly, from counts of its flops.
  [[nodiscard]] virtual double factor_cost() const { return 1.0; }
  /// What the sparse back-end holds.
  [[nodiscard]] virtual std::int64_t factor_bytes() const = 0;
  /// Factorisations since set().
  [[nodiscard]] int factorizations() const { return factorizations_; }

 protected:
  void forget_factor();
  virtual bool factor_new(const Vector& e, double proximal) = 0;

 private:
  int factorizations_ = 0;
  bool factored_ = false;
  double proximal_ = 0.0;
  Vector e_;
};

/// For an M that is given whole: sparse Cholesky where M is symmetric and the shifted matrix turns
/// out to be positive definite; else sparse LU with partial pivoting, or dense LU where more than a
/// quarter of M is not zero.
[[nodiscard]] std::unique_ptr<ShiftedSystem> make_given_matrix_system();

}  // namespace signorini::lcp
