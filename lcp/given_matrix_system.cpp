#include <signorini/lcp/shifted_system.h>
#include <signorini/lcp/sparse_cholesky.h>
#include <signorini/lcp/sparse_lu.h>

#include <Eigen/LU>
#include <Eigen/SparseLU>
#include <cmath>
#include <vector>

namespace signorini::lcp {
namespace {

// Rounding in the caller's assembly of a symmetric matrix, of the geometric mean of the diagonals.
constexpr double kAsymmetry = 1e-12;

class GivenMatrixSystem final : public ShiftedSystem {
 public:
  void set(const MatrixForm& M) override {
    forget_factor();
    if (const auto* sparse = std::get_if<SparseMatrix>(&M)) {
      A_ = *sparse;
      A_.makeCompressed();
    } else if (const auto* dense = std::get_if<Matrix>(&M)) {
      A_ = dense->sparseView(1.0, 0.0);  // every number that is not zero
    } else {
      A_ = std::get<FactoredMatrix>(M).form();
    }
    A_.prune([](Index, Index, double value) { return value != 0.0; });
    const Index n = A_.rows();
    scale_.resize(n);
    for (Index i = 0; i < n; ++i) {
      const double diagonal = A_.coeff(i, i);
      scale_[i] = diagonal > 0.0 ? std::sqrt(diagonal) : 1.0;
    }
    for (Index j = 0; j < n; ++j) {
      for (SparseMatrix::InnerIterator it(A_, j); it; ++it) {
        it.valueRef() /= scale_[it.row()] * scale_[j];
      }
    }
    transpose_ = A_.transpose();
    const SparseMatrix difference = A_ - transpose_;
    symmetric_ = difference.nonZeros() == 0 || difference.coeffs().abs().maxCoeff() <= kAsymmetry;
    dense_ = static_cast<double>(A_.nonZeros()) > 0.25 * static_cast<double>(n * n);
    set_shifted_pattern();
    use_cholesky_ = symmetric_;
    if (symmetric_) {
      cholesky_->analyse(lower_);
    }
    lu_is_analysed_ = false;
  }
  [[nodiscard]] bool is_symmetric() const override { return symmetric_; }
  [[nodiscard]] const Vector& scale() const override { return scale_; }

  void multiply(const Vector& x, Vector& out) override { out.noalias() = A_ * x; }

  void solve(const Vector& h, Vector& dx) override {
    dx = h;
    for (Index i = 0; i < dx.size(); ++i) {
      if (fixed_[i] != 0) {
        dx[i] = 0.0;
      }
    }
    if (use_cholesky_) {
      cholesky_->solve(dx);
    } else if (dense_) {
      dx = dense_lu_.solve(dx).eval();
    } else {
      dx = sparse_lu_.solve(dx).eval();
    }
  }

  [[nodiscard]] std::int64_t factor_bytes() const override {
    if (use_cholesky_) {
      return static_cast<std::int64_t>(cholesky_->counts().bytes);
    }
    const std::int64_t numbers =
        dense_ ? dense_lu_.matrixLU().size() : std::int64_t{sparse_lu_.nnzL()} + sparse_lu_.nnzU();
    return numbers * static_cast<std::int64_t>(sizeof(double));
  }

 protected:
  bool factor_new(const Vector& e, double proximal) override {
    fixed_.resize(e.size());
    for (Index i = 0; i < e.size(); ++i) {
      fixed_[i] = std::isinf(e[i]) ? 1 : 0;
    }
    if (use_cholesky_) {
      shift(lower_, e, proximal);
      if (cholesky_->factor(lower_)) {
        return true;
      }
      use_cholesky_ = false;  // not semidefinite after all
    }
    if (dense_) {
      shift(whole_, e, proximal);
      dense_matrix_ = whole_;
      dense_lu_.compute(dense_matrix_);
      return dense_lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0;
    }
    shift(whole_, e, proximal);
    require_memory_of_lu(whole_.rows(), whole_.nonZeros());
    if (!lu_is_analysed_) {
      sparse_lu_.analyzePattern(whole_);
      lu_is_analysed_ = true;
    }
    sparse_lu_.factorize(whole_);
    return sparse_lu_.info() == Eigen::Success;
  }

 private:
  /// A with a full diagonal, and its lower triangle: the patterns that every factor shares.
  void set_shifted_pattern() {
    SparseMatrix identity(A_.rows(), A_.rows());
    identity.setIdentity();
    whole_ = A_ + 0.0 * identity;
    whole_.makeCompressed();
    lower_ = whole_.triangularView<Eigen::Lower>();
    lower_.makeCompressed();
  }

  /// target <- A + diag(e) + proximal; a fixed row and column of the identity where e is infinite.
  void shift(SparseMatrix& target, const Vector& e, double proximal) const {
    for (Index j = 0; j < target.cols(); ++j) {
      SparseMatrix::InnerIterator from(A_, j);
      for (SparseMatrix::InnerIterator it(target, j); it; ++it) {
        while (from && from.row() < it.row()) {
          ++from;
        }
        const double value = from && from.row() == it.row() ? from.value() : 0.0;
        if (fixed_[it.row()] != 0 || fixed_[j] != 0) {
          it.valueRef() = it.row() == j ? 1.0 : 0.0;
        } else {
          it.valueRef() = it.row() == j ? value + e[j] + proximal : value;
        }
      }
    }
  }

  SparseMatrix A_, transpose_, whole_, lower_;
  Vector scale_;
  bool symmetric_ = false;
  bool dense_ = false;
  bool use_cholesky_ = false;
  bool lu_is_analysed_ = false;
  std::vector<char> fixed_;
  Matrix dense_matrix_;
  std::unique_ptr<SparseCholesky> cholesky_ = make_sparse_cholesky();
  Eigen::PartialPivLU<Matrix> dense_lu_;
  Eigen::SparseLU<SparseMatrix> sparse_lu_;
};

}  // namespace

std::unique_ptr<ShiftedSystem> make_given_matrix_system() {
  return std::make_unique<GivenMatrixSystem>();
}

}  // namespace signorini::lcp
