#pragma once

#include <signorini/lcp/fill_ordering.h>

#include <vector>

namespace signorini::lcp {

/// The symbolic Cholesky factorisation of a graph: which blocks of L are not zero, cut into
/// supernodes, runs of pivots that are factored as one dense panel.
///
/// Elimination tree, its postorder, the structure of every column by merging its children's, and
/// supernodes of equal structure; a supernode is joined to its parent where that makes few zeros
/// (relaxed supernodes: Ashcraft, Grimes 1989). See Davis, Direct Methods for Sparse Linear
/// Systems, 2006, chapters 4.1 to 4.8.
class Supernodes {
 public:
  /// @param order the order of elimination; the pivots of subtrees are exchanged with it, which
  /// changes no fill. Reuses memory.
  void analyse(const Graph& graph, const std::vector<int>& order);

  /// Of the numeric factorisation, panels' zeros included: the sum of the squares of the column
  /// lengths.
  [[nodiscard]] double flops(const Graph& graph) const;

  [[nodiscard]] int count() const { return static_cast<int>(first_pivot.size()) - 1; }

  std::vector<int> order;        ///< order[k]: the node that is the k-th pivot
  std::vector<int> first_pivot;  ///< of every supernode, and behind the last
  std::vector<int> parent;       ///< supernode, or -1; always behind its children
  std::vector<int> row_start;    ///< of every supernode in `rows`, and behind the last
  std::vector<int> rows;         ///< pivots below the supernode's own, increasing

 private:
  void find_tree(const Graph& graph);
  void find_structures(const Graph& graph);
  void find_postorder();
  void cut(const Graph& graph);
  void write_rows();

  std::vector<int> input_order_, position_;             // k-th pivot as given, and where a node is
  std::vector<int> tree_parent_, ancestor_;             // by pivot as given
  std::vector<int> structure_start_, structure_;        // rows below each pivot
  std::vector<int> size_, below_, mark_;                // weights: of a pivot, of its structure
  std::vector<int> child_, sibling_, by_size_, stack_;  // children as lists
  std::vector<int> post_, post_position_;
  std::vector<int> cut_, joined_columns_, joined_below_;  // supernodes while they are joined
  std::vector<double> joined_zeros_;
};

}  // namespace signorini::lcp
