#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace signorini::lcp {

/// Solves small dense systems by LU with partial pivoting, in memory that only grows.
class DenseLu {
 public:
  /// An n x n matrix of zeros to fill, column-major.
  double* reset(int n) {
    n_ = n;
    values_.assign(static_cast<std::size_t>(n) * n, 0.0);
    return values_.data();
  }

  /// Overwrites the matrix by its factors. @return false if a pivot is 0 or not finite.
  [[nodiscard]] bool factor() {
    pivots_.resize(n_);
    for (int k = 0; k < n_; ++k) {
      double* pivot_column = column(k);
      const int p = static_cast<int>(
          std::max_element(pivot_column + k, pivot_column + n_,
                           [](double a, double b) { return std::abs(a) < std::abs(b); }) -
          pivot_column);
      if (!(std::abs(pivot_column[p]) > 0.0) || !std::isfinite(pivot_column[p])) {
        return false;
      }
      pivots_[k] = p;
      swap_rows(k, p);
      for (int i = k + 1; i < n_; ++i) {
        pivot_column[i] /= pivot_column[k];
      }
      for (int j = k + 1; j < n_; ++j) {
        double* other = column(j);
        const double multiple = other[k];
        for (int i = k + 1; multiple != 0.0 && i < n_; ++i) {
          other[i] -= pivot_column[i] * multiple;
        }
      }
    }
    return true;
  }

  /// x <- M^-1 x. @pre factor() returned true.
  void solve(double* x) {
    for (int k = 0; k < n_; ++k) {
      std::swap(x[k], x[pivots_[k]]);
    }
    for (int k = 0; k < n_; ++k) {
      for (int i = k + 1; i < n_; ++i) {
        x[i] -= column(k)[i] * x[k];
      }
    }
    for (int k = n_ - 1; k >= 0; --k) {
      x[k] /= column(k)[k];
      for (int i = 0; i < k; ++i) {
        x[i] -= column(k)[i] * x[k];
      }
    }
  }

 private:
  double* column(int j) { return values_.data() + static_cast<std::size_t>(j) * n_; }
  void swap_rows(int a, int b) {
    if (a == b) {
      return;
    }
    for (int j = 0; j < n_; ++j) {
      std::swap(column(j)[a], column(j)[b]);
    }
  }

  int n_ = 0;
  std::vector<int> pivots_;
  std::vector<double> values_;
};

}  // namespace signorini::lcp
