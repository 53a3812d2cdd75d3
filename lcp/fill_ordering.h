#pragma once

#include <vector>

namespace signorini::lcp {

/// An undirected graph of weighted nodes: node k's neighbours are neighbours[start[k]] ..
/// neighbours[start[k + 1] - 1], sorted, without k itself; every edge is stored from both ends.
/// As a matrix: one block of weight[k] rows a node, one block of non-zeros an edge.
struct Graph {
  std::vector<int> start{0};
  std::vector<int> neighbours;
  std::vector<int> weight;

  [[nodiscard]] int nodes() const { return static_cast<int>(start.size()) - 1; }
};

/// An order of elimination with little fill: order[k] is the k-th pivot. Approximate minimum
/// degree (Amestoy, Davis, Duff 1996; Eigen's implementation, which ignores the weights).
/// Deterministic.
void order_by_minimum_degree(const Graph& graph, std::vector<int>& order);

}  // namespace signorini::lcp
