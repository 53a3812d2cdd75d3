#include <signorini/lcp/whitened_rows.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace signorini::lcp {
namespace {

constexpr int kFree = 6;  // degrees of freedom of a free body: a length the compiler can unroll

inline double dot(const double* a, const double* b, int count) {
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    sum += a[k] * b[k];
  }
  return sum;
}

inline void add(double factor, const double* a, double* b, int count) {
  for (int k = 0; k < count; ++k) {
    b[k] += factor * a[k];
  }
}

/// F of every block: W_k = F F^T.
std::vector<Matrix> mass_roots(const BlockMass& mass) {
  std::vector<Matrix> roots(mass.block_count());
  for (int k = 0; k < mass.block_count(); ++k) {
    const int d = mass.dimension(k);
    Matrix W(d, d);
    Vector unit(d);
    for (int j = 0; j < d; ++j) {
      unit.setZero();
      unit[j] = 1.0;
      mass.apply_inverse(k, unit.data(), W.col(j).data());
    }
    roots[k] = Eigen::LLT<Matrix>(0.5 * (W + W.transpose())).matrixL();
  }
  return roots;
}

}  // namespace

void WhitenedRows::set(const FactoredMatrix& A) {
  const std::vector<Matrix> roots = mass_roots(A.mass);
  const int n = A.rows();
  degrees_of_freedom_ = A.degrees_of_freedom();
  row_start_.assign(1, 0);
  entries_.clear();
  values_.clear();
  scale_.resize(n);
  compliance_.resize(n);
  for (int i = 0; i < n; ++i) {
    const std::size_t first_value = values_.size();
    double diagonal = A.compliance(i);
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      const int d = A.mass.dimension(entry.block);
      entries_.push_back({A.mass.offset(entry.block), d, static_cast<int>(values_.size())});
      values_.resize(values_.size() + d);
      Eigen::Map<Vector> g(values_.data() + entries_.back().values, d);
      g.noalias() = roots[entry.block].transpose() * Eigen::Map<const Vector>(A.values(entry), d);
      diagonal += g.squaredNorm();
    }
    row_start_.push_back(static_cast<int>(entries_.size()));
    scale_[i] = diagonal > 0.0 ? std::sqrt(diagonal) : 1.0;
    compliance_[i] = A.compliance(i) / (scale_[i] * scale_[i]);
    std::for_each(values_.begin() + first_value, values_.end(),
                  [s = scale_[i]](double& value) { value /= s; });
  }
  set_pattern(A);
}

void WhitenedRows::set_pattern(const FactoredMatrix& A) {
  // The pairs of blocks that share a row, by column block then row block.
  std::map<std::pair<int, int>, int> pairs;
  for (int k = 0; k < A.mass.block_count(); ++k) {
    pairs[{k, k}] = 0;
  }
  for (int i = 0; i < A.rows(); ++i) {
    for (const auto& one : A.entries(i)) {
      for (const auto& other : A.entries(i)) {
        if (one.block > other.block) {
          pairs[{other.block, one.block}] = 0;
        }
      }
    }
  }
  lower_.resize(degrees_of_freedom_, degrees_of_freedom_);
  first_column_start_.clear();
  column_starts_.clear();
  diagonal_position_.resize(degrees_of_freedom_);
  std::vector<int> outer{0};
  std::vector<int> inner;
  int number = 0;
  for (auto column = pairs.begin(); column != pairs.end();) {
    const int block = column->first.first;
    auto end = column;
    const int first_pair = number;
    while (end != pairs.end() && end->first.first == block) {
      end->second = number++;
      first_column_start_.push_back(static_cast<int>(column_starts_.size()));
      column_starts_.resize(column_starts_.size() + A.mass.dimension(block));
      ++end;
    }
    for (int c = 0; c < A.mass.dimension(block); ++c) {
      int pair = first_pair;
      for (auto it = column; it != end; ++it, ++pair) {
        const int row_block = it->first.second;
        const int skip = row_block == block ? c : 0;  // the lower triangle only
        column_starts_[first_column_start_[pair] + c] = static_cast<int>(inner.size()) - skip;
        if (row_block == block) {
          diagonal_position_[A.mass.offset(block) + c] = static_cast<int>(inner.size());
        }
        for (int r = skip; r < A.mass.dimension(row_block); ++r) {
          inner.push_back(A.mass.offset(row_block) + r);
        }
      }
      outer.push_back(static_cast<int>(inner.size()));
    }
    column = end;
  }
  lower_.resizeNonZeros(static_cast<Index>(inner.size()));
  std::copy(outer.begin(), outer.end(), lower_.outerIndexPtr());
  std::copy(inner.begin(), inner.end(), lower_.innerIndexPtr());

  pair_of_entries_.clear();
  for (int i = 0; i < A.rows(); ++i) {
    for (const auto& one : A.entries(i)) {
      for (const auto& other : A.entries(i)) {
        if (one.block >= other.block) {
          pair_of_entries_.push_back(pairs.at({other.block, one.block}));
        }
      }
    }
  }
}

void WhitenedRows::transpose_times(const Vector& x, Vector& u) const {
  u.setZero(degrees_of_freedom_);
  for (Index i = 0; i < rows(); ++i) {
    for (int e = row_start_[i]; e < row_start_[i + 1]; ++e) {
      const Entry& entry = entries_[e];
      const double* g = values_.data() + entry.values;
      double* target = u.data() + entry.offset;
      entry.dimension == kFree ? add(x[i], g, target, kFree)
                               : add(x[i], g, target, entry.dimension);
    }
  }
}

void WhitenedRows::times(const Vector& u, Vector& y) const {
  y.resize(rows());
  for (Index i = 0; i < rows(); ++i) {
    double sum = 0.0;
    for (int e = row_start_[i]; e < row_start_[i + 1]; ++e) {
      const Entry& entry = entries_[e];
      const double* g = values_.data() + entry.values;
      const double* block = u.data() + entry.offset;
      sum += entry.dimension == kFree ? dot(g, block, kFree) : dot(g, block, entry.dimension);
    }
    y[i] = sum;
  }
}

const SparseMatrix& WhitenedRows::body_space_matrix(const Vector& d) {
  double* out = lower_.valuePtr();
  std::fill(out, out + lower_.nonZeros(), 0.0);
  for (const int position : diagonal_position_) {
    out[position] = 1.0;
  }
  const int* pair = pair_of_entries_.data();
  for (Index i = 0; i < rows(); ++i) {
    for (int e1 = row_start_[i]; e1 < row_start_[i + 1]; ++e1) {
      for (int e2 = row_start_[i]; e2 < row_start_[i + 1]; ++e2) {
        const Entry& one = entries_[e1];
        const Entry& other = entries_[e2];
        if (one.offset < other.offset) {
          continue;
        }
        const int* starts = column_starts_.data() + first_column_start_[*pair++];
        if (d[i] == 0.0) {
          continue;
        }
        const double* g1 = values_.data() + one.values;
        const double* g2 = values_.data() + other.values;
        for (int c = 0; c < other.dimension; ++c) {
          const double factor = d[i] * g2[c];
          double* column = out + starts[c];
          for (int r = e1 == e2 ? c : 0; r < one.dimension; ++r) {
            column[r] += factor * g1[r];
          }
        }
      }
    }
  }
  return lower_;
}

}  // namespace signorini::lcp
