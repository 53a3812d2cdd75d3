#include <signorini/lcp/number_text.h>
#include <signorini/lcp/sparse_form.h>
#include <signorini/lcp/symmetric_lcp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSparseBelow = 0.2;

/// The power of two 2^-round(log2(d) / 2): d times its square is in [1/2, 2].
double root_scale(double d) {
  int exponent = 0;
  const double mantissa = std::frexp(d, &exponent);  // d = m 2^e, m in [1/2, 1)
  (void)mantissa;
  return std::ldexp(1.0, -(exponent >= 0 ? exponent / 2 : (exponent - 1) / 2));
}

/// |one - other| / sqrt(d_i d_j); infinite beside a zero diagonal, 0 for equal numbers and NaN.
double relative_difference(double one, double other, double d_i, double d_j) {
  const double difference = std::abs(one - other);
  return difference > 0.0 ? difference / std::sqrt(std::abs(d_i)) / std::sqrt(std::abs(d_j)) : 0.0;
}

double entry(const Problem& problem, Index i, Index j) {
  const auto* dense = std::get_if<Matrix>(&problem.M);
  return dense != nullptr ? (*dense)(i, j) : std::get<SparseMatrix>(problem.M).coeff(i, j);
}

}  // namespace

SymmetricLcp::Asymmetry SymmetricLcp::asymmetry(const Problem& problem) {
  Asymmetry worst;
  const auto compare = [&worst](Index i, Index j, double one, double other, double d_i,
                                double d_j) {
    const double size = relative_difference(one, other, d_i, d_j);
    if (size > worst.size) {
      worst = {size, i, j};
    }
  };
  if (const auto* dense = std::get_if<Matrix>(&problem.M)) {
    const Matrix& M = *dense;
    for (Index j = 0; j < M.cols(); ++j) {
      for (Index i = j + 1; i < M.rows(); ++i) {
        if (M(i, j) != M(j, i)) {
          compare(i, j, M(i, j), M(j, i), M(i, i), M(j, j));
        }
      }
    }
  } else if (const auto* sparse = std::get_if<SparseMatrix>(&problem.M)) {
    for (Index j = 0; j < sparse->outerSize(); ++j) {
      for (SparseMatrix::InnerIterator it(*sparse, j); it; ++it) {
        const Index i = it.row();
        const double other = i == j ? it.value() : sparse->coeff(j, i);
        if (it.value() != other) {
          compare(i, j, it.value(), other, sparse->coeff(i, i), sparse->coeff(j, j));
        }
      }
    }
  }
  return worst;
}

std::string SymmetricLcp::find_asymmetry(const Problem& problem) {
  const auto [size, i, j] = asymmetry(problem);
  if (size <= kMostAsymmetry) {
    return {};
  }
  return "M(" + std::to_string(i) + ", " + std::to_string(j) + ") is " +
         number_text(entry(problem, i, j)) + ", M(" + std::to_string(j) + ", " + std::to_string(i) +
         ") is " + number_text(entry(problem, j, i));
}

bool SymmetricLcp::assign(const Problem& problem) {
  n_ = static_cast<int>(problem.size());
  scale_.assign(n_, 1.0);
  std::visit([this](const auto& M) { copy(M); }, problem.M);
  scale_matrix();
  return scale_vectors(problem);
}

void SymmetricLcp::copy(const Matrix& M) {
  is_dense_ = true;
  dense_.assign(M.data(), M.data() + M.size());
}

void SymmetricLcp::copy(const SparseMatrix& M) {
  if (has_symmetric_pattern(M)) {
    copy_entries(M);
  } else {  // sparse factors want one
    copy_entries(SparseMatrix(M + 0.0 * SparseMatrix(M.transpose())));
  }
}

void SymmetricLcp::copy_entries(const SparseMatrix& M) {
  const double size = static_cast<double>(n_) * n_;
  is_dense_ = static_cast<double>(M.nonZeros()) > kSparseBelow * size;
  if (is_dense_) {
    dense_.assign(static_cast<std::size_t>(n_) * n_, 0.0);
  }
  start_.assign(1, 0);
  row_.clear();
  value_.clear();
  for (int j = 0; j < n_; ++j) {
    for (SparseMatrix::InnerIterator it(M, j); it; ++it) {
      if (is_dense_) {
        dense_[static_cast<std::size_t>(j) * n_ + it.row()] = it.value();
      } else {
        row_.push_back(static_cast<int>(it.row()));
        value_.push_back(it.value());
      }
    }
    start_.push_back(static_cast<int>(row_.size()));
  }
}

void SymmetricLcp::copy(const FactoredMatrix& A) {
  const int blocks = A.mass.block_count();
  use_start_.assign(blocks + 1, 0);
  int uses = 0;
  int largest = 0;
  for (int i = 0; i < n_; ++i) {
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      ++use_start_[entry.block + 1];
      ++uses;
    }
  }
  double filled = 0.0;
  for (int b = 0; b < blocks; ++b) {
    filled += static_cast<double>(use_start_[b + 1]) * use_start_[b + 1];
    use_start_[b + 1] += use_start_[b];
    largest = std::max(largest, A.mass.dimension(b));
  }
  is_dense_ = filled > kSparseBelow * static_cast<double>(n_) * n_;
  use_row_.resize(uses);
  use_values_.resize(uses);
  place_.assign(use_start_.begin(), use_start_.end() - 1);
  for (int i = 0; i < n_; ++i) {
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      const int place = place_[entry.block]++;
      use_row_[place] = i;
      use_values_[place] = A.values(entry);
    }
  }
  if (is_dense_) {
    dense_.assign(static_cast<std::size_t>(n_) * n_, 0.0);
  }
  impulse_.resize(largest);
  start_.assign(1, 0);
  row_.clear();
  value_.clear();
  place_.assign(n_, -1);  // of a row in the column, at or after the column's start
  for (int j = 0; j < n_; ++j) {
    double* dense = dense_.data() + (is_dense_ ? static_cast<std::size_t>(j) * n_ : 0);
    const auto add = [&](int i, double a) {
      if (is_dense_) {
        dense[i] += a;
      } else if (place_[i] >= start_[j]) {
        value_[place_[i]] += a;
      } else {
        place_[i] = static_cast<int>(row_.size());
        row_.push_back(i);
        value_.push_back(a);
      }
    };
    if (A.compliance(j) > 0.0) {
      add(j, A.compliance(j));
    }
    for (const FactoredMatrix::Entry& entry : A.entries(j)) {
      const int d = A.mass.dimension(entry.block);
      A.mass.apply_inverse(entry.block, A.values(entry), impulse_.data());
      for (int u = use_start_[entry.block]; u < use_start_[entry.block + 1]; ++u) {
        double a = 0.0;
        for (int k = 0; k < d; ++k) {
          a += impulse_[k] * use_values_[u][k];
        }
        add(use_row_[u], a);
      }
    }
    start_.push_back(static_cast<int>(row_.size()));
  }
}

void SymmetricLcp::scale_matrix() {
  diagonal_.assign(n_, 0.0);
  if (is_dense_) {
    for (int i = 0; i < n_; ++i) {
      const double d = dense_column(i)[i];
      scale_[i] = d > 0.0 ? root_scale(d) : 1.0;
      diagonal_[i] = d * scale_[i] * scale_[i];
    }
    for (int j = 0; j < n_; ++j) {
      double* column = dense_.data() + static_cast<std::size_t>(j) * n_;
      for (int i = 0; i < n_; ++i) {
        column[i] = column[i] * scale_[i] * scale_[j];
      }
    }
    return;
  }
  for (int j = 0; j < n_; ++j) {
    for (int k = start_[j]; k < start_[j + 1]; ++k) {
      if (row_[k] == j) {
        scale_[j] = value_[k] > 0.0 ? root_scale(value_[k]) : 1.0;
        diagonal_[j] = value_[k] * scale_[j] * scale_[j];
      }
    }
  }
  for (int j = 0; j < n_; ++j) {
    for (int k = start_[j]; k < start_[j + 1]; ++k) {
      value_[k] = value_[k] * scale_[row_[k]] * scale_[j];
    }
  }
}

bool SymmetricLcp::scale_vectors(const Problem& problem) {
  q_.resize(n_);
  double largest = 0.0;
  for (int i = 0; i < n_; ++i) {
    q_[i] = scale_[i] * problem.q[i];
    largest = std::max(largest, std::abs(q_[i]));
  }
  int exponent = 0;
  (void)std::frexp(largest, &exponent);
  q_scale_ = largest > 0.0 ? std::ldexp(1.0, 1 - exponent) : 1.0;
  lower_.resize(n_);
  upper_.resize(n_);
  bool finite = std::isfinite(q_scale_) && std::isfinite(largest);
  for (int i = 0; i < n_; ++i) {
    q_[i] *= q_scale_;
    set_bounds(i, problem.lower.size() > 0 ? problem.lower[i] : 0.0,
               problem.upper.size() > 0 ? problem.upper[i] : kInfinity);
    finite = finite && std::isfinite(scale_[i]);
  }
  for (const double value : is_dense_ ? dense_ : value_) {
    finite = finite && std::isfinite(value);
  }
  return finite;
}

void SymmetricLcp::set_bounds(int i, double lower, double upper) {
  lower_[i] = scale_z(i, lower);
  upper_[i] = scale_z(i, upper);
}

}  // namespace signorini::lcp
