#include <signorini/lcp/nested_dissection.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace signorini::lcp {
namespace {

constexpr double kMostOfOneSide = 0.6;  // of the weight
constexpr int kPasses = 4;              // of improvement

}  // namespace

void NestedDissection::order(const Graph& graph, std::vector<int>& order) {
  graph_ = &graph;
  const int n = graph.nodes();
  nodes_.resize(n);
  std::iota(nodes_.begin(), nodes_.end(), 0);
  part_.assign(n, 0);
  side_.assign(n, kOutside);
  level_.assign(n, -1);
  locked_.assign(n, 0);
  local_.assign(n, -1);
  stamp_ = 0;
  // Ranges still to be cut; what is cut off behind is done.
  std::vector<std::pair<int, int>> ranges{{0, n}};
  while (!ranges.empty()) {
    const auto [begin, end] = ranges.back();
    ranges.pop_back();
    if (end - begin <= kLeaf) {
      order_leaf(begin, end);
      continue;
    }
    ++stamp_;
    for (int k = begin; k < end; ++k) {
      part_[nodes_[k]] = stamp_;
    }
    if (const int cut = split_components(begin, end); cut < end) {
      ranges.emplace_back(begin, cut);
      ranges.emplace_back(cut, end);
      continue;
    }
    if (!bisect(begin, end)) {
      order_leaf(begin, end);
      continue;
    }
    // A, B and the separator, in the order they had.
    scratch_.clear();
    int cuts[2];
    for (const Side side : {kA, kB, kSeparator}) {
      for (int k = begin; k < end; ++k) {
        if (side_[nodes_[k]] == side) {
          scratch_.push_back(nodes_[k]);
        }
      }
      if (side != kSeparator) {
        cuts[side] = begin + static_cast<int>(scratch_.size());
      }
    }
    std::copy(scratch_.begin(), scratch_.end(), nodes_.begin() + begin);
    ranges.emplace_back(begin, cuts[kA]);
    ranges.emplace_back(cuts[kA], cuts[kB]);
    for (int k = cuts[kB]; k < end; ++k) {
      part_[nodes_[k]] = 0;
    }
  }
  order = nodes_;
}

/// Breadth-first levels of the part from a node. @return how many nodes were reached: queue_.
int NestedDissection::search(int start, int stamp) {
  queue_.assign(1, start);
  level_[start] = 0;
  for (std::size_t k = 0; k < queue_.size(); ++k) {
    const int node = queue_[k];
    for (int e = graph_->start[node]; e < graph_->start[node + 1]; ++e) {
      const int other = graph_->neighbours[e];
      if (part_[other] == stamp && level_[other] < 0) {
        level_[other] = level_[node] + 1;
        queue_.push_back(other);
      }
    }
  }
  return static_cast<int>(queue_.size());
}

/// Puts the component of the first node in front. @return where it ends.
int NestedDissection::split_components(int begin, int end) {
  const int reached = search(nodes_[begin], stamp_);
  if (reached < end - begin) {
    scratch_ = queue_;
    for (int k = begin; k < end; ++k) {
      if (level_[nodes_[k]] < 0) {
        scratch_.push_back(nodes_[k]);
      }
    }
    std::copy(scratch_.begin(), scratch_.end(), nodes_.begin() + begin);
  }
  for (const int node : queue_) {
    level_[node] = -1;
  }
  return begin + reached;
}

/// Sets side_ for the part. @return false if no separator was found.
bool NestedDissection::bisect(int begin, int end) {
  // A far end: the last node of the last level, twice.
  int start = nodes_[begin];
  for (int pass = 0; pass < 3; ++pass) {
    search(start, stamp_);
    start = queue_.back();
    if (pass < 2) {
      for (const int node : queue_) {
        level_[node] = -1;
      }
    }
  }
  int total = 0;
  for (int k = begin; k < end; ++k) {
    total += graph_->weight[nodes_[k]];
  }
  const bool found = choose_level(total);
  for (const int node : queue_) {
    level_[node] = -1;
  }
  if (!found) {
    return false;
  }
  improve_separator(total);
  return weight_[kA] > 0 && weight_[kB] > 0;
}

/// The lightest level that leaves neither side too large becomes the separator.
bool NestedDissection::choose_level(int total) {
  const int levels = level_[queue_.back()] + 1;
  weight_of_level_.assign(levels, 0);
  for (const int node : queue_) {
    weight_of_level_[level_[node]] += graph_->weight[node];
  }
  int best = -1;
  int before = 0;
  for (int l = 0; l < levels; ++l) {
    const int after = total - before - weight_of_level_[l];
    if (std::max(before, after) <= kMostOfOneSide * total &&
        (best < 0 || weight_of_level_[l] < weight_of_level_[best])) {
      best = l;
    }
    before += weight_of_level_[l];
  }
  if (best <= 0 || best == levels - 1) {
    return false;
  }
  separator_.clear();
  std::fill(weight_, weight_ + 3, 0);
  for (const int node : queue_) {
    Side side = level_[node] < best ? kA : kB;
    if (level_[node] == best) {
      side = kSeparator;
      separator_.push_back(node);
    }
    side_[node] = side;
    weight_[side] += graph_->weight[node];
  }
  return true;
}

/// Moves the separator's node at a position to a side; its neighbours on the other side take its
/// place.
void NestedDissection::move(int position, Side to) {
  const int node = separator_[position];
  const Side other = to == kA ? kB : kA;
  separator_[position] = separator_.back();
  separator_.pop_back();
  undo_.push_back({node, kSeparator});
  side_[node] = to;
  locked_[node] = 1;
  weight_[kSeparator] -= graph_->weight[node];
  weight_[to] += graph_->weight[node];
  for (int e = graph_->start[node]; e < graph_->start[node + 1]; ++e) {
    const int next = graph_->neighbours[e];
    if (part_[next] == stamp_ && side_[next] == other) {
      undo_.push_back({next, other});
      side_[next] = kSeparator;
      separator_.push_back(next);
      weight_[other] -= graph_->weight[next];
      weight_[kSeparator] += graph_->weight[next];
    }
  }
}

/// The move that makes the separator lightest, whether or not that is lighter than now.
bool NestedDissection::move_best(int total) {
  int best_gain = 0;
  int best_position = -1;
  Side best_side = kA;
  int best_imbalance = 0;
  for (int k = 0; k < static_cast<int>(separator_.size()); ++k) {
    const int node = separator_[k];
    if (locked_[node] != 0) {
      continue;
    }
    int pulled[2] = {0, 0};  // weight on the sides A and B next to it
    for (int e = graph_->start[node]; e < graph_->start[node + 1]; ++e) {
      const int next = graph_->neighbours[e];
      if (part_[next] == stamp_ && side_[next] != kSeparator) {
        pulled[side_[next]] += graph_->weight[next];
      }
    }
    for (const Side to : {kA, kB}) {
      const Side other = to == kA ? kB : kA;
      const int gain = graph_->weight[node] - pulled[other];
      const int larger = weight_[to] + graph_->weight[node];
      const int smaller = weight_[other] - pulled[other];
      if (std::max(larger, smaller) > kMostOfOneSide * total || smaller <= 0) {
        continue;
      }
      const int imbalance = std::abs(larger - smaller);
      if (best_position < 0 || gain > best_gain ||
          (gain == best_gain && imbalance < best_imbalance)) {
        best_gain = gain;
        best_position = k;
        best_side = to;
        best_imbalance = imbalance;
      }
    }
  }
  if (best_position < 0) {
    return false;
  }
  move(best_position, best_side);
  return true;
}

/// Passes of moves, each undone back to its best moment.
void NestedDissection::improve_separator(int total) {
  for (int pass = 0; pass < kPasses; ++pass) {
    undo_.clear();
    const int before = weight_[kSeparator];
    int best = before;
    std::size_t best_length = 0;
    const int patience = 20 + static_cast<int>(separator_.size()) / 4;
    for (int since = 0; since < patience && move_best(total); ++since) {
      if (weight_[kSeparator] < best) {
        best = weight_[kSeparator];
        best_length = undo_.size();
        since = 0;
      }
    }
    while (undo_.size() > best_length) {
      const auto [node, was] = undo_.back();
      undo_.pop_back();
      locked_[node] = 0;
      weight_[side_[node]] -= graph_->weight[node];
      side_[node] = was;
      weight_[was] += graph_->weight[node];
    }
    for (const auto& [node, was] : undo_) {
      locked_[node] = 0;
    }
    separator_.clear();
    for (const int node : queue_) {
      if (side_[node] == kSeparator) {
        separator_.push_back(node);
      }
    }
    if (best == before) {
      return;
    }
  }
}

/// Minimum degree on the part alone.
void NestedDissection::order_leaf(int begin, int end) {
  leaf_.start.assign(1, 0);
  leaf_.neighbours.clear();
  leaf_.weight.clear();
  for (int k = begin; k < end; ++k) {
    local_[nodes_[k]] = k - begin;
  }
  for (int k = begin; k < end; ++k) {
    const int node = nodes_[k];
    for (int e = graph_->start[node]; e < graph_->start[node + 1]; ++e) {
      if (const int other = local_[graph_->neighbours[e]]; other >= 0) {
        leaf_.neighbours.push_back(other);
      }
    }
    std::sort(leaf_.neighbours.begin() + leaf_.start.back(), leaf_.neighbours.end());
    leaf_.start.push_back(static_cast<int>(leaf_.neighbours.size()));
    leaf_.weight.push_back(graph_->weight[node]);
  }
  order_by_minimum_degree(leaf_, leaf_order_);
  scratch_.assign(nodes_.begin() + begin, nodes_.begin() + end);
  for (int k = begin; k < end; ++k) {
    local_[scratch_[k - begin]] = -1;
    nodes_[k] = scratch_[leaf_order_[k - begin]];
  }
}

}  // namespace signorini::lcp
