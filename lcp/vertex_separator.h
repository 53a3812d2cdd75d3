#pragma once

#include <signorini/lcp/fill_ordering.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace signorini::lcp {

/// Where a node of a graph cut in two is.
enum class CutSide : std::uint8_t { kA, kB, kSeparator };

/// A light set of nodes without which a graph falls into two parts of similar weight: multilevel
/// (Karypis, Kumar, SIAM J. Sci. Comput. 20, 1998). The graph is made coarser by joining matched
/// neighbours, cut where it is small by growing a part from several starts, and made fine again;
/// at every level nodes are moved out of the separator as long as that makes it lighter, through
/// some moves that do not (Fiduccia, Mattheyses 1982; for separators Ashcraft, Liu 1998).
/// Deterministic.
class VertexSeparator {
 public:
  /// @param side receives the side of every node; no edge joins kA and kB
  /// @return whether both parts have nodes
  bool find(const Graph& graph, std::vector<CutSide>& side);

 private:
  struct Level {
    Graph graph;
    std::vector<int> edge_weight;  // of every neighbour: edges of the first graph
    std::vector<int> coarse;       // of every node: its node in the next level
  };
  struct Undo {
    int node;
    CutSide was;
  };
  [[nodiscard]] bool coarsen(const Level& fine, std::vector<int>& coarse_of, Level& coarse);
  void match(const Level& level, std::vector<int>& coarse_of, int& count);
  void grow(const Graph& graph, int start, std::vector<CutSide>& side);
  void cut_coarsest(const Graph& graph, std::vector<CutSide>& side);
  void improve(const Graph& graph, std::vector<CutSide>& side);
  bool move_best(const Graph& graph, std::vector<CutSide>& side);
  void weigh(const Graph& graph, const std::vector<CutSide>& side);
  [[nodiscard]] double cost() const;
  [[nodiscard]] int& weight(CutSide side) { return weight_[static_cast<int>(side)]; }

  std::vector<Level> levels_;
  std::vector<CutSide> trial_, fine_;
  std::vector<int> separator_, queue_, mark_, members_;
  std::vector<char> locked_;
  std::vector<Undo> undo_;
  int weight_[3] = {0, 0, 0};
  int total_ = 0;
};

}  // namespace signorini::lcp
