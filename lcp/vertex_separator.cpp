#include <signorini/lcp/vertex_separator.h>

#include <algorithm>
#include <cstdlib>

namespace signorini::lcp {
namespace {

constexpr int kCoarsest = 80;            // nodes
constexpr double kMostOfOneSide = 0.58;  // of the weight
constexpr int kStarts = 10;              // parts grown in the coarsest graph
constexpr int kPasses = 5;               // of improvement at each level

CutSide opposite(CutSide side) {
  return side == CutSide::kA ? CutSide::kB : CutSide::kA;
}

}  // namespace

bool VertexSeparator::find(const Graph& graph, std::vector<CutSide>& side) {
  std::size_t depth = 1;
  levels_.resize(std::max<std::size_t>(levels_.size(), 1));
  levels_[0].graph = graph;
  levels_[0].edge_weight.assign(graph.neighbours.size(), 1);
  while (levels_[depth - 1].graph.nodes() > kCoarsest) {
    levels_.resize(std::max(levels_.size(), depth + 1));
    if (!coarsen(levels_[depth - 1], levels_[depth - 1].coarse, levels_[depth])) {
      break;
    }
    ++depth;
  }
  cut_coarsest(levels_[depth - 1].graph, side);
  for (std::size_t k = depth - 1; k-- > 0;) {
    const Level& level = levels_[k];
    fine_.resize(level.graph.nodes());
    for (int node = 0; node < level.graph.nodes(); ++node) {
      fine_[node] = side[level.coarse[node]];
    }
    side.swap(fine_);
    improve(level.graph, side);
  }
  weigh(graph, side);
  return weight(CutSide::kA) > 0 && weight(CutSide::kB) > 0;
}

/// Pairs of neighbours, the heaviest edge first, the lighter partner where edges are equal.
void VertexSeparator::match(const Level& level, std::vector<int>& coarse_of, int& count) {
  const Graph& graph = level.graph;
  const int n = graph.nodes();
  coarse_of.assign(n, -1);
  count = 0;
  // Nodes in an order that does not follow their numbers: a step without common factor.
  int step = n / 2 + 1;
  const auto common = [](int a, int b) {
    while (b != 0) {
      a = std::exchange(b, a % b);
    }
    return a;
  };
  while (common(step, n) != 1) {
    ++step;
  }
  for (int k = 0, node = 0; k < n; ++k, node = (node + step) % n) {
    if (coarse_of[node] >= 0) {
      continue;
    }
    int best = -1;
    int best_edge = 0;
    for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      const int other = graph.neighbours[e];
      if (coarse_of[other] < 0 &&
          (best < 0 || level.edge_weight[e] > best_edge ||
           (level.edge_weight[e] == best_edge && graph.weight[other] < graph.weight[best]))) {
        best = other;
        best_edge = level.edge_weight[e];
      }
    }
    coarse_of[node] = count;
    if (best >= 0) {
      coarse_of[best] = count;
    }
    ++count;
  }
}

/// @return false if the graph hardly becomes smaller
bool VertexSeparator::coarsen(const Level& fine, std::vector<int>& coarse_of, Level& coarse) {
  const int n = fine.graph.nodes();
  int count = 0;
  match(fine, coarse_of, count);
  if (count > 0.9 * n) {
    return false;
  }
  // The one or two nodes of every coarse node.
  members_.assign(2 * static_cast<std::size_t>(count), -1);
  for (int node = 0; node < n; ++node) {
    const int c = coarse_of[node];
    members_[2 * c + (members_[2 * c] < 0 ? 0 : 1)] = node;
  }
  coarse.graph.start.assign(1, 0);
  coarse.graph.neighbours.clear();
  coarse.graph.weight.assign(count, 0);
  coarse.edge_weight.clear();
  mark_.assign(count, -1);  // where the neighbour stands in the list at hand
  for (int c = 0; c < count; ++c) {
    const int begin = coarse.graph.start.back();
    for (int m = 0; m < 2; ++m) {
      const int node = members_[2 * c + m];
      if (node < 0) {
        continue;
      }
      coarse.graph.weight[c] += fine.graph.weight[node];
      for (int e = fine.graph.start[node]; e < fine.graph.start[node + 1]; ++e) {
        const int other = coarse_of[fine.graph.neighbours[e]];
        if (other == c) {
          continue;
        }
        if (mark_[other] < begin) {
          mark_[other] = static_cast<int>(coarse.graph.neighbours.size());
          coarse.graph.neighbours.push_back(other);
          coarse.edge_weight.push_back(0);
        }
        coarse.edge_weight[mark_[other]] += fine.edge_weight[e];
      }
    }
    coarse.graph.start.push_back(static_cast<int>(coarse.graph.neighbours.size()));
  }
  return true;
}

void VertexSeparator::weigh(const Graph& graph, const std::vector<CutSide>& side) {
  std::fill(weight_, weight_ + 3, 0);
  for (int node = 0; node < graph.nodes(); ++node) {
    weight(side[node]) += graph.weight[node];
  }
  total_ = weight_[0] + weight_[1] + weight_[2];
}

/// The separator's weight, and more for parts of different weight.
double VertexSeparator::cost() const {
  const double larger = std::max(weight_[0], weight_[1]);
  const double excess = std::max(0.0, larger - kMostOfOneSide * total_);
  return weight_[2] + excess + 1e-3 * std::abs(weight_[0] - weight_[1]);
}

/// Breadth first from a node until half of the weight is reached: A. What it touches separates.
void VertexSeparator::grow(const Graph& graph, int start, std::vector<CutSide>& side) {
  const int n = graph.nodes();
  side.assign(n, CutSide::kB);
  mark_.assign(n, 0);
  queue_.assign(1, start);
  mark_[start] = 1;
  int reached = 0;
  std::size_t k = 0;
  for (; k < queue_.size() && 2 * reached < total_; ++k) {
    const int node = queue_[k];
    side[node] = CutSide::kA;
    reached += graph.weight[node];
    for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      if (mark_[graph.neighbours[e]] == 0) {
        mark_[graph.neighbours[e]] = 1;
        queue_.push_back(graph.neighbours[e]);
      }
    }
  }
  for (; k < queue_.size(); ++k) {
    side[queue_[k]] = CutSide::kSeparator;
  }
}

void VertexSeparator::cut_coarsest(const Graph& graph, std::vector<CutSide>& side) {
  const int n = graph.nodes();
  side.assign(n, CutSide::kB);
  weigh(graph, side);
  double best = -1.0;
  for (int k = 0; k < std::min(kStarts, n); ++k) {
    grow(graph, static_cast<int>(static_cast<std::int64_t>(k) * n / kStarts), trial_);
    improve(graph, trial_);
    const bool cuts = weight(CutSide::kA) > 0 && weight(CutSide::kB) > 0;
    if (const double now = cost() + (cuts ? 0.0 : total_); best < 0.0 || now < best) {
      best = now;
      side = trial_;
    }
  }
}

/// Moves one node out of the separator; its neighbours on the other side take its place. Of all
/// moves the one that leaves the separator lightest, lighter than now or not.
bool VertexSeparator::move_best(const Graph& graph, std::vector<CutSide>& side) {
  int best_gain = 0;
  int best_imbalance = 0;
  int best_position = -1;
  CutSide best_side = CutSide::kA;
  for (int k = 0; k < static_cast<int>(separator_.size()); ++k) {
    const int node = separator_[k];
    if (locked_[node] != 0) {
      continue;
    }
    int pulled[2] = {0, 0};  // weight next to it on the sides A and B
    for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      const int next = graph.neighbours[e];
      if (side[next] != CutSide::kSeparator) {
        pulled[static_cast<int>(side[next])] += graph.weight[next];
      }
    }
    for (const CutSide to : {CutSide::kA, CutSide::kB}) {
      const int taken = pulled[static_cast<int>(opposite(to))];
      const int gain = graph.weight[node] - taken;
      const int grown = weight(to) + graph.weight[node];
      const int shrunk = weight(opposite(to)) - taken;
      const int imbalance = std::abs(grown - shrunk);
      const bool balanced = std::max(grown, shrunk) <= kMostOfOneSide * total_;
      const bool balances = imbalance < std::abs(weight_[0] - weight_[1]);
      if (shrunk <= 0 || (!balanced && !balances)) {
        continue;
      }
      if (best_position < 0 || gain > best_gain ||
          (gain == best_gain && imbalance < best_imbalance)) {
        best_gain = gain;
        best_imbalance = imbalance;
        best_position = k;
        best_side = to;
      }
    }
  }
  if (best_position < 0) {
    return false;
  }
  const int node = separator_[best_position];
  separator_[best_position] = separator_.back();
  separator_.pop_back();
  undo_.push_back({node, CutSide::kSeparator});
  side[node] = best_side;
  locked_[node] = 1;
  weight(CutSide::kSeparator) -= graph.weight[node];
  weight(best_side) += graph.weight[node];
  for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
    const int next = graph.neighbours[e];
    if (side[next] == opposite(best_side)) {
      undo_.push_back({next, side[next]});
      weight(side[next]) -= graph.weight[next];
      weight(CutSide::kSeparator) += graph.weight[next];
      side[next] = CutSide::kSeparator;
      separator_.push_back(next);
    }
  }
  return true;
}

/// Passes of moves, each undone back to its best moment.
void VertexSeparator::improve(const Graph& graph, std::vector<CutSide>& side) {
  weigh(graph, side);
  locked_.assign(graph.nodes(), 0);
  for (int pass = 0; pass < kPasses; ++pass) {
    separator_.clear();
    for (int node = 0; node < graph.nodes(); ++node) {
      locked_[node] = 0;
      if (side[node] == CutSide::kSeparator) {
        separator_.push_back(node);
      }
    }
    undo_.clear();
    const double before = cost();
    double best = before;
    std::size_t best_length = 0;
    const int patience = 15 + static_cast<int>(separator_.size()) / 5;
    for (int since = 0; since < patience && move_best(graph, side); ++since) {
      if (const double now = cost(); now < best) {
        best = now;
        best_length = undo_.size();
        since = 0;
      }
    }
    while (undo_.size() > best_length) {
      const auto [node, was] = undo_.back();
      undo_.pop_back();
      weight(side[node]) -= graph.weight[node];
      side[node] = was;
      weight(was) += graph.weight[node];
    }
    if (!(best < before)) {
      return;
    }
  }
}

}  // namespace signorini::lcp
