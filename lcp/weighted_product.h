#pragma once

#include <span>
#include <string_view>

namespace signorini::lcp {

/// block = L^T diag(d) R for a few rows: what a contact adds to a body-space matrix, for one
/// instruction set. Products are rounded before they are added, so that all sets have the same bits
/// and what cancels does so exactly: contacts that lie symmetrically leave a zero, on which a stack
/// stands still.
struct WeightedProduct {
  /// Numbers of L's rows that are read, and rows and leading dimension of block.
  static constexpr int kSize = 8;

  std::string_view name;  ///< "avx512", "avx2" or "baseline"
  /// block (kSize x columns, column-major). L and R: `rows` rows of numbers that are width_L and
  /// width_R apart. All kSize numbers of L's rows are read, the last row's too; what they are of is
  /// the caller's to know.
  void (*multiply)(double* block, const double* L, const double* R, int width_L, int width_R,
                   const double* d, int rows, int columns);
};

/// The sets this machine can run, the fastest first.
[[nodiscard]] std::span<const WeightedProduct> weighted_products();

}  // namespace signorini::lcp
