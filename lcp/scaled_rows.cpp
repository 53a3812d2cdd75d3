#include <signorini/lcp/scaled_rows.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

namespace signorini::lcp {
namespace {

constexpr int kPackedDimension = 6;

int padded(int dimension) {
  return (dimension + kBlockStride - 1) / kBlockStride * kBlockStride;
}

/// The power of two at or below sqrt(value), for value > 0.
double root_power(double value) {
  const int exponent = std::ilogb(value);
  return std::ldexp(1.0, exponent >= 0 ? exponent / 2 : -((1 - exponent) / 2));
}

template <int kDimension>
double dot(const double* a, const double* b) {
  double sum = 0.0;
  for (int k = 0; k < kDimension; ++k) {
    sum += a[k] * b[k];
  }
  return sum;
}
double dot(const double* a, const double* b, int count) {
  return std::inner_product(a, a + count, b, 0.0);
}

/// out = F^T row. F row by row, so that the inner loop is over neighbours.
template <int kDimension>
void times_root(const double* F, const double* row, double* out) {
  double sums[kDimension] = {};
  for (int i = 0; i < kDimension; ++i) {
    for (int k = 0; k < kDimension; ++k) {
      sums[k] += F[kDimension * i + k] * row[i];
    }
  }
  std::copy_n(sums, kDimension, out);
}
void times_root(const double* F, const double* row, int d, double* out) {
  if (d == kPackedDimension) {
    return times_root<kPackedDimension>(F, row, out);
  }
  for (int k = 0; k < d; ++k) {
    out[k] = 0.0;
    for (int i = 0; i < d; ++i) {
      out[k] += F[d * i + k] * row[i];
    }
  }
}

}  // namespace

void ScaledRows::set(const FactoredMatrix& A, std::span<SweepRow> rows) {
  place_blocks(A.mass);
  rows_.resize(rows.size());
  entries_.clear();
  numbers_.clear();
  double largest = 0.0;
  for (int i = 0; i < A.rows(); ++i) {
    const double diagonal = gather(A, i);
    set_diagonal(rows[i], diagonal);
    rows_[i].scale = rows[i].inverse > 0.0 ? root_power(diagonal) : 1.0;
    rows_[i].general = rows_[i].general || rows[i].inverse == 0.0;
    scale(i, rows[i], A.compliance(i));
    largest = std::max(largest, std::abs(rows[i].q) / rows_[i].scale);
  }
  kappa_ =
      largest > 0.0 && std::isfinite(1.0 / largest) ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
}

void ScaledRows::place_blocks(const BlockMass& mass) {
  offset_.resize(mass.block_count());
  root_start_.resize(mass.block_count());
  roots_.clear();
  velocity_count_ = 0;
  for (int b = 0; b < mass.block_count(); ++b) {
    const int d = mass.dimension(b);
    offset_[b] = velocity_count_;
    velocity_count_ += padded(d);
    root_start_[b] = static_cast<int>(roots_.size());
    roots_.resize(roots_.size() + d * d);
    if (!mass.inverse_root(b, &roots_[root_start_[b]])) {
      roots_.resize(root_start_[b]);
      root_start_[b] = -1;
      continue;
    }
    Eigen::Map<Matrix>(&roots_[root_start_[b]], d, d).transposeInPlace();
  }
}

/// The entries of row i, not yet divided by s_i. @return A_ii.
double ScaledRows::gather(const FactoredMatrix& A, int i) {
  const auto entries = A.entries(i);
  double diagonal = A.compliance(i);
  Row& row = rows_[i];
  row.first_entry = static_cast<int>(entries_.size());
  row.general = entries.size() > 2 || entries.empty();
  for (const FactoredMatrix::Entry& entry : entries) {
    const int d = A.mass.dimension(entry.block);
    const int product = static_cast<int>(numbers_.size());
    const bool has_root = root_start_[entry.block] >= 0;
    const int update = has_root ? product : product + d;
    numbers_.resize(update + d);
    if (has_root) {
      times_root(&roots_[root_start_[entry.block]], A.values(entry), d, &numbers_[product]);
    } else {
      std::copy_n(A.values(entry), d, &numbers_[product]);
      A.mass.apply_inverse(entry.block, A.values(entry), &numbers_[update]);
    }
    diagonal += d == kPackedDimension ? dot<kPackedDimension>(&numbers_[product], &numbers_[update])
                                      : dot(&numbers_[product], &numbers_[update], d);
    row.general = row.general || !has_root || d > kPackedDimension;
    entries_.push_back({entry.block, offset_[entry.block], d, product, update});
  }
  row.last_entry = static_cast<int>(entries_.size());
  return diagonal;
}

void ScaledRows::scale(int i, const SweepRow& data, double compliance) {
  Row& row = rows_[i];
  const auto mine = entries(row);
  if (!mine.empty()) {
    const double inverse = 1.0 / row.scale;
    std::for_each(numbers_.begin() + mine.front().product, numbers_.end(),
                  [inverse](double& number) { number *= inverse; });
  }
  const bool is_contact = data.lower == 0.0 && data.upper > 1e308 && compliance == 0.0;
  row.kind = data.normal_row >= 0 ? RowKind::kCoupled
             : is_contact         ? RowKind::kContact
                                  : RowKind::kBounded;
  if (!row.general) {
    row.blocks[0] = mine[0].offset;
    row.blocks[1] = mine.size() > 1 ? mine[1].offset : -1;
    if (mine.size() > 1 && row.blocks[0] > row.blocks[1]) {
      std::swap(row.blocks[0], row.blocks[1]);
    }
  }
}

template <typename T>
void ScaledRows::pack(const Row& row, T* g) const {
  // Of a row of length 1 to 2; their products with small steps would be denormal, which is slow.
  constexpr double kNothing = std::is_same_v<T, float> ? 0x1p-40 : 0.0;
  const auto narrow = [](double number) {
    return static_cast<T>(std::abs(number) > kNothing ? number : 0.0);
  };
  std::fill_n(g, kRowNumbers, T(0));
  for (const Entry& entry : entries(row)) {
    const int which = entry.offset == row.blocks[0] ? 0 : 1;
    const double* numbers = &numbers_[entry.product];
    std::transform(numbers, numbers + std::min(entry.dimension, 4), g + 4 * which, narrow);
    if (entry.dimension > 4) {
      std::transform(numbers + 4, numbers + entry.dimension, g + 8 + 2 * which, narrow);
    }
  }
}

template void ScaledRows::pack(const Row&, double*) const;
template void ScaledRows::pack(const Row&, float*) const;

}  // namespace signorini::lcp
