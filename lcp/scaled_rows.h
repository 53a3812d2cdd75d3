#pragma once

#include <signorini/lcp/factored_matrix.h>
#include <signorini/lcp/sweep_kernels.h>
#include <signorini/lcp/sweeps.h>

#include <span>
#include <vector>

namespace signorini::lcp {

/// The rows of A = J W J^T + diag(c) in the coordinates of packed sweeps. With W_k = F_k F_k^T, s_i
/// the power of two at or below sqrt(A_ii) (1 where A_ii <= 0), and kappa the power of two near
/// 1 / max_i |q_i| / s_i,
///
///     x_i = kappa s_i z_i,   g_i = J_i F / s_i,   u = sum_i g_i^T x_i = kappa F^T J^T z,
///     kappa w_i / s_i = g_i . u + (c_i / s_i^2) x_i + kappa q_i / s_i.
///
/// One set of numbers g serves both the product and the update (J and W J^T would be two), nothing
/// is rounded by the scaling, and float has the range for every problem. On a block whose W_k is
/// given and not positive definite, u is kappa W J^T z and the update is stored beside the product.
class ScaledRows {
 public:
  struct Row {
    /// Not on at most two blocks of at most six numbers with a root, or without a usable A_ii.
    bool general;
    RowKind kind;
    std::int32_t blocks[2];  ///< where they start in u, the lower first; the second -1 if there is
                             ///< only one; unless general
    int first_entry;         ///< in entries()
    int last_entry;
    double scale;  ///< s_i
  };
  /// The numbers of a row on one block.
  struct Entry {
    int block;
    int offset;  ///< of the block in u
    int dimension;
    int product;  ///< where g starts in numbers()
    int update;   ///< where what a step adds to u starts
  };

  /// Takes over A. Cost: O(entries of J) times the dimension of a block. Allocates nothing once
  /// capacity is reached.
  /// @param rows q, bounds and coupling of every row; receives scale and inverse
  void set(const FactoredMatrix& A, std::span<SweepRow> rows);

  [[nodiscard]] std::span<const Row> rows() const { return rows_; }
  [[nodiscard]] std::span<const Entry> entries(const Row& row) const {
    return std::span(entries_).subspan(row.first_entry, row.last_entry - row.first_entry);
  }
  [[nodiscard]] const double* numbers() const { return numbers_.data(); }
  [[nodiscard]] double kappa() const { return kappa_; }
  /// Numbers of u: the blocks, each padded to a multiple of kBlockStride.
  [[nodiscard]] int velocity_count() const { return velocity_count_; }
  [[nodiscard]] int block_count() const { return static_cast<int>(offset_.size()); }

  /// The twelve numbers of a row that is not general, as the kernels want them.
  template <typename T>
  void pack(const Row& row, T* g) const;

 private:
  void place_blocks(const BlockMass& mass);
  double gather(const FactoredMatrix& A, int i);
  void scale(int i, const SweepRow& data, double compliance);

  std::vector<int> offset_;      // of a block in u
  std::vector<int> root_start_;  // of a block's root, -1 where it has none
  std::vector<double> roots_;    // row by row
  std::vector<Row> rows_;
  std::vector<Entry> entries_;
  std::vector<double> numbers_;
  int velocity_count_ = 0;
  double kappa_ = 1.0;
};

}  // namespace signorini::lcp
