#pragma once

#include <signorini/lcp/types.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

namespace signorini::lcp {

/// What an analysis and its factor cost.
struct SparseCholeskyCounts {
  double entries = 0.0;   ///< numbers in L, diagonal included
  double flops = 0.0;     ///< of one factorisation: the sum of the squares of the column lengths
  std::size_t bytes = 0;  ///< held by the back-end, at its peak where it knows that
};

/// The sparse factorisation H = L L^T (or L D L^T) of symmetric positive definite matrices that
/// share one pattern: analyse once, factor often. The one interface behind which every back-end
/// stands.
class SparseCholesky {
 public:
  virtual ~SparseCholesky() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Orders and analyses the pattern of H; values are ignored.
  /// @param lower the lower triangle of H, diagonal included, rows sorted in each column,
  /// compressed
  virtual void analyse(const SparseMatrix& lower) = 0;
  /// Factors H. @pre analyse() of the same pattern. @return false if H is not positive definite or
  /// not finite; solve() must then not be called.
  [[nodiscard]] virtual bool factor(const SparseMatrix& lower) = 0;
  /// x <- H^-1 x. @pre factor() returned true.
  virtual void solve(Vector& x) = 0;

  /// Of the last analysis. @pre analyse() was called.
  [[nodiscard]] virtual SparseCholeskyCounts counts() const = 0;
};

/// The back-ends of this build, the default first: "block" (block_cholesky.h; ours), "cholmod"
/// (SuiteSparse; its supernodal module is GPL) where the build has it, and "eigen" (simplicial
/// L D L^T with approximate minimum degree ordering; MPL 2).
[[nodiscard]] std::span<const std::string_view> sparse_cholesky_names();

/// A back-end by name; empty: the default. @throws std::invalid_argument that lists the names.
[[nodiscard]] std::unique_ptr<SparseCholesky> make_sparse_cholesky(std::string_view name = {});

}  // namespace signorini::lcp
