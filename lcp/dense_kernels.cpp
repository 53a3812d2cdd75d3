#include <signorini/lcp/dense_kernels.h>
#include <signorini/lcp/vector_lanes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace signorini::lcp {
namespace {

using namespace vector_lanes;
using Stride = std::ptrdiff_t;

constexpr int kBlock = DenseKernels::kPivots;  // columns factored together
constexpr int kDepth = 128;  // inner length of a product at a time: what the first cache holds

/// C (kVectors vectors of rows, kColumns columns) -= A B^T over `depth` columns of A and B.
template <typename V, int kVectors, int kColumns>
SIGNORINI_INLINE void subtract_tile(double* C, Stride ldc, const double* A, const double* B,
                                    Stride ld, int depth) {
  V sum[kColumns][kVectors];
#pragma GCC unroll 8
  for (int j = 0; j < kColumns; ++j) {
#pragma GCC unroll 4
    for (int i = 0; i < kVectors; ++i) {
      sum[j][i] = V{};
    }
  }
  for (int k = 0; k < depth; ++k, A += ld, B += ld) {
    V a[kVectors];
#pragma GCC unroll 4
    for (int i = 0; i < kVectors; ++i) {
      a[i] = load<V>(A + i * kLanes<V>);
    }
#pragma GCC unroll 8
    for (int j = 0; j < kColumns; ++j) {
#pragma GCC unroll 4
      for (int i = 0; i < kVectors; ++i) {
        sum[j][i] += a[i] * B[j];
      }
    }
  }
#pragma GCC unroll 8
  for (int j = 0; j < kColumns; ++j) {
#pragma GCC unroll 4
    for (int i = 0; i < kVectors; ++i) {
      double* c = C + j * ldc + i * kLanes<V>;
      store<V>(load<V>(c) - sum[j][i], c);
    }
  }
}

/// The same for any number of rows, in whole vectors: rows behind the last are scratch.
template <typename V, int kVectors, int kColumns>
SIGNORINI_INLINE void subtract_columns(double* C, Stride ldc, const double* A, const double* B,
                                       Stride ld, int rows, int depth) {
  int i = 0;
  for (; rows - i > (kVectors - 1) * kLanes<V>; i += kVectors * kLanes<V>) {
    subtract_tile<V, kVectors, kColumns>(C + i, ldc, A + i, B, ld, depth);
  }
  if constexpr (kVectors > 2) {
    if (rows - i > kLanes<V>) {
      subtract_tile<V, 2, kColumns>(C + i, ldc, A + i, B, ld, depth);
      return;
    }
  }
  if (rows - i > 0) {
    subtract_tile<V, 1, kColumns>(C + i, ldc, A + i, B, ld, depth);
  }
}

/// The same for 1 to kBlock columns.
template <typename V, int kVectors, int kColumns>
SIGNORINI_INLINE void subtract_block(double* C, Stride ldc, const double* A, const double* B,
                                     Stride ld, int rows, int columns, int depth) {
  int j = 0;
  for (; j + kColumns <= columns; j += kColumns) {
    subtract_columns<V, kVectors, kColumns>(C + j * ldc, ldc, A, B + j, ld, rows, depth);
  }
  if constexpr (kColumns > 4) {
    if (j + 4 <= columns) {
      subtract_columns<V, kVectors, 4>(C + j * ldc, ldc, A, B + j, ld, rows, depth);
      j += 4;
    }
  }
  if constexpr (kColumns > 2) {
    if (j + 2 <= columns) {
      subtract_columns<V, kVectors, 2>(C + j * ldc, ldc, A, B + j, ld, rows, depth);
      j += 2;
    }
  }
  if (j < columns) {
    subtract_columns<V, kVectors, 1>(C + j * ldc, ldc, A, B + j, ld, rows, depth);
  }
}

/// L of the kSize x kSize block at `block`, into L (column-major); the inverses of its diagonal.
template <int kSize>
SIGNORINI_INLINE bool factor_diagonal(const double* block, Stride ld, double* L, double* inverse) {
#pragma GCC unroll 8
  for (int c = 0; c < kSize; ++c) {
#pragma GCC unroll 8
    for (int r = c; r < kSize; ++r) {
      L[c * kSize + r] = block[c * ld + r];
    }
  }
#pragma GCC unroll 8
  for (int c = 0; c < kSize; ++c) {
    const double pivot = L[c * kSize + c];
    if (!(pivot > 0.0 && pivot <= 1.7976931348623157e308)) {
      return false;
    }
    const double root = std::sqrt(pivot);
    L[c * kSize + c] = root;
    inverse[c] = 1.0 / root;
#pragma GCC unroll 8
    for (int r = c + 1; r < kSize; ++r) {
      L[c * kSize + r] *= inverse[c];
    }
#pragma GCC unroll 8
    for (int k = c + 1; k < kSize; ++k) {
#pragma GCC unroll 8
      for (int r = k; r < kSize; ++r) {
        L[k * kSize + r] -= L[c * kSize + r] * L[c * kSize + k];
      }
    }
  }
  return true;
}

/// Factors kSize columns of which everything to the left has been subtracted.
template <typename V, int kSize>
SIGNORINI_INLINE bool factor_block(double* panel, Stride ld, int first, int rows) {
  double L[kSize * kSize];
  double inverse[kSize];
  double* diagonal = panel + first * ld + first;
  if (!factor_diagonal<kSize>(diagonal, ld, L, inverse)) {
    return false;
  }
  // Rows below, in whole vectors from an aligned row on; what that does to the diagonal block is
  // overwritten.
  const int start = (first + kSize) / kLanes<V> * kLanes<V>;
  for (int i = start; i < rows; i += kLanes<V>) {
    double* row = panel + first * ld + i;
    V x[kSize];
#pragma GCC unroll 8
    for (int c = 0; c < kSize; ++c) {
      V value = load<V>(row + c * ld);
#pragma GCC unroll 8
      for (int k = 0; k < c; ++k) {
        value -= x[k] * L[k * kSize + c];
      }
      x[c] = value * inverse[c];
    }
#pragma GCC unroll 8
    for (int c = 0; c < kSize; ++c) {
      store<V>(x[c], row + c * ld);
    }
  }
#pragma GCC unroll 8
  for (int c = 0; c < kSize; ++c) {
#pragma GCC unroll 8
    for (int r = c; r < kSize; ++r) {
      diagonal[c * ld + r] = L[c * kSize + r];
    }
  }
  return true;
}

template <typename V>
SIGNORINI_INLINE bool factor_any_block(double* panel, Stride ld, int first, int rows, int size) {
  switch (size) {
    case 1: return factor_block<V, 1>(panel, ld, first, rows);
    case 2: return factor_block<V, 2>(panel, ld, first, rows);
    case 3: return factor_block<V, 3>(panel, ld, first, rows);
    case 4: return factor_block<V, 4>(panel, ld, first, rows);
    case 5: return factor_block<V, 5>(panel, ld, first, rows);
    case 6: return factor_block<V, 6>(panel, ld, first, rows);
    case 7: return factor_block<V, 7>(panel, ld, first, rows);
    default: return factor_block<V, 8>(panel, ld, first, rows);
  }
}

/// Columns [from, to) of C -= A B^T over the columns [left, right) of panels A and B, lower
/// trapezoid. from is a multiple of kBlock: whole vectors stay inside the column.
template <typename V, int kVectors, int kColumns>
SIGNORINI_INLINE void subtract_left(double* C, const double* A, const double* B, Stride ld,
                                    int rows, int from, int to, int left, int right) {
  for (int j = from; j < to && left < right; j += kBlock) {
    subtract_block<V, kVectors, kColumns>(C + j * ld + j, ld, A + left * ld + j, B + left * ld + j,
                                          ld, rows - j, std::min(kBlock, to - j), right - left);
  }
}

/// Column by column in blocks of kDepth, whose products with themselves are subtracted from what is
/// right of them once they are factored: a wide panel goes through the caches once a block.
template <typename V, int kVectors, int kColumns>
SIGNORINI_INLINE bool factor_panel(double* panel, int ld, int rows, int columns) {
  for (int outer = 0; outer < columns; outer += kDepth) {
    const int end = std::min(outer + kDepth, columns);
    for (int first = outer; first < end; first += kBlock) {
      const int next = std::min(first + kBlock, end);
      subtract_left<V, kVectors, kColumns>(panel, panel, panel, ld, rows, first, next, outer,
                                           first);
      if (!factor_any_block<V>(panel, ld, first, rows, next - first)) {
        return false;
      }
    }
    subtract_left<V, kVectors, kColumns>(panel, panel, panel, ld, rows, end, columns, outer, end);
  }
  return true;
}

template <typename V, int kVectors, int kColumns>
SIGNORINI_INLINE void subtract_square(double* square, int ld_square, const double* A,
                                      const double* B, int ld, int size, int columns) {
  for (int k = 0; k < columns; k += kDepth) {
    const int depth = std::min(kDepth, columns - k);
    const Stride from = static_cast<Stride>(k) * ld;
    for (int j = 0; j < size; j += kBlock) {
      subtract_block<V, kVectors, kColumns>(square + static_cast<Stride>(j) * ld_square + j,
                                            ld_square, A + from + j, B + from + j, ld, size - j,
                                            std::min(kBlock, size - j), depth);
    }
  }
}

/// P M = L U of the kSize x kSize block at `lower`, `upper` (its transpose), into M (column-major,
/// both triangles); the inverses of the diagonal of U. swap(a, b) is told of every exchange.
template <int kSize, typename Swap>
SIGNORINI_INLINE bool factor_lu_diagonal(const double* lower, const double* upper, Stride ld,
                                         double* M, double* inverse, const Swap& swap) {
  constexpr double kEnough = 0.1;  // of the largest number below
#pragma GCC unroll 8
  for (int c = 0; c < kSize; ++c) {
#pragma GCC unroll 8
    for (int r = 0; r < kSize; ++r) {
      M[c * kSize + r] = r >= c ? lower[c * ld + r] : upper[r * ld + c];
    }
  }
#pragma GCC unroll 8
  for (int c = 0; c < kSize; ++c) {
    int best = c;
    for (int r = c + 1; r < kSize; ++r) {
      if (std::abs(M[c * kSize + r]) > std::abs(M[c * kSize + best])) {
        best = r;
      }
    }
    if (!(std::abs(M[c * kSize + c]) >= kEnough * std::abs(M[c * kSize + best]))) {
      for (int k = 0; k < kSize; ++k) {
        std::swap(M[k * kSize + c], M[k * kSize + best]);
      }
      swap(c, best);
    }
    const double pivot = M[c * kSize + c];
    if (!(pivot != 0.0 && std::abs(pivot) <= 1.7976931348623157e308)) {
      return false;
    }
    inverse[c] = 1.0 / pivot;
#pragma GCC unroll 8
    for (int r = c + 1; r < kSize; ++r) {
      M[c * kSize + r] *= inverse[c];
    }
#pragma GCC unroll 8
    for (int k = c + 1; k < kSize; ++k) {
#pragma GCC unroll 8
      for (int r = c + 1; r < kSize; ++r) {
        M[k * kSize + r] -= M[c * kSize + r] * M[k * kSize + c];
      }
    }
  }
  return true;
}

/// rows of kSize columns <- rows T^-1 from row `start` on, in whole vectors: T triangular, with
/// entry(k, c) above its diagonal, and inverse(c) of its diagonal.
template <typename V, int kSize, typename Entry, typename Inverse>
SIGNORINI_INLINE void divide_rows(double* columns, Stride ld, int start, int rows,
                                  const Entry& entry, const Inverse& inverse) {
  for (int i = start; i < rows; i += kLanes<V>) {
    V x[kSize];
#pragma GCC unroll 8
    for (int c = 0; c < kSize; ++c) {
      V value = load<V>(columns + c * ld + i);
#pragma GCC unroll 8
      for (int k = 0; k < c; ++k) {
        value -= x[k] * entry(k, c);
      }
      x[c] = value * inverse(c);
    }
#pragma GCC unroll 8
    for (int c = 0; c < kSize; ++c) {
      store<V>(x[c], columns + c * ld + i);
    }
  }
}

/// Factors kSize columns of both panels of which everything to the left has been subtracted.
template <typename V, int kSize>
SIGNORINI_INLINE bool factor_lu_block(double* lower, double* upper, Stride ld, int first, int rows,
                                      int* exchanges) {
  double M[kSize * kSize];
  double inverse[kSize];
  for (int c = 0; c < kSize; ++c) {
    exchanges[first + c] = first + c;
  }
  const auto swap_rows = [&](int a, int b) {
    exchanges[first + a] = first + b;
    for (int k = 0; k < first; ++k) {
      std::swap(lower[k * ld + first + a], lower[k * ld + first + b]);
    }
    for (int i = first + kSize; i < rows; ++i) {
      std::swap(upper[(first + a) * ld + i], upper[(first + b) * ld + i]);
    }
  };
  const Stride diagonal = first * ld + first;
  if (!factor_lu_diagonal<kSize>(lower + diagonal, upper + diagonal, ld, M, inverse, swap_rows)) {
    return false;
  }
  // In whole vectors from an aligned row on; what that does to the diagonal block is overwritten.
  const int start = (first + kSize) / kLanes<V> * kLanes<V>;
  divide_rows<V, kSize>(
      lower + first * ld, ld, start, rows, [&](int k, int c) { return M[c * kSize + k]; },
      [&](int c) { return inverse[c]; });
  divide_rows<V, kSize>(
      upper + first * ld, ld, start, rows, [&](int k, int c) { return M[k * kSize + c]; },
      [](int) { return 1.0; });
  for (int c = 0; c < kSize; ++c) {
    for (int r = c; r < kSize; ++r) {
      lower[diagonal + c * ld + r] = r == c ? 1.0 : M[c * kSize + r];
      upper[diagonal + c * ld + r] = M[r * kSize + c];
    }
  }
  return true;
}

template <typename V>
SIGNORINI_INLINE bool factor_any_lu_block(double* lower, double* upper, Stride ld, int first,
                                          int rows, int size, int* exchanges) {
  switch (size) {
    case 1: return factor_lu_block<V, 1>(lower, upper, ld, first, rows, exchanges);
    case 2: return factor_lu_block<V, 2>(lower, upper, ld, first, rows, exchanges);
    case 3: return factor_lu_block<V, 3>(lower, upper, ld, first, rows, exchanges);
    case 4: return factor_lu_block<V, 4>(lower, upper, ld, first, rows, exchanges);
    case 5: return factor_lu_block<V, 5>(lower, upper, ld, first, rows, exchanges);
    case 6: return factor_lu_block<V, 6>(lower, upper, ld, first, rows, exchanges);
    case 7: return factor_lu_block<V, 7>(lower, upper, ld, first, rows, exchanges);
    default: return factor_lu_block<V, 8>(lower, upper, ld, first, rows, exchanges);
  }
}

/// Column by column of L and row by row of U (Crout), kBlock at a time, in blocks of kDepth.
template <typename V, int kVectors, int kColumns>
SIGNORINI_INLINE bool factor_lu_panels(double* lower, double* upper, int ld, int rows, int columns,
                                       int* exchanges) {
  const auto subtract = [&](int from, int to, int left, int right) __attribute__((always_inline)) {
    subtract_left<V, kVectors, kColumns>(lower, lower, upper, ld, rows, from, to, left, right);
    subtract_left<V, kVectors, kColumns>(upper, upper, lower, ld, rows, from, to, left, right);
  };
  for (int outer = 0; outer < columns; outer += kDepth) {
    const int end = std::min(outer + kDepth, columns);
    for (int first = outer; first < end; first += kBlock) {
      const int next = std::min(first + kBlock, end);
      subtract(first, next, outer, first);
      if (!factor_any_lu_block<V>(lower, upper, ld, first, rows, next - first, exchanges)) {
        return false;
      }
    }
    subtract(end, columns, outer, end);
  }
  return true;
}

/// y -= L x for four columns of L at a time, whole vectors.
template <typename V>
SIGNORINI_INLINE void subtract_times(const double* L, Stride ld, int rows, int columns,
                                     const double* x, double* y) {
  int c = 0;
  for (; c + 4 <= columns; c += 4, L += 4 * ld) {
    for (int i = 0; i < rows; i += kLanes<V>) {
      V sum = load<V>(L + i) * x[c];
      sum += load<V>(L + ld + i) * x[c + 1];
      V other = load<V>(L + 2 * ld + i) * x[c + 2];
      other += load<V>(L + 3 * ld + i) * x[c + 3];
      store<V>(load<V>(y + i) - (sum + other), y + i);
    }
  }
  for (; c < columns; ++c, L += ld) {
    for (int i = 0; i < rows; i += kLanes<V>) {
      store<V>(load<V>(y + i) - load<V>(L + i) * x[c], y + i);
    }
  }
}

template <int kCount>
struct VectorOf;
template <>
struct VectorOf<4> {
  using Type = Four;
};
template <>
struct VectorOf<2> {
  using Type = Two;
};
template <typename V>
using HalfOf = typename VectorOf<kLanes<V> / 2>::Type;

/// kRows numbers of y += a x_a + b x_b + c x_c.
template <typename V, int kRows>
SIGNORINI_INLINE void add_three(const double* a, const double* b, const double* c, double x_a,
                                double x_b, double x_c, double* y) {
  constexpr int kLength = kLanes<V>;
  if constexpr (kRows >= kLength) {
    store<V>(load<V>(y) + load<V>(a) * x_a + load<V>(b) * x_b + load<V>(c) * x_c, y);
    add_three<V, kRows - kLength>(a + kLength, b + kLength, c + kLength, x_a, x_b, x_c,
                                  y + kLength);
  } else if constexpr (kRows == 1) {
    *y += *a * x_a + *b * x_b + *c * x_c;
  } else if constexpr (kRows > 1) {
    add_three<HalfOf<V>, kRows>(a, b, c, x_a, x_b, x_c, y);
  }
}

template <typename V>
SIGNORINI_INLINE void add_block_of_three(double* block, int ld, const double* L, const double* R,
                                         int width, int rows, int columns) {
  for (int c = 0; c < columns; ++c, ++R, block += ld) {
    const double x_a = R[0];
    const double x_b = R[width];
    const double x_c = R[2 * width];
    if (rows == 6) {
      add_three<V, 6>(L, L + width, L + 2 * width, x_a, x_b, x_c, block);
    } else if (rows == 3) {
      add_three<V, 3>(L, L + width, L + 2 * width, x_a, x_b, x_c, block);
    } else {
      for (int r = 0; r < rows; ++r) {
        block[r] += L[r] * x_a + L[width + r] * x_b + L[2 * width + r] * x_c;
      }
    }
  }
}

template <typename V>
SIGNORINI_INLINE double sum_of(const V& v) {
  if constexpr (kLanes<V> == 2) {
    return v[0] + v[1];
  } else {
    using Half = HalfOf<V>;
    const double* values = reinterpret_cast<const double*>(&v);
    return sum_of<Half>(load<Half>(values) + load<Half>(values + kLanes<Half>));
  }
}

/// x_c -= L(:, c) . y for kColumns columns.
template <typename V, int kColumns>
SIGNORINI_INLINE void subtract_dots(const double* L, Stride ld, int rows, const double* y,
                                    double* x) {
  int i = 0;
  if (rows >= kLanes<V>) {
    V sum[kColumns];
#pragma GCC unroll 4
    for (int c = 0; c < kColumns; ++c) {
      sum[c] = V{};
    }
    for (; i + kLanes<V> <= rows; i += kLanes<V>) {
      const V value = load<V>(y + i);
#pragma GCC unroll 4
      for (int c = 0; c < kColumns; ++c) {
        sum[c] += load<V>(L + c * ld + i) * value;
      }
    }
#pragma GCC unroll 4
    for (int c = 0; c < kColumns; ++c) {
      x[c] -= sum_of<V>(sum[c]);
    }
  }
  if constexpr (kLanes < V >> 2) {
    subtract_dots<HalfOf<V>, kColumns>(L + i, ld, rows - i, y + i, x);
  } else if (i < rows) {
#pragma GCC unroll 4
    for (int c = 0; c < kColumns; ++c) {
      x[c] -= L[c * ld + i] * y[i];
    }
  }
}

template <typename V>
SIGNORINI_INLINE void forward_substitute(const double* panel, int ld, int rows, int columns,
                                         const double* inverse, double* top, double* below) {
  const Stride stride = ld;
  for (int c = 0; c < columns; ++c) {
    const double* column = panel + c * stride;
    top[c] *= inverse[c];
    for (int r = c + 1; r < columns; ++r) {
      top[r] -= column[r] * top[c];
    }
  }
  subtract_times<V>(panel + columns, stride, rows - columns, columns, top, below);
}

template <typename V>
SIGNORINI_INLINE void back_substitute(const double* panel, int ld, int rows, int columns,
                                      const double* inverse, double* top, const double* below) {
  const Stride stride = ld;
  const double* L = panel + columns;
  int c = 0;
  for (; c + 4 <= columns; c += 4) {
    subtract_dots<V, 4>(L + c * stride, stride, rows - columns, below, top + c);
  }
  for (; c < columns; ++c) {
    subtract_dots<V, 1>(L + c * stride, stride, rows - columns, below, top + c);
  }
  // The triangle, from its last columns on, four at a time: what is below them first.
  for (int end = columns; end > 0;) {
    const int first = end >= 4 ? end - 4 : 0;
    if (end - first == 4) {
      subtract_dots<V, 4>(panel + first * stride + end, stride, columns - end, top + end,
                          top + first);
    } else {
      for (c = first; c < end; ++c) {
        subtract_dots<V, 1>(panel + c * stride + end, stride, columns - end, top + end, top + c);
      }
    }
    for (c = end - 1; c >= first; --c) {
      const double* column = panel + c * stride;
      double value = top[c];
      for (int r = c + 1; r < end; ++r) {
        value -= column[r] * top[r];
      }
      top[c] = value * inverse[c];
    }
    end = first;
  }
}

// The functions of a set, compiled for it. kVectors x kColumns tiles fill its registers.
#define SIGNORINI_KERNELS(set, attribute, V, kVectors, kColumns)                                 \
  attribute bool factor_lu_##set(double* lower, double* upper, int ld, int rows, int columns,    \
                                 int* exchanges) {                                               \
    return factor_lu_panels<V, kVectors, kColumns>(lower, upper, ld, rows, columns, exchanges);  \
  }                                                                                              \
  attribute bool factor_##set(double* panel, int ld, int rows, int columns) {                    \
    return factor_panel<V, kVectors, kColumns>(panel, ld, rows, columns);                        \
  }                                                                                              \
  attribute void subtract_product_##set(double* square, int ld_square, const double* A,          \
                                        const double* B, int ld, int size, int columns) {        \
    subtract_square<V, kVectors, kColumns>(square, ld_square, A, B, ld, size, columns);          \
  }                                                                                              \
  attribute void add_product_of_three_##set(double* block, int ld, const double* L,              \
                                            const double* R, int width, int rows, int columns) { \
    add_block_of_three<V>(block, ld, L, R, width, rows, columns);                                \
  }                                                                                              \
  attribute void forward_##set(const double* panel, int ld, int rows, int columns,               \
                               const double* inverse, double* top, double* below) {              \
    forward_substitute<V>(panel, ld, rows, columns, inverse, top, below);                        \
  }                                                                                              \
  attribute void backward_##set(const double* panel, int ld, int rows, int columns,              \
                                const double* inverse, double* top, const double* below) {       \
    back_substitute<V>(panel, ld, rows, columns, inverse, top, below);                           \
  }                                                                                              \
  constexpr DenseKernels k_##set = {#set,                                                        \
                                    factor_##set,                                                \
                                    factor_lu_##set,                                             \
                                    subtract_product_##set,                                      \
                                    add_product_of_three_##set,                                  \
                                    forward_##set,                                               \
                                    backward_##set};

SIGNORINI_KERNELS(baseline, , Two, 2, 4)

#if defined(__x86_64__)
SIGNORINI_KERNELS(avx2, [[gnu::target("avx2,fma")]], Four, 3, 4)
SIGNORINI_KERNELS(avx512, [[gnu::target("avx512f,avx512dq,avx512vl,fma")]], Eight, 3, 8)
#endif

struct Supported {
  std::array<DenseKernels, 3> sets;
  std::size_t count = 0;
};

Supported find_supported() {
  Supported supported;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma")) {
    supported.sets[supported.count++] = k_avx512;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    supported.sets[supported.count++] = k_avx2;
  }
#endif
  supported.sets[supported.count++] = k_baseline;
  return supported;
}

}  // namespace

std::span<const DenseKernels> dense_kernels() {
  static const Supported supported = find_supported();
  return {supported.sets.data(), supported.count};
}

}  // namespace signorini::lcp
