#include <signorini/lcp/vector_lanes.h>
#include <signorini/lcp/weighted_product.h>

#include <array>
#include <cstddef>

// Compiled without contraction of products and sums (CMakeLists.txt).

namespace signorini::lcp {
namespace {

using namespace vector_lanes;
constexpr int kSize = WeightedProduct::kSize;

template <typename V, int kColumns>
SIGNORINI_INLINE void multiply_columns(double* block, const double* L, const double* R, int width_L,
                                       int width_R, const double* d, int rows) {
  constexpr int kVectors = kSize / kLanes<V>;
  V sum[kColumns][kVectors];
#pragma GCC unroll 8
  for (int c = 0; c < kColumns; ++c) {
#pragma GCC unroll 4
    for (int i = 0; i < kVectors; ++i) {
      sum[c][i] = V{};
    }
  }
  for (int row = 0; row < rows; ++row, L += width_L, R += width_R) {
    V weighted[kVectors];
#pragma GCC unroll 4
    for (int i = 0; i < kVectors; ++i) {
      weighted[i] = load<V>(L + i * kLanes<V>) * d[row];
    }
#pragma GCC unroll 8
    for (int c = 0; c < kColumns; ++c) {
#pragma GCC unroll 4
      for (int i = 0; i < kVectors; ++i) {
        sum[c][i] += weighted[i] * R[c];
      }
    }
  }
#pragma GCC unroll 8
  for (int c = 0; c < kColumns; ++c) {
#pragma GCC unroll 4
    for (int i = 0; i < kVectors; ++i) {
      store<V>(sum[c][i], block + c * kSize + i * kLanes<V>);
    }
  }
}

/// As many columns at once as the registers hold.
template <typename V>
SIGNORINI_INLINE void multiply(double* block, const double* L, const double* R, int width_L,
                               int width_R, const double* d, int rows, int columns) {
  constexpr int kMost = kLanes<V> == 8 ? 6 : kLanes<V>;
  int c = 0;
  for (; c + kMost <= columns; c += kMost) {
    multiply_columns<V, kMost>(block + c * kSize, L, R + c, width_L, width_R, d, rows);
  }
  if constexpr (kMost > 4) {
    if (c + 4 <= columns) {
      multiply_columns<V, 4>(block + c * kSize, L, R + c, width_L, width_R, d, rows);
      c += 4;
    }
  }
  if constexpr (kMost > 2) {
    if (c + 2 <= columns) {
      multiply_columns<V, 2>(block + c * kSize, L, R + c, width_L, width_R, d, rows);
      c += 2;
    }
  }
  if (c < columns) {
    multiply_columns<V, 1>(block + c * kSize, L, R + c, width_L, width_R, d, rows);
  }
}

#define SIGNORINI_PRODUCT(set, attribute, V)                                                  \
  attribute void multiply_##set(double* block, const double* L, const double* R, int width_L, \
                                int width_R, const double* d, int rows, int columns) {        \
    multiply<V>(block, L, R, width_L, width_R, d, rows, columns);                             \
  }

SIGNORINI_PRODUCT(baseline, , Two)
#if defined(__x86_64__)
SIGNORINI_PRODUCT(avx2, [[gnu::target("avx2")]], Four)
SIGNORINI_PRODUCT(avx512, [[gnu::target("avx512f")]], Eight)
#endif

struct Supported {
  std::array<WeightedProduct, 3> sets;
  std::size_t count = 0;
};

Supported find_supported() {
  Supported supported;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) {
    supported.sets[supported.count++] = {"avx512", multiply_avx512};
  }
  if (__builtin_cpu_supports("avx2")) {
    supported.sets[supported.count++] = {"avx2", multiply_avx2};
  }
#endif
  supported.sets[supported.count++] = {"baseline", multiply_baseline};
  return supported;
}

}  // namespace

std::span<const WeightedProduct> weighted_products() {
  static const Supported supported = find_supported();
  return {supported.sets.data(), supported.count};
}

}  // namespace signorini::lcp
