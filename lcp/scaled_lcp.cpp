#include <signorini/lcp/scaled_lcp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr int kRuizPasses = 8;
constexpr double kSparseBelow = 0.25;
constexpr int kNone = std::numeric_limits<int>::min();

/// round(log2 |value|), kNone for 0.
int exponent_of(double value) {
  return value == 0.0 ? kNone : static_cast<int>(std::lround(std::log2(std::abs(value))));
}

/// n / 2 rounded towards 0, so that a number within a factor 2 of 1 is left alone.
int half(int exponent) {
  return exponent / 2;
}

}  // namespace

bool ScaledLcp::assign(const Problem& problem) {
  dense_ = to_dense(problem.M);
  q_ = problem.q;
  if (!dense_.allFinite()) {
    return false;
  }
  choose_exponents();
  apply_exponents();
  if (!dense_.allFinite() || !q_.allFinite()) {
    return false;
  }
  const Index n = dense_.rows();
  const Index filled = (dense_.array() != 0.0).count();
  is_sparse_ = static_cast<double>(filled) < kSparseBelow * static_cast<double>(n * n);
  if (is_sparse_) {
    compress();
  }
  return true;
}

void ScaledLcp::choose_exponents() {
  const int n = size();
  row_exponent_.assign(n, 0);
  column_exponent_.assign(n, 0);
  for (int i = 0; i < n; ++i) {
    if (dense_(i, i) > 0.0) {
      row_exponent_[i] = static_cast<int>(std::lround(-0.5 * std::log2(dense_(i, i))));
      column_exponent_[i] = row_exponent_[i];
    }
  }
  // Indices without a positive diagonal follow those they meet.
  measure_largest(true);
  for (int i = 0; i < n; ++i) {
    if (!(dense_(i, i) > 0.0)) {
      row_exponent_[i] -= row_largest_[i] == kNone ? 0 : row_largest_[i];
      column_exponent_[i] -= column_largest_[i] == kNone ? 0 : column_largest_[i];
    }
  }
  for (int pass = 0; pass < kRuizPasses; ++pass) {
    measure_largest(false);
    bool changed = false;
    for (int i = 0; i < n; ++i) {
      const int row_step = row_largest_[i] == kNone ? 0 : half(row_largest_[i]);
      const int column_step = column_largest_[i] == kNone ? 0 : half(column_largest_[i]);
      row_exponent_[i] -= row_step;
      column_exponent_[i] -= column_step;
      changed = changed || row_step != 0 || column_step != 0;
    }
    if (!changed) {
      break;
    }
  }
}

/// The exponents of the largest entry of every scaled row and column, kNone where all are 0.
/// @param beside_diagonals count only the entries in the column (for a row) or row (for a column)
/// of an index with a positive diagonal
void ScaledLcp::measure_largest(bool beside_diagonals) {
  const int n = size();
  row_largest_.assign(n, kNone);
  column_largest_.assign(n, kNone);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int e = exponent_of(dense_(i, j));
      if (e == kNone) {
        continue;
      }
      const int scaled = e + row_exponent_[i] + column_exponent_[j];
      if (!beside_diagonals || dense_(j, j) > 0.0) {
        row_largest_[i] = std::max(row_largest_[i], scaled);
      }
      if (!beside_diagonals || dense_(i, i) > 0.0) {
        column_largest_[j] = std::max(column_largest_[j], scaled);
      }
    }
  }
}

void ScaledLcp::apply_exponents() {
  const int n = size();
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      dense_(i, j) = std::ldexp(dense_(i, j), row_exponent_[i] + column_exponent_[j]);
    }
  }
  // Empty rows have no scale of their own: their q becomes as large as the largest of the others.
  int largest = kNone;
  for (int i = 0; i < n; ++i) {
    if (q_[i] != 0.0 && row_largest_[i] != kNone) {
      largest = std::max(largest, std::ilogb(q_[i]) + row_exponent_[i]);
    }
  }
  for (int i = 0; i < n; ++i) {
    if (q_[i] != 0.0 && row_largest_[i] == kNone) {
      largest = largest == kNone ? std::ilogb(q_[i]) : largest;
      row_exponent_[i] = largest - std::ilogb(q_[i]);
    }
  }
  q_exponent_ = largest == kNone ? 0 : -largest;
  for (int i = 0; i < n; ++i) {
    q_[i] = std::ldexp(q_[i], row_exponent_[i] + q_exponent_);
  }
}

void ScaledLcp::compress() {
  const int n = size();
  start_.assign(1, 0);
  row_.clear();
  value_.clear();
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      if (dense_(i, j) != 0.0) {
        row_.push_back(i);
        value_.push_back(dense_(i, j));
      }
    }
    start_.push_back(static_cast<int>(row_.size()));
  }
}

void ScaledLcp::add_absolute_column(int j, double factor, double* out) const {
  if (is_sparse_) {
    for (int k = start_[j]; k < start_[j + 1]; ++k) {
      out[row_[k]] += factor * std::abs(value_[k]);
    }
    return;
  }
  for (int i = 0; i < size(); ++i) {
    out[i] += factor * std::abs(dense_(i, j));
  }
}

double ScaledLcp::dot_column(int j, const Vector& u) const {
  if (!is_sparse_) {
    return dense_.col(j).dot(u);
  }
  double sum = 0.0;
  for (int k = start_[j]; k < start_[j + 1]; ++k) {
    sum += value_[k] * u[row_[k]];
  }
  return sum;
}

double ScaledLcp::dot_absolute_column(int j, const Vector& u) const {
  if (!is_sparse_) {
    return dense_.col(j).cwiseAbs().dot(u.cwiseAbs());
  }
  double sum = 0.0;
  for (int k = start_[j]; k < start_[j + 1]; ++k) {
    sum += std::abs(value_[k] * u[row_[k]]);
  }
  return sum;
}

void ScaledLcp::gather_column(int j, const std::vector<int>& place, double* target) const {
  if (is_sparse_) {
    for (int k = start_[j]; k < start_[j + 1]; ++k) {
      if (place[row_[k]] >= 0) {
        target[place[row_[k]]] = value_[k];
      }
    }
    return;
  }
  for (int i = 0; i < size(); ++i) {
    if (place[i] >= 0) {
      target[place[i]] = dense_(i, j);
    }
  }
}

long double ScaledLcp::unscale_z(int i, long double z) const {
  return std::ldexp(z, column_exponent_[i] - q_exponent_);
}

long double ScaledLcp::scale_z(int i, long double z) const {
  return std::ldexp(z, q_exponent_ - column_exponent_[i]);
}

long double ScaledLcp::scale_w(int i, long double w) const {
  return std::ldexp(w, row_exponent_[i] + q_exponent_);
}

double ScaledLcp::scale_dual(int i, double y) const {
  return std::ldexp(y, -row_exponent_[i]);
}

double ScaledLcp::unscale_direction(int j, double y) const {
  return std::ldexp(y, column_exponent_[j]);
}

}  // namespace signorini::lcp
