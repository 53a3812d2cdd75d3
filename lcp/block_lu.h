#pragma once

#include <signorini/lcp/dense_kernels.h>
#include <signorini/lcp/front_tree.h>
#include <signorini/lcp/types.h>

#include <span>
#include <vector>

namespace signorini::lcp {

/// P H = L U for matrices with a symmetric pattern made of small dense blocks, such as one block a
/// body: multifrontal, on the structure of front_tree.h, each front factored by dense_kernels.h.
///
/// The pivots are the diagonal's, exchanged only among DenseKernels::kPivots neighbours in a front:
/// for matrices whose diagonal is large, and an answer is as good as its residual says. factor()
/// and solve() allocate nothing, and analyse() does nothing when the pattern is the last one's.
/// Twice the flops and memory of BlockCholesky. One thread; the same bits every time on one
/// machine.
class BlockLu {
 public:
  /// A compressed matrix in someone else's memory, rows sorted in each column.
  using View = Eigen::Map<const SparseMatrix>;

  /// @param kernels the instruction set; dense_kernels().front() is this machine's best
  explicit BlockLu(const DenseKernels& kernels = dense_kernels().front());

  /// Orders and analyses the pattern. @param matrix n x n, with its diagonal
  void analyse(const View& matrix);
  /// Factors a matrix of the analysed pattern. @return false if a pivot is 0 or not finite; solve()
  /// must then not be called.
  [[nodiscard]] bool factor(const View& matrix);
  /// x <- H^-1 x. @param x n numbers @pre factor() returned true.
  void solve(std::span<double> x);

  /// Held, of whichever analysis.
  [[nodiscard]] std::size_t bytes() const;

 private:
  DenseKernels kernels_;
  FrontTree tree_;
  FrontTree::Scatter lower_scatter_, upper_scatter_;
  std::vector<double> lower_, upper_;  // panels of L and of U^T
  std::vector<double> lower_stack_, upper_stack_;
  std::vector<int> exchanges_;          // of rows, each in its front
  std::vector<double> ones_, inverse_;  // of the diagonals of L and U
  std::vector<double> work_, below_;
};

}  // namespace signorini::lcp
