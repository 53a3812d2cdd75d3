#pragma once

#include <signorini/lcp/shifted_system.h>
#include <signorini/lcp/sparse_cholesky.h>
#include <signorini/lcp/whitened_rows.h>

#include <memory>

namespace signorini::lcp {

/// A factored M, A = G G^T + C, by Woodbury's identity:
///
///     (A + diag(e) + proximal)^-1 = D - D G H^-1 G^T D,   D = (C + e + proximal)^-1,
///
/// with H = I + G^T D G (whitened_rows.h) by sparse Cholesky. A is never formed.
class BodySpaceSystem final : public ShiftedSystem {
 public:
  void set(const MatrixForm& M) override;  ///< @pre M is a FactoredMatrix
  [[nodiscard]] bool is_symmetric() const override { return true; }
  [[nodiscard]] const Vector& scale() const override { return rows_.scale(); }
  void multiply(const Vector& x, Vector& out) override;
  void solve(const Vector& h, Vector& dx) override;

  [[nodiscard]] double factor_cost() const override;
  /// Of one factorisation of H. @pre set()
  [[nodiscard]] double factor_flops() const { return cholesky_->counts().flops; }
  [[nodiscard]] std::int64_t factor_bytes() const override {
    return static_cast<std::int64_t>(cholesky_->counts().bytes);
  }
  [[nodiscard]] const WhitenedRows& rows() const { return rows_; }
  /// u <- H^-1 u. @pre factor() returned true.
  void solve_in_body_space(Vector& u) { cholesky_->solve(u); }

 protected:
  bool factor_new(const Vector& e, double proximal) override;

 private:
  WhitenedRows rows_;
  std::unique_ptr<SparseCholesky> cholesky_ = make_sparse_cholesky();
  Vector d_, u_;
};

}  // namespace signorini::lcp
