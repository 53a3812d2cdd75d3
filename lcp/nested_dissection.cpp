#include <signorini/lcp/nested_dissection.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace signorini::lcp {

void NestedDissection::order(const Graph& graph, std::vector<int>& order) {
  const int n = graph.nodes();
  nodes_.resize(n);
  std::iota(nodes_.begin(), nodes_.end(), 0);
  local_.assign(n, -1);
  std::vector<std::pair<int, int>> ranges{{0, n}};  // still to be cut
  while (!ranges.empty()) {
    const auto [begin, end] = ranges.back();
    ranges.pop_back();
    take_part(graph, begin, end);
    if (end - begin <= kLeaf) {
      order_leaf(begin, end);
      continue;
    }
    if (const int cut = split_components(begin, end); cut < end) {
      ranges.emplace_back(begin, cut);
      ranges.emplace_back(cut, end);
      continue;
    }
    if (!separator_.find(part_, side_)) {
      order_leaf(begin, end);
      continue;
    }
    // A, B and the separator, each in the order it had.
    scratch_.clear();
    int ends[2] = {begin, begin};
    for (const CutSide side : {CutSide::kA, CutSide::kB, CutSide::kSeparator}) {
      for (int k = begin; k < end; ++k) {
        if (side_[k - begin] == side) {
          scratch_.push_back(nodes_[k]);
        }
      }
      if (side != CutSide::kSeparator) {
        ends[static_cast<int>(side)] = begin + static_cast<int>(scratch_.size());
      }
    }
    std::copy(scratch_.begin(), scratch_.end(), nodes_.begin() + begin);
    ranges.emplace_back(begin, ends[0]);
    ranges.emplace_back(ends[0], ends[1]);
  }
  order = nodes_;
}

/// part_ <- the graph of the nodes of a range.
void NestedDissection::take_part(const Graph& graph, int begin, int end) {
  part_.start.assign(1, 0);
  part_.neighbours.clear();
  part_.weight.clear();
  for (int k = begin; k < end; ++k) {
    local_[nodes_[k]] = k - begin;
  }
  for (int k = begin; k < end; ++k) {
    const int node = nodes_[k];
    for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      if (const int other = local_[graph.neighbours[e]]; other >= 0) {
        part_.neighbours.push_back(other);
      }
    }
    std::sort(part_.neighbours.begin() + part_.start.back(), part_.neighbours.end());
    part_.start.push_back(static_cast<int>(part_.neighbours.size()));
    part_.weight.push_back(graph.weight[node]);
  }
  for (int k = begin; k < end; ++k) {
    local_[nodes_[k]] = -1;
  }
}

/// Puts the component of the first node in front. @return where it ends.
int NestedDissection::split_components(int begin, int end) {
  const int n = end - begin;
  side_.assign(n, CutSide::kB);
  queue_.assign(1, 0);
  side_[0] = CutSide::kA;
  for (std::size_t k = 0; k < queue_.size(); ++k) {
    for (int e = part_.start[queue_[k]]; e < part_.start[queue_[k] + 1]; ++e) {
      const int other = part_.neighbours[e];
      if (side_[other] == CutSide::kB) {
        side_[other] = CutSide::kA;
        queue_.push_back(other);
      }
    }
  }
  if (static_cast<int>(queue_.size()) < n) {
    scratch_.assign(nodes_.begin() + begin, nodes_.begin() + end);
    int to = begin;
    for (const CutSide side : {CutSide::kA, CutSide::kB}) {
      for (int k = 0; k < n; ++k) {
        if (side_[k] == side) {
          nodes_[to++] = scratch_[k];
        }
      }
    }
  }
  return begin + static_cast<int>(queue_.size());
}

/// Minimum degree on the part alone.
void NestedDissection::order_leaf(int begin, int end) {
  order_by_minimum_degree(part_, leaf_order_);
  scratch_.assign(nodes_.begin() + begin, nodes_.begin() + end);
  for (int k = begin; k < end; ++k) {
    nodes_[k] = scratch_[leaf_order_[k - begin]];
  }
}

}  // namespace signorini::lcp
