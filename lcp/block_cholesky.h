#pragma once

#include <signorini/lcp/dense_kernels.h>
#include <signorini/lcp/least_fill.h>
#include <signorini/lcp/sparse_cholesky.h>

#include <cstddef>
#include <vector>

namespace signorini::lcp {

/// H = L L^T for matrices made of small dense blocks, such as one block a body: multifrontal over
/// supernodes (Duff, Reid 1983; Liu, SIAM Review 34, 1992), ordered on the graph of the blocks by
/// least_fill.h.
///
/// The blocks are found in the pattern: neighbouring columns with the same rows. Each supernode is
/// a dense panel, factored by dense_kernels.h; what it subtracts from later rows goes up to its
/// parent, whose place for it is known from the analysis. factor() and solve() allocate nothing,
/// and analyse() does nothing when the pattern is the last one's. One thread; the same bits every
/// time on one machine.
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
  struct Run {  // consecutive rows
    int from;
    int length;
    int to;
  };
  struct Front {
    int first;                            // its first column among all, in the order of elimination
    int columns;                          // factored here
    int rows;                             // columns and what is below
    int ld, ld_update;                    // leading dimensions of the panel and of the update
    std::ptrdiff_t panel;                 // in panels_
    std::ptrdiff_t update, moved_update;  // in stack_, while it is made and after
    int parent;
    int child, sibling;          // lists of fronts, -1 ends
    int scatter;                 // its first number of H in scatter_
    int global_run, parent_run;  // its first runs
  };
  struct Scatter {
    int source;  // in the values of H
    int target;  // in the panel
  };
  [[nodiscard]] bool same_pattern(const SparseMatrix& lower) const;
  void find_blocks(const SparseMatrix& lower);
  void find_graph(const SparseMatrix& lower);
  void lay_out_fronts();
  void lay_out_stack();
  void find_scatter(const SparseMatrix& lower);
  void find_runs();
  [[nodiscard]] bool factor_front(int s, const double* values);
  void add_update(const Front& child, const Front& front, double* panel, double* update);

  DenseKernels kernels_;
  Graph graph_;
  LeastFill least_fill_;
  const Supernodes* supernodes_ = nullptr;  // of least_fill_
  std::vector<int> pattern_outer_, pattern_inner_;
  std::vector<int> block_start_, block_of_, mark_;  // blocks of columns
  std::vector<int> scalar_;  // column of H -> its place in the order of elimination
  std::vector<int> pivot_start_;
  std::vector<int> place_, bucket_;
  std::vector<Front> fronts_;  // and one behind the last
  std::vector<Scatter> scatter_;
  std::vector<Run> global_runs_;  // row below a front's columns -> all columns
  std::vector<Run> parent_runs_;  // row below a front's columns -> row of its parent
  std::vector<double> panels_, stack_, work_, below_;
  std::vector<double> inverse_;  // of the diagonal of L
  SparseCholeskyCounts counts_;
};

}  // namespace signorini::lcp
