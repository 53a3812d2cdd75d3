#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/types.h>

#include <string>
#include <vector>

namespace signorini::lcp {

/// A symmetric problem in units in which its numbers are near 1, for the principal pivoting
/// methods:
///
///     M' = S M S,   q' = t S q,   z = S z' / t,   w = S^-1 w' / t,
///
/// S_i and t powers of two (the scaled problem is the caller's to the bit), 1/2 < M'_ii < 2 where
/// M_ii > 0, S_i = 1 elsewhere, |q'|_inf in [1, 2). Bounds are scaled like z.
///
/// M' is held whole: dense if it was given so or more than a fifth of it is filled, else by
/// columns. A factored M is formed here, column by column, without temporary storage.
class SymmetricLcp {
 public:
  /// How far M is from symmetric: max |M_ij - M_ji| / sqrt(M_ii M_jj), and where; 0 for a factored
  /// M. A NaN is not judged.
  struct Asymmetry {
    double size = 0.0;
    Index i = -1;
    Index j = -1;
  };
  [[nodiscard]] static Asymmetry asymmetry(const Problem& problem);
  /// The asymmetry that principal pivoting can live with: sources that print few digits, or
  /// matrices that were integrated numerically.
  static constexpr double kMostAsymmetry = 1e-2;
  /// Why M is not symmetric enough ("M(3, 1) is .., M(1, 3) is .."), or empty.
  [[nodiscard]] static std::string find_asymmetry(const Problem& problem);

  /// Copies and scales M, q, lower and upper; coupled limits are left to the caller. A nearly
  /// symmetric M stays as it is: products are with M, factors read one of its triangles, and
  /// refinement makes up for the difference. Allocates nothing that a problem with as many rows and
  /// entries has used before, but for a sparse M whose pattern is not symmetric.
  /// @return false if a scaled number is not finite.
  bool assign(const Problem& problem);

  [[nodiscard]] int size() const { return n_; }
  [[nodiscard]] bool is_dense() const { return is_dense_; }
  [[nodiscard]] const std::vector<double>& q() const { return q_; }
  [[nodiscard]] double lower(int i) const { return lower_[i]; }
  [[nodiscard]] double upper(int i) const { return upper_[i]; }
  /// Replaces the bounds of a row, caller's units.
  void set_bounds(int i, double lower, double upper);

  /// Column j, n numbers; dense form only.
  [[nodiscard]] const double* dense_column(int j) const {
    return dense_.data() + static_cast<std::size_t>(j) * n_;
  }
  /// The entries of column j; sparse form only.
  [[nodiscard]] int begin(int j) const { return start_[j]; }
  [[nodiscard]] int end(int j) const { return start_[j + 1]; }
  [[nodiscard]] int row(int entry) const { return row_[entry]; }
  [[nodiscard]] double value(int entry) const { return value_[entry]; }
  [[nodiscard]] const std::vector<int>& starts() const { return start_; }
  [[nodiscard]] const std::vector<int>& rows() const { return row_; }

  /// out += factor M'_j
  template <typename Scalar>
  void add_column(int j, Scalar factor, Scalar* out) const;
  [[nodiscard]] double diagonal(int j) const { return diagonal_[j]; }

  /// S_i and t.
  [[nodiscard]] double scale(int i) const { return scale_[i]; }
  [[nodiscard]] double q_scale() const { return q_scale_; }
  /// Between the caller's units and the scaled ones.
  [[nodiscard]] double unscale_z(int i, double z) const { return z * scale_[i] / q_scale_; }
  [[nodiscard]] double scale_z(int i, double z) const { return z / scale_[i] * q_scale_; }
  [[nodiscard]] double unscale_w(int i, double w) const { return w / scale_[i] / q_scale_; }
  [[nodiscard]] double unscale_direction(int i, double z) const { return z * scale_[i]; }

 private:
  void copy(const Matrix& M);
  void copy(const SparseMatrix& M);
  void copy_entries(const SparseMatrix& M);
  void copy(const FactoredMatrix& A);
  void scale_matrix();
  bool scale_vectors(const Problem& problem);

  int n_ = 0;
  bool is_dense_ = true;
  std::vector<double> dense_;
  std::vector<int> start_;
  std::vector<int> row_;
  std::vector<double> value_;
  std::vector<double> diagonal_;
  std::vector<double> q_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  std::vector<double> scale_;
  double q_scale_ = 1.0;

  // Of copy(FactoredMatrix): the rows on every block, and work.
  std::vector<int> use_start_;
  std::vector<int> use_row_;
  std::vector<const double*> use_values_;
  std::vector<int> place_;
  std::vector<double> impulse_;
};

template <typename Scalar>
void SymmetricLcp::add_column(int j, Scalar factor, Scalar* out) const {
  if (is_dense_) {
    const double* __restrict column = dense_column(j);
    Scalar* __restrict sum = out;
    for (int i = 0; i < n_; ++i) {
      sum[i] += factor * Scalar(column[i]);
    }
    return;
  }
  for (int k = start_[j]; k < start_[j + 1]; ++k) {
    out[row_[k]] += factor * Scalar(value_[k]);
  }
}

}  // namespace signorini::lcp
