#pragma once

#include <signorini/lcp/dense_kernels.h>
#include <signorini/lcp/front_tree.h>
#include <signorini/lcp/sparse_cholesky.h>

#include <vector>

namespace signorini::lcp {

/// H = L L^T for matrices made of small dense blocks, such as one block a body: multifrontal, on
/// the structure of front_tree.h, each front factored by dense_kernels.h.
///
/// factor() and solve() allocate nothing, and analyse() does nothing when the pattern is the last
/// one's. One thread; the same bits every time on one machine.
class BlockCholesky final : public SparseCholesky {
 public:
  /// @param kernels the instruction set; dense_kernels().front() is this machine's best
  explicit BlockCholesky(const DenseKernels& kernels = dense_kernels().front());

  [[nodiscard]] std::string_view name() const override { return "block"; }
  void analyse(const SparseMatrix& lower) override;
  [[nodiscard]] bool factor(const SparseMatrix& lower) override;
  void solve(Vector& x) override;
  [[nodiscard]] SparseCholeskyCounts counts() const override;

 private:
  DenseKernels kernels_;
  FrontTree tree_;
  FrontTree::Scatter scatter_;
  std::vector<double> panels_, stack_, work_, below_;
  std::vector<double> inverse_;  // of the diagonal of L
};

}  // namespace signorini::lcp
