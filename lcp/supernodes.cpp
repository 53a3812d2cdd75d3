#include <signorini/lcp/supernodes.h>

#include <algorithm>
#include <numeric>

namespace signorini::lcp {

void Supernodes::analyse(const Graph& graph, const std::vector<int>& input_order) {
  const int n = graph.nodes();
  input_order_ = input_order;
  position_.resize(n);
  for (int k = 0; k < n; ++k) {
    position_[input_order_[k]] = k;
  }
  find_tree(graph);
  find_structures(graph);
  find_postorder();
  cut(graph);
  write_rows();
}

/// Liu's algorithm: walk up from every earlier neighbour, with paths compressed.
void Supernodes::find_tree(const Graph& graph) {
  const int n = graph.nodes();
  tree_parent_.assign(n, -1);
  ancestor_.assign(n, -1);
  for (int j = 0; j < n; ++j) {
    const int node = input_order_[j];
    for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      int i = position_[graph.neighbours[e]];
      while (i < j && i >= 0) {
        const int next = ancestor_[i];
        ancestor_[i] = j;
        if (next < 0) {
          tree_parent_[i] = j;
          break;
        }
        i = next == j ? n : next;
      }
    }
  }
}

/// The structure of a column: its own later neighbours and its children's structures.
void Supernodes::find_structures(const Graph& graph) {
  const int n = graph.nodes();
  child_.assign(n, -1);
  sibling_.assign(n, -1);
  for (int j = n - 1; j >= 0; --j) {
    if (tree_parent_[j] >= 0) {
      sibling_[j] = child_[tree_parent_[j]];
      child_[tree_parent_[j]] = j;
    }
  }
  size_.resize(n);
  below_.assign(n, 0);
  mark_.assign(n, -1);
  structure_start_.assign(1, 0);
  structure_.clear();
  for (int j = 0; j < n; ++j) {
    const int node = input_order_[j];
    size_[j] = graph.weight[node];
    mark_[j] = j;
    const auto add = [&](int i) {
      if (i > j && mark_[i] != j) {
        mark_[i] = j;
        structure_.push_back(i);
        below_[j] += graph.weight[input_order_[i]];
      }
    };
    for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      add(position_[graph.neighbours[e]]);
    }
    for (int c = child_[j]; c >= 0; c = sibling_[c]) {
      for (int k = structure_start_[c]; k < structure_start_[c + 1]; ++k) {
        add(structure_[k]);
      }
    }
    structure_start_.push_back(static_cast<int>(structure_.size()));
  }
}

/// Children before parents, the child with the most rows last, next to its parent.
void Supernodes::find_postorder() {
  const int n = static_cast<int>(size_.size());
  by_size_.resize(n);
  std::iota(by_size_.begin(), by_size_.end(), 0);
  std::sort(by_size_.begin(), by_size_.end(), [this](int a, int b) {
    return below_[a] != below_[b] ? below_[a] > below_[b] : a < b;
  });
  // Lists of children, smallest first: pushed to the front from the largest on.
  child_.assign(n, -1);
  for (const int j : by_size_) {
    if (tree_parent_[j] >= 0) {
      sibling_[j] = child_[tree_parent_[j]];
      child_[tree_parent_[j]] = j;
    }
  }
  post_.clear();
  stack_.clear();
  for (int root = 0; root < n; ++root) {
    if (tree_parent_[root] >= 0) {
      continue;
    }
    stack_.push_back(root);
    while (!stack_.empty()) {
      const int j = stack_.back();
      if (const int c = child_[j]; c >= 0) {
        child_[j] = sibling_[c];
        stack_.push_back(c);
      } else {
        post_.push_back(j);
        stack_.pop_back();
      }
    }
  }
  post_position_.resize(n);
  for (int k = 0; k < n; ++k) {
    post_position_[post_[k]] = k;
  }
}

namespace {

/// Whether a panel of so many columns may carry this share of zeros. Zeros cost flops and memory;
/// a panel of its own costs a pass over its rows.
bool worth_joining(double columns, double zeros, double entries) {
  const double share = zeros / entries;
  return columns <= 8.0 || (columns <= 16.0 && share < 0.6) || (columns <= 48.0 && share < 0.15) ||
         share < 0.05;
}

double triangle(double n) {
  return 0.5 * n * (n + 1.0);
}

}  // namespace

/// Supernodes from the leaves on: each pivot starts one, which then swallows the supernode in front
/// of it as long as that is its child and few zeros come of it.
void Supernodes::cut(const Graph& graph) {
  const int n = graph.nodes();
  cut_.clear();  // first pivots, in postorder
  joined_columns_.clear();
  joined_below_.clear();
  joined_zeros_.clear();
  for (int k = 0; k < n; ++k) {
    const int j = post_[k];
    int first = k;
    int columns = size_[j];
    const int below = below_[j];
    double zeros = 0.0;
    while (!cut_.empty() && tree_parent_[post_[first - 1]] >= 0 &&
           post_position_[tree_parent_[post_[first - 1]]] <= k &&
           post_position_[tree_parent_[post_[first - 1]]] >= first) {
      const double child_columns = joined_columns_.back();
      const double added = child_columns * (columns + below - joined_below_.back());
      const double all_zeros = zeros + joined_zeros_.back() + added;
      const double all_columns = columns + child_columns;
      if (added > 0.0 &&
          !worth_joining(all_columns, all_zeros, triangle(all_columns) + all_columns * below)) {
        break;
      }
      zeros = all_zeros;
      columns += joined_columns_.back();
      first = cut_.back();
      cut_.pop_back();
      joined_columns_.pop_back();
      joined_below_.pop_back();
      joined_zeros_.pop_back();
    }
    cut_.push_back(first);
    joined_columns_.push_back(columns);
    joined_below_.push_back(below);
    joined_zeros_.push_back(zeros);
  }
}

double Supernodes::flops(const Graph& graph) const {
  double sum = 0.0;
  for (int s = 0; s < count(); ++s) {
    double length = 0.0;
    for (int k = row_start[s]; k < row_start[s + 1]; ++k) {
      length += graph.weight[order[rows[k]]];
    }
    for (int k = first_pivot[s + 1] - 1; k >= first_pivot[s]; --k) {
      for (int i = 0; i < graph.weight[order[k]]; ++i) {
        length += 1.0;
        sum += length * length;
      }
    }
  }
  return sum;
}

void Supernodes::write_rows() {
  const int n = static_cast<int>(post_.size());
  order.resize(n);
  for (int k = 0; k < n; ++k) {
    order[k] = input_order_[post_[k]];
  }
  first_pivot = cut_;
  first_pivot.push_back(n);
  parent.assign(cut_.size(), -1);
  row_start.assign(1, 0);
  rows.clear();
  mark_.resize(n);  // the supernode of a pivot
  for (int s = 0; s < count(); ++s) {
    std::fill(mark_.begin() + first_pivot[s], mark_.begin() + first_pivot[s + 1], s);
  }
  for (int s = 0; s < count(); ++s) {
    const int last = post_[first_pivot[s + 1] - 1];
    for (int k = structure_start_[last]; k < structure_start_[last + 1]; ++k) {
      rows.push_back(post_position_[structure_[k]]);
    }
    std::sort(rows.begin() + row_start[s], rows.end());
    row_start.push_back(static_cast<int>(rows.size()));
    if (row_start[s + 1] > row_start[s]) {
      parent[s] = mark_[rows[row_start[s]]];
    }
  }
}

}  // namespace signorini::lcp
