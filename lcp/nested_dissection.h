#pragma once

#include <signorini/lcp/fill_ordering.h>
#include <signorini/lcp/vertex_separator.h>

#include <vector>

namespace signorini::lcp {

/// An order of elimination by nested dissection (George, SIAM J. Numer. Anal. 10, 1973): a small
/// separator (vertex_separator.h) is ordered behind the two parts it leaves, and so on in the
/// parts. On large piles in space it needs a half to a third of the flops of minimum degree; on
/// small or thin graphs more. Parts of at most kLeaf nodes are ordered by minimum degree.
/// Deterministic.
class NestedDissection {
 public:
  static constexpr int kLeaf = 100;

  void order(const Graph& graph, std::vector<int>& order);

 private:
  void take_part(const Graph& graph, int begin, int end);
  int split_components(int begin, int end);
  void order_leaf(int begin, int end);

  VertexSeparator separator_;
  std::vector<int> nodes_;  // a permutation; parts are ranges of it
  std::vector<int> local_;  // of a node: its number in the part at hand, or -1
  Graph part_;
  std::vector<CutSide> side_;
  std::vector<int> scratch_, queue_, leaf_order_;
};

}  // namespace signorini::lcp
