#include <signorini/lcp/weighted_product.h>
#include <signorini/lcp/whitened_rows.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <type_traits>

namespace signorini::lcp {
namespace {

// A direction in which no row of a body moves it by more than this, of the row's length, is left
// out: it contributes its square to G G^T, whose diagonal is one.
constexpr double kNoMotion = 1e-11;

// The longest and the shortest entry that the compiler gets to unroll: a free body, and one that
// its rows move in three directions only.
constexpr int kFree = 6;
constexpr int kThree = 3;

template <int kSize>
inline double dot(const double* a, const double* b) {
  double sum = 0.0;
  for (int k = 0; k < kSize; ++k) {
    sum += a[k] * b[k];
  }
  return sum;
}

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

/// `count` rows, one after the other, of two parts of them.
struct Rows {
  int count;
  int width;
  const double* one;    // a part of the first row
  const double* other;  // another, or the same
};

/// out(r, c) += sum over the rows of d[row] one[r] other[c], for r >= c or for all r; column c of
/// out starts at starts[c].
template <bool kLower>
inline void add_outer(const Rows& rows, const double* d, int size, int columns, double* out,
                      const int* starts) {
  for (int i = 0; i < rows.count; ++i) {
    const double* one = rows.one + i * rows.width;
    const double* other = rows.other + i * rows.width;
    for (int c = 0; c < columns; ++c) {
      const double value = d[i] * other[c];
      double* column = out + starts[c];
      for (int r = kLower ? c : 0; r < size; ++r) {
        column[r] += value * one[r];
      }
    }
  }
}

/// The same of 3 x 3: out is read and written once.
template <bool kLower>
inline void add_outer_of_three(const Rows& rows, const double* d, double* out, const int* starts) {
  double block[kThree * kThree];
  for (int c = 0; c < kThree; ++c) {
    for (int r = kLower ? c : 0; r < kThree; ++r) {
      block[c * kThree + r] = out[starts[c] + r];
    }
  }
  for (int i = 0; i < rows.count; ++i) {
    const double* one = rows.one + i * rows.width;
    const double* other = rows.other + i * rows.width;
    for (int c = 0; c < kThree; ++c) {
      const double value = d[i] * other[c];
      for (int r = kLower ? c : 0; r < kThree; ++r) {
        block[c * kThree + r] += value * one[r];
      }
    }
  }
  for (int c = 0; c < kThree; ++c) {
    for (int r = kLower ? c : 0; r < kThree; ++r) {
      out[starts[c] + r] = block[c * kThree + r];
    }
  }
}

/// The same of up to 8 x 8, by the instructions of the machine.
template <bool kLower>
inline void add_outer_by_kernel(const Rows& rows, const double* d, int size, int columns,
                                double* out, const int* starts) {
  static const WeightedProduct& product = weighted_products().front();
  constexpr int kLd = WeightedProduct::kSize;
  double block[kLd * kLd];
  product.multiply(block, rows.one, rows.other, rows.width, rows.width, d, rows.count, columns);
  const auto add_block = [&](int count) {  // unrolled where it is known
    for (int c = 0; c < columns; ++c) {
      double* column = out + starts[c];
      for (int r = kLower ? c : 0; r < count; ++r) {
        column[r] += block[c * kLd + r];
      }
    }
  };
  size == kFree ? add_block(kFree) : add_block(size);
}

template <bool kLower>
inline void add_outer_fast(const Rows& rows, const double* d, int size, int columns, double* out,
                           const int* starts) {
  constexpr int kMost = WeightedProduct::kSize;
  if (rows.count == 1 || size > kMost || columns > kMost) {
    add_outer<kLower>(rows, d, size, columns, out, starts);
  } else if (size == kThree && columns == kThree) {
    add_outer_of_three<kLower>(rows, d, out, starts);
  } else {
    add_outer_by_kernel<kLower>(rows, d, size, columns, out, starts);
  }
}

/// Calls call(size), size a constant that the compiler gets to unroll. @return false if it is none
template <typename Call>
inline bool with_known_size(int size, Call call) {
  switch (size) {
    case kThree: call(std::integral_constant<int, kThree>{}); return true;
    case 4: call(std::integral_constant<int, 4>{}); return true;
    case 5: call(std::integral_constant<int, 5>{}); return true;
    case kFree: call(std::integral_constant<int, kFree>{}); return true;
    default: return false;
  }
}

/// u += G^T x of rows with kCount parts of kSize numbers, each read and written once.
template <int kSize, int kCount>
inline void add_transpose(const double* row, int rows, const double* x,
                          const std::array<double*, 2>& u) {
  if (rows == 1) {
    for (int k = 0; k < kCount; ++k) {
      add(x[0], row + k * kSize, u[k], kSize);
    }
    return;
  }
  double sum[kCount * kSize];
  for (int k = 0; k < kCount; ++k) {
    std::copy_n(u[k], kSize, sum + k * kSize);
  }
  for (int i = 0; i < rows; ++i, row += kCount * kSize) {
    for (int k = 0; k < kCount * kSize; ++k) {
      sum[k] += x[i] * row[k];
    }
  }
  for (int k = 0; k < kCount; ++k) {
    std::copy_n(sum + k * kSize, kSize, u[k]);
  }
}

/// y = G u of such rows.
template <int kSize, int kCount>
inline void multiply(const double* row, int rows, const std::array<const double*, 2>& u,
                     double* y) {
  double v[kCount * kSize];
  for (int k = 0; k < kCount; ++k) {
    std::copy_n(u[k], kSize, v + k * kSize);
  }
  for (int i = 0; i < rows; ++i) {
    double sum = 0.0;
    for (int k = 0; k < kCount; ++k, row += kSize) {
      sum += dot<kSize>(row, v + k * kSize);
    }
    y[i] = sum;
  }
}

/// The lower triangle of W (d x d, column-major) becomes F with W = F F^T; the upper one zero. A
/// direction without inverse mass gets a zero column.
inline void factor_in_place(double* W, int d) {
  double largest = 0.0;
  for (int k = 0; k < d; ++k) {
    largest = std::max(largest, W[k * d + k]);
  }
  const double least = largest * std::numeric_limits<double>::epsilon() * d;
  for (int c = 0; c < d; ++c) {
    double* column = W + c * d;
    std::fill(column, column + c, 0.0);
    if (!(column[c] > least)) {
      std::fill(column + c, column + d, 0.0);
      continue;
    }
    const double root = std::sqrt(column[c]);
    column[c] = root;
    for (int r = c + 1; r < d; ++r) {
      column[r] /= root;
    }
    for (int k = c + 1; k < d; ++k) {
      for (int r = k; r < d; ++r) {
        W[k * d + r] -= column[r] * column[k];
      }
    }
  }
}

}  // namespace

void WhitenedRows::set(const FactoredMatrix& A) {
  each_row_.resize(A.rows() + 1);
  std::iota(each_row_.begin(), each_row_.end(), 0);
  set(A, each_row_);
}

void WhitenedRows::set(const FactoredMatrix& A, std::span<const int> group_start) {
  if (group_start.empty() || group_start.front() != 0 || group_start.back() != A.rows()) {
    throw std::invalid_argument("WhitenedRows: group_start must go from 0 to the number of rows");
  }
  take_over(A, group_start);
  whiten(A);
  scale_rows(A);
  compress(A.mass);
  find_bundles();
  set_pattern(A.mass.block_count());
}

/// Groups, entries and J's numbers. A row that misses a body of its group gets zeros there.
void WhitenedRows::take_over(const FactoredMatrix& A, std::span<const int> group_start) {
  groups_.clear();
  entries_.clear();
  values_.clear();
  entry_of_body_.assign(A.mass.block_count(), -1);
  for (std::size_t g = 0; g + 1 < group_start.size(); ++g) {
    const int first = group_start[g];
    const int last = group_start[g + 1];
    if (first >= last) {
      throw std::invalid_argument("WhitenedRows: group_start must increase");
    }
    Group group{first, static_cast<int>(entries_.size()), static_cast<int>(values_.size()), 0};
    for (int i = first; i < last; ++i) {
      for (const FactoredMatrix::Entry& entry : A.entries(i)) {
        if (entry_of_body_[entry.block] < 0) {
          entry_of_body_[entry.block] = static_cast<int>(entries_.size());
          const int dimension = A.mass.dimension(entry.block);
          entries_.push_back({entry.block, dimension, 0, group.width});
          group.width += dimension;
        }
      }
    }
    values_.resize(values_.size() + static_cast<std::size_t>(last - first) * group.width, 0.0);
    for (int i = first; i < last; ++i) {
      double* row = values_.data() + group.values + (i - first) * group.width;
      for (const FactoredMatrix::Entry& entry : A.entries(i)) {
        const Entry& mine = entries_[entry_of_body_[entry.block]];
        std::copy_n(A.values(entry), mine.dimension, row + mine.column);
      }
    }
    for (std::size_t e = group.entry; e < entries_.size(); ++e) {
      entry_of_body_[entries_[e].body] = -1;
    }
    groups_.push_back(group);
  }
  groups_.push_back(
      {A.rows(), static_cast<int>(entries_.size()), static_cast<int>(values_.size()), 0});
  values_.resize(values_.size() + WeightedProduct::kSize, 0.0);
}

void WhitenedRows::find_roots(const BlockMass& mass) {
  root_start_.assign(1, 0);
  roots_.clear();
  for (int k = 0; k < mass.block_count(); ++k) {
    const int d = mass.dimension(k);
    const int start = root_start_.back();
    root_start_.push_back(start + d * d);
    roots_.resize(root_start_.back());
    work_.assign(d, 0.0);
    double* W = roots_.data() + start;
    if (mass.is_factor(k)) {
      for (int j = 0; j < d; ++j) {
        work_[j] = 1.0;
        mass.apply_inverse(k, work_.data(), W + j * d);
        work_[j] = 0.0;
      }
      for (int j = 0; j < d; ++j) {
        for (int i = j + 1; i < d; ++i) {
          W[j * d + i] = 0.5 * (W[j * d + i] + W[i * d + j]);
        }
      }
    } else {
      std::copy_n(mass.stored(k).data(), d * d, W);
    }
    d == kFree ? factor_in_place(W, kFree) : factor_in_place(W, d);
  }
}

/// Every entry's numbers J_ik become J_ik F_k.
void WhitenedRows::whiten(const FactoredMatrix& A) {
  find_roots(A.mass);
  for (int g = 0; g < groups(); ++g) {
    double* row = values_.data() + groups_[g].values;
    for (int i = 0; i < group_rows(g); ++i, row += groups_[g].width) {
      for (int e = groups_[g].entry; e < groups_[g + 1].entry; ++e) {
        const Entry& entry = entries_[e];
        const double* F = roots_.data() + root_start_[entry.body];
        double* numbers = row + entry.column;
        for (int c = 0; c < entry.dimension; ++c) {  // F is lower: column c ends what c needs
          const double* column = F + c * entry.dimension;
          numbers[c] = dot(column + c, numbers + c, entry.dimension - c);
        }
      }
    }
  }
}

void WhitenedRows::scale_rows(const FactoredMatrix& A) {
  scale_.resize(A.rows());
  compliance_.resize(A.rows());
  for (int g = 0; g < groups(); ++g) {
    double* row = values_.data() + groups_[g].values;
    const int width = groups_[g].width;
    double largest = 0.0;
    for (int i = 0; i < group_rows(g); ++i) {
      const double* numbers = row + i * width;
      largest = std::max(largest, A.compliance(groups_[g].row + i) + dot(numbers, numbers, width));
    }
    const double scale = largest > 0.0 ? std::sqrt(largest) : 1.0;
    for (int i = 0; i < group_rows(g); ++i) {
      scale_[groups_[g].row + i] = scale;
      compliance_[groups_[g].row + i] = A.compliance(groups_[g].row + i) / (scale * scale);
    }
    for (int k = 0; k < group_rows(g) * width; ++k) {
      row[k] /= scale;
    }
  }
}

/// Gram-Schmidt, twice (Q's columns at once: their products do not wait for each other): adds to Q
/// what the row moves the body in and Q does not span.
void WhitenedRows::extend_basis(int body, int dimension, const double* row) {
  double* Q = basis_.data() + root_start_[body];
  double* left = work_.data();
  double* products = left + dimension;
  const auto extend = [&](int d) {  // unrolled where it is known
    const int rank = rank_[body];
    std::copy_n(row, d, left);
    double before = dot(row, row, d);
    for (int pass = 0; pass < 4; ++pass) {
      for (int c = 0; c < rank; ++c) {
        products[c] = dot(Q + c * d, left, d);
      }
      for (int c = 0; c < rank; ++c) {
        add(-products[c], Q + c * d, left, d);
      }
      const double after = dot(left, left, d);
      if (!(after > kNoMotion * kNoMotion)) {
        return;
      }
      const bool settled = after > 0.25 * before;  // little was left to remove: orthogonal to Q
      before = after;
      if (settled) {
        break;
      }
    }
    const double length = std::sqrt(before);
    for (int k = 0; k < d; ++k) {
      Q[rank * d + k] = left[k] / length;
    }
    ++rank_[body];
  };
  dimension == kFree ? extend(kFree) : extend(dimension);
}

/// Finds Q, writes every row in its coordinates and closes the gaps that leaves.
void WhitenedRows::compress(const BlockMass& mass) {
  const int bodies = mass.block_count();
  rank_.assign(bodies, 0);
  basis_.resize(roots_.size());
  int largest = 0;
  for (int k = 0; k < bodies; ++k) {
    largest = std::max(largest, mass.dimension(k));
  }
  work_.resize(std::max(2 * largest, 1));
  for (int g = 0; g < groups(); ++g) {
    const double* row = values_.data() + groups_[g].values;
    for (int i = 0; i < group_rows(g); ++i, row += groups_[g].width) {
      for (int e = groups_[g].entry; e < groups_[g + 1].entry; ++e) {
        if (rank_[entries_[e].body] < entries_[e].dimension) {
          extend_basis(entries_[e].body, entries_[e].dimension, row + entries_[e].column);
        }
      }
    }
  }
  body_offset_.assign(1, 0);
  for (int k = 0; k < bodies; ++k) {
    body_offset_.push_back(body_offset_.back() + rank_[k]);
  }
  degrees_of_freedom_ = body_offset_.back();

  double* out = values_.data();
  for (int g = 0; g < groups(); ++g) {
    Group& group = groups_[g];
    const double* row = values_.data() + group.values;
    group.values = static_cast<int>(out - values_.data());
    for (int i = 0; i < group_rows(g); ++i, row += group.width) {
      for (int e = group.entry; e < groups_[g + 1].entry; ++e) {
        const Entry& entry = entries_[e];
        const int d = entry.dimension;
        const int rank = rank_[entry.body];
        const double* Q = basis_.data() + root_start_[entry.body];
        std::copy_n(row + entry.column, d, work_.data());
        if (rank == d) {
          std::copy_n(work_.data(), d, out);
        } else {
          const auto multiply = [&](int size) {
            for (int c = 0; c < rank; ++c) {
              out[c] = dot(Q + c * size, work_.data(), size);
            }
          };
          d == kFree ? multiply(kFree) : multiply(d);
        }
        out += rank;
      }
    }
    group.width = 0;
    for (int e = group.entry; e < groups_[g + 1].entry; ++e) {
      Entry& entry = entries_[e];
      entry.dimension = rank_[entry.body];
      entry.offset = body_offset_[entry.body];
      entry.column = group.width;
      group.width += entry.dimension;
    }
  }
  groups_.back().values = static_cast<int>(out - values_.data());
}

/// Groups that follow each other with the same bodies are a bundle: their rows have one layout.
void WhitenedRows::find_bundles() {
  const auto same_bodies = [this](int g, int h) {
    const auto first = entries_.begin();
    return std::equal(first + groups_[g].entry, first + groups_[g + 1].entry,
                      first + groups_[h].entry, first + groups_[h + 1].entry,
                      [](const Entry& a, const Entry& b) { return a.body == b.body; });
  };
  bundles_.clear();
  for (int g = 0; g < groups(); ++g) {
    if (g > 0 && same_bodies(g - 1, g)) {
      ++bundles_.back().groups;
      bundles_.back().rows += group_rows(g);
      continue;
    }
    Bundle bundle{g, 1, groups_[g].row, group_rows(g), groups_[g].values, groups_[g].width, 0,
                  0, {}};
    const std::span<const Entry> parts = entries_of(g);
    const int size = parts.empty() ? 0 : parts.front().dimension;
    if (size >= kThree && size <= kFree && parts.size() <= 2 && parts.back().dimension == size) {
      bundle.parts = static_cast<int>(parts.size());
      bundle.size = size;
      bundle.offset = {parts.front().offset, parts.back().offset};
    }
    bundles_.push_back(bundle);
  }
}

void WhitenedRows::set_pattern(int bodies) {
  // Every pair of entries of every group, then sorted by the pair's smaller body.
  pair_column_.clear();
  pair_row_.clear();
  for (int k = 0; k < bodies; ++k) {  // every body has its diagonal block
    pair_column_.push_back(k);
    pair_row_.push_back(k);
  }
  for (int g = 0; g < groups(); ++g) {
    for (int e1 = groups_[g].entry; e1 < groups_[g + 1].entry; ++e1) {
      for (int e2 = groups_[g].entry; e2 < groups_[g + 1].entry; ++e2) {
        if (entries_[e1].body >= entries_[e2].body) {
          pair_row_.push_back(entries_[e1].body);
          pair_column_.push_back(entries_[e2].body);
        }
      }
    }
  }
  const int incidences = static_cast<int>(pair_row_.size());
  column_bucket_.assign(bodies + 1, 0);
  for (const int column : pair_column_) {
    ++column_bucket_[column + 1];
  }
  std::partial_sum(column_bucket_.begin(), column_bucket_.end(), column_bucket_.begin());
  sorted_.resize(incidences);
  for (int k = 0; k < incidences; ++k) {
    sorted_[column_bucket_[pair_column_[k]]++] = k;
  }  // column_bucket_[q] is now the end of q

  first_column_start_.clear();
  column_starts_.clear();
  diagonal_position_.resize(degrees_of_freedom_);
  pair_of_entries_.resize(incidences);
  pair_of_row_.assign(bodies, -1);
  outer_.assign(1, 0);
  inner_.clear();
  for (int q = 0, begin = 0; q < bodies; begin = column_bucket_[q++]) {
    rows_of_column_.clear();
    for (int k = begin; k < column_bucket_[q]; ++k) {
      const int p = pair_row_[sorted_[k]];
      if (pair_of_row_[p] < 0) {
        pair_of_row_[p] = 0;
        rows_of_column_.push_back(p);
      }
    }
    std::sort(rows_of_column_.begin(), rows_of_column_.end());
    const int first_pair = static_cast<int>(first_column_start_.size());
    for (const int p : rows_of_column_) {
      pair_of_row_[p] = static_cast<int>(first_column_start_.size());
      first_column_start_.push_back(static_cast<int>(column_starts_.size()));
      column_starts_.resize(column_starts_.size() + rank_[q]);
    }
    for (int k = begin; k < column_bucket_[q]; ++k) {
      pair_of_entries_[sorted_[k]] = pair_of_row_[pair_row_[sorted_[k]]];
    }
    for (int c = 0; c < rank_[q]; ++c) {
      for (std::size_t k = 0; k < rows_of_column_.size(); ++k) {
        const int p = rows_of_column_[k];
        const int skip = p == q ? c : 0;  // the lower triangle only
        column_starts_[first_column_start_[first_pair + k] + c] =
            static_cast<int>(inner_.size()) - skip;
        if (p == q) {
          diagonal_position_[body_offset_[q] + c] = static_cast<int>(inner_.size());
        }
        for (int r = skip; r < rank_[p]; ++r) {
          inner_.push_back(body_offset_[p] + r);
        }
      }
      outer_.push_back(static_cast<int>(inner_.size()));
    }
    for (const int p : rows_of_column_) {
      pair_of_row_[p] = -1;
    }
  }
  // The pairs of bodies with themselves were only there to be in the pattern.
  pair_of_entries_.erase(pair_of_entries_.begin(), pair_of_entries_.begin() + bodies);
  lower_.resize(degrees_of_freedom_, degrees_of_freedom_);
  lower_.resizeNonZeros(static_cast<Index>(inner_.size()));
  std::copy(outer_.begin(), outer_.end(), lower_.outerIndexPtr());
  std::copy(inner_.begin(), inner_.end(), lower_.innerIndexPtr());
}

void WhitenedRows::transpose_times(const Vector& x, Vector& u) const {
  u.setZero(degrees_of_freedom_);
  for (const Bundle& bundle : bundles_) {
    const double* row = values_.data() + bundle.values;
    const double* of_rows = x.data() + bundle.row;
    const std::array<double*, 2> to = {u.data() + bundle.offset[0], u.data() + bundle.offset[1]};
    const bool is_known = with_known_size(bundle.size, [&](auto size) {
      bundle.parts == 2 ? add_transpose<size, 2>(row, bundle.rows, of_rows, to)
                        : add_transpose<size, 1>(row, bundle.rows, of_rows, to);
    });
    for (int i = 0; !is_known && i < bundle.rows; ++i) {
      for (const Entry& part : entries_of(bundle.group)) {
        add(of_rows[i], row, u.data() + part.offset, part.dimension);
        row += part.dimension;
      }
    }
  }
}

void WhitenedRows::times(const Vector& u, Vector& y) const {
  y.resize(rows());
  for (const Bundle& bundle : bundles_) {
    const double* row = values_.data() + bundle.values;
    double* of_rows = y.data() + bundle.row;
    const std::array<const double*, 2> from = {u.data() + bundle.offset[0],
                                               u.data() + bundle.offset[1]};
    const bool is_known = with_known_size(bundle.size, [&](auto size) {
      bundle.parts == 2 ? multiply<size, 2>(row, bundle.rows, from, of_rows)
                        : multiply<size, 1>(row, bundle.rows, from, of_rows);
    });
    for (int i = 0; !is_known && i < bundle.rows; ++i) {
      double sum = 0.0;
      for (const Entry& part : entries_of(bundle.group)) {
        sum += dot(row, u.data() + part.offset, part.dimension);
        row += part.dimension;
      }
      of_rows[i] = sum;
    }
  }
}

/// I plus what add_bundle(bundle, out, pairs of its first group) adds for every bundle.
template <typename AddBundle>
const SparseMatrix& WhitenedRows::assemble(AddBundle add_bundle) {
  double* out = lower_.valuePtr();
  std::fill(out, out + lower_.nonZeros(), 0.0);
  for (const int position : diagonal_position_) {
    out[position] = 1.0;
  }
  const int* pair = pair_of_entries_.data();
  for (const Bundle& bundle : bundles_) {
    add_bundle(bundle, out, pair);
    const int entries = static_cast<int>(entries_of(bundle.group).size());
    pair += bundle.groups * (entries * (entries + 1) / 2);
  }
  return lower_;
}

/// Adds the sum over a bundle's rows of d[row] left(row)^T right(row) where it belongs.
void WhitenedRows::add_products(const Bundle& bundle, const double* left, const double* right,
                                const double* d, double* out, const int* pair) const {
  const std::span<const Entry> parts = entries_of(bundle.group);
  for (const Entry& one : parts) {
    for (const Entry& other : parts) {
      if (one.body < other.body) {
        continue;
      }
      const int* starts = column_starts_.data() + first_column_start_[*pair++];
      const Rows rows = {bundle.rows, bundle.width, left + one.column, right + other.column};
      if (&one == &other) {
        add_outer_fast<true>(rows, d, one.dimension, other.dimension, out, starts);
      } else {
        add_outer_fast<false>(rows, d, one.dimension, other.dimension, out, starts);
      }
    }
  }
}

const SparseMatrix& WhitenedRows::body_space_matrix(const Vector& d) {
  return assemble([this, &d](const Bundle& bundle, double* out, const int* pair) {
    const auto of_rows = d.segment(bundle.row, bundle.rows);
    if (!of_rows.isZero(0.0)) {
      const double* G = values_.data() + bundle.values;
      add_products(bundle, G, G, of_rows.data(), out, pair);
    }
  });
}

const SparseMatrix& WhitenedRows::body_space_matrix(std::span<const double> blocks) {
  const double* D = blocks.data();
  return assemble([this, &D](const Bundle& bundle, double* out, const int* pair) {
    const double* G = values_.data() + bundle.values;
    const std::size_t numbers = static_cast<std::size_t>(bundle.rows) * bundle.width;
    work_.assign(numbers + WeightedProduct::kSize, 0.0);  // D G, row by row
    const double* of_group = G;
    double* DG = work_.data();
    for (int g = bundle.group; g < bundle.group + bundle.groups; ++g) {
      const int size = group_rows(g);
      for (int i = 0; i < size; ++i, DG += bundle.width) {
        for (int j = 0; j < size; ++j) {
          add(D[j * size + i], of_group + j * bundle.width, DG, bundle.width);
        }
      }
      of_group += size * bundle.width;
      D += size * size;
    }
    ones_.resize(std::max<std::size_t>(ones_.size(), bundle.rows), 1.0);
    add_products(bundle, work_.data(), G, ones_.data(), out, pair);
  });
}

}  // namespace signorini::lcp
