#pragma once

#include <signorini/lcp/fill_ordering.h>

#include <vector>

namespace signorini::lcp {

/// An order of elimination by nested dissection (George, SIAM J. Numer. Anal. 10, 1973): a small
/// separator is ordered behind the two parts it leaves, and so on in the parts. On large piles in
/// space it needs a half to a third of the flops of minimum degree; on small or thin graphs more.
///
/// A separator starts as a level of a breadth-first search from a far end and is then improved by
/// moving nodes out of it (Fiduccia, Mattheyses 1982; for separators: Ashcraft, Liu 1998). Parts of
/// at most kLeaf nodes are ordered by minimum degree. Deterministic.
class NestedDissection {
 public:
  static constexpr int kLeaf = 100;

  void order(const Graph& graph, std::vector<int>& order);

 private:
  enum Side : signed char { kA, kB, kSeparator, kOutside };

  int split_components(int begin, int end);
  bool bisect(int begin, int end);
  int search(int start, int stamp);
  bool choose_level(int total);
  void improve_separator(int total);
  bool move_best(int total);
  void move(int position, Side to);
  void order_leaf(int begin, int end);

  const Graph* graph_ = nullptr;
  std::vector<int> nodes_;          // a permutation; parts are ranges of it
  std::vector<int> part_;           // of a node: which range is being worked on
  std::vector<Side> side_;          // of a node
  std::vector<int> queue_, level_;  // breadth-first search
  std::vector<int> separator_;
  std::vector<int> weight_of_level_;
  int weight_[3] = {0, 0, 0};
  struct Undo {
    int node;
    Side was;
  };
  std::vector<Undo> undo_;
  std::vector<char> locked_;
  std::vector<int> scratch_, local_, leaf_order_;
  Graph leaf_;
  int stamp_ = 0;
};

}  // namespace signorini::lcp
