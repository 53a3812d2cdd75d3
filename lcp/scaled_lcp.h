#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/types.h>

#include <vector>

namespace signorini::lcp {

/// An LCP (M, q) in units in which its numbers are near 1, for the pivoting methods:
///
///     M' = R M C,   q' = s R q,   z = C z' / s,   w = R^-1 w' / s,
///
/// R, C and s powers of two, so that the scaled problem is the caller's problem to the bit (numbers
/// below 1e-308 of the largest excepted). Where M_ii > 0, first R_ii = C_ii ~ M_ii^-1/2, which
/// brings a positive semidefinite M to |M'_ij| < 2; the other indices (friction) by their largest
/// entry beside those; then rows and columns by the root of their largest entry (Ruiz 2001), which
/// leaves that M' as it is. s makes |q'|_inf = 1 .. 2.
///
/// M' is held by columns: dense, or compressed if fewer than a quarter of its entries are non-zero.
class ScaledLcp {
 public:
  /// Copies and scales. Cost: n^2.
  /// @return false if M, formed, or a scaled number is not finite.
  bool assign(const Problem& problem);

  [[nodiscard]] int size() const { return static_cast<int>(q_.size()); }
  [[nodiscard]] const Vector& q() const { return q_; }
  [[nodiscard]] bool is_sparse() const { return is_sparse_; }

  /// out += factor * M'_j. Scalar is double or long double.
  template <typename Scalar>
  void add_column(int j, Scalar factor, Scalar* out) const {
    if (is_sparse_) {
      for (int k = start_[j]; k < start_[j + 1]; ++k) {
        out[row_[k]] += factor * Scalar(value_[k]);
      }
      return;
    }
    const double* column = dense_.data() + static_cast<Index>(j) * dense_.rows();
    for (int i = 0; i < size(); ++i) {
      out[i] += factor * Scalar(column[i]);
    }
  }

  /// out += factor * |M'_j|
  void add_absolute_column(int j, double factor, double* out) const;

  /// M'_j . u
  [[nodiscard]] double dot_column(int j, const Vector& u) const;
  /// |M'_j| . |u|
  [[nodiscard]] double dot_absolute_column(int j, const Vector& u) const;

  /// target[place[i]] = M'_ij for every row i with place[i] >= 0; target is not cleared.
  void gather_column(int j, const std::vector<int>& place, double* target) const;

  /// z in the caller's units, and back.
  [[nodiscard]] long double unscale_z(int i, long double z) const;
  [[nodiscard]] long double scale_z(int i, long double z) const;
  /// w' of a w in the caller's units.
  [[nodiscard]] long double scale_w(int i, long double w) const;
  /// C_j y_j: a direction of z, without s.
  [[nodiscard]] double unscale_direction(int j, double y) const;
  /// y_i / R_i: the dual y' for which M'^T y' = C M^T y.
  [[nodiscard]] double scale_dual(int i, double y) const;

 private:
  void choose_exponents();
  void measure_largest(bool beside_diagonals);
  void apply_exponents();
  void compress();

  bool is_sparse_ = false;
  Matrix dense_;
  std::vector<int> start_;
  std::vector<int> row_;
  std::vector<double> value_;
  Vector q_;
  std::vector<int> row_exponent_;     // R_i = 2^row_exponent_[i]
  std::vector<int> column_exponent_;  // C_j = 2^column_exponent_[j]
  int q_exponent_ = 0;                // s = 2^q_exponent_
  std::vector<int> row_largest_;
  std::vector<int> column_largest_;
};

}  // namespace signorini::lcp
