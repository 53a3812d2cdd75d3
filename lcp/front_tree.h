#pragma once

#include <signorini/lcp/dense_kernels.h>
#include <signorini/lcp/least_fill.h>

#include <cstddef>
#include <span>
#include <vector>

namespace signorini::lcp {

/// The pattern of a square matrix, compressed by columns, rows sorted in each: symmetric and whole,
/// or its lower triangle. With the diagonal.
struct SparsePattern {
  int columns;
  const int* outer;  ///< columns + 1
  const int* inner;
  bool whole;

  [[nodiscard]] int entries() const { return outer[columns]; }
};

/// The structure of a multifrontal factorisation (Duff, Reid 1983; Liu, SIAM Review 34, 1992) of
/// matrices with a symmetric pattern made of small dense blocks, such as one block a body, ordered
/// on the graph of the blocks by least_fill.h.
///
/// The blocks are found in the pattern: neighbouring columns with the same rows. Each supernode of
/// the factor is a front: a dense panel of the columns that are factored there, and an update, what
/// these subtract from later rows. It goes up to the front's parent, whose place for it is known
/// from here. Panels and updates hold one triangle; a factorisation that is not symmetric has two
/// sets of them, the second for the transpose of the upper triangle.
class FrontTree {
 public:
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
    std::ptrdiff_t panel;                 // in a set of panels
    std::ptrdiff_t update, moved_update;  // in a stack, while it is made and after
    int parent;
    int child, sibling;          // lists of fronts, -1 ends
    int global_run, parent_run;  // its first runs

    [[nodiscard]] int below() const { return rows - columns; }
  };
  /// Where the numbers of a matrix go: one triangle's, by fronts.
  struct Scatter {
    struct Entry {
      int source;  // in the values of the matrix
      int target;  // in the front's panel
    };
    std::vector<Entry> entries;
    std::vector<int> start;  // of every front's, and the end
  };
  enum class Triangle { kLower, kUpper };

  /// Whether the pattern is the last that was kept.
  [[nodiscard]] bool knows(const SparsePattern& pattern) const;
  void analyse(const SparsePattern& pattern);
  /// To be called once all that depends on the analysis is there: where memory ends before, the
  /// next analysis starts anew.
  void keep(const SparsePattern& pattern);
  /// Where the entries of a matrix of the analysed pattern go that are in the triangle once it is
  /// permuted: of a lower triangle alone all are in kLower.
  void find_scatter(const SparsePattern& pattern, Triangle triangle, Scatter& scatter);

  [[nodiscard]] std::span<const Front> fronts() const {
    return {fronts_.data(), fronts_.size() - 1};
  }
  [[nodiscard]] std::size_t panels_size() const { return panels_size_; }
  [[nodiscard]] std::size_t stack_size() const { return stack_size_; }
  [[nodiscard]] int size() const { return static_cast<int>(scalar_.size()); }
  [[nodiscard]] double entries() const { return entries_; }  ///< of one triangle of the factor
  [[nodiscard]] double flops() const { return flops_; }      ///< of one triangle
  [[nodiscard]] std::size_t bytes() const;

  /// Makes front s of a triangle: its matrix entries, and what its children subtract.
  void assemble(int s, const Scatter& scatter, const double* values, double* panels,
                double* stack) const;
  /// Gives the room of the children's updates back, once front s is factored.
  void move_update(int s, double* stack) const;

  /// From the order of the matrix to that of elimination, and back.
  void permute(const double* x, double* ordered) const;
  void permute_back(const double* ordered, double* x) const;
  /// The numbers of a vector that stand below a front's columns, out of it and back.
  void gather_below(int s, const double* ordered, double* below) const;
  void scatter_below(int s, const double* below, double* ordered) const;
  [[nodiscard]] std::size_t below_size() const { return below_size_; }

 private:
  void find_blocks(const SparsePattern& pattern);
  void find_graph(const SparsePattern& pattern);
  void lay_out_fronts();
  void lay_out_stack();
  void find_runs();
  void add_update(const Front& child, const Front& front, const double* from, double* panel,
                  double* update) const;

  Graph graph_;
  LeastFill least_fill_;
  const Supernodes* supernodes_ = nullptr;  // of least_fill_
  std::vector<int> pattern_outer_, pattern_inner_;
  std::vector<int> lower_start_;                    // a column's first entry of the lower triangle
  std::vector<int> block_start_, block_of_, mark_;  // blocks of columns
  std::vector<int> scalar_;  // column of the matrix -> its place in the order of elimination
  std::vector<int> pivot_start_;
  std::vector<int> place_, bucket_;
  std::vector<Front> fronts_;     // and one behind the last
  std::vector<Run> global_runs_;  // row below a front's columns -> all columns
  std::vector<Run> parent_runs_;  // row below a front's columns -> row of its parent
  std::size_t panels_size_ = 0, stack_size_ = 0, below_size_ = 0;
  double entries_ = 0.0, flops_ = 0.0;
};

}  // namespace signorini::lcp
