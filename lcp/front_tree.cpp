#include <signorini/lcp/front_tree.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <numeric>

namespace signorini::lcp {
namespace {

constexpr int kPadding = DenseKernels::kPadding;

/// A leading dimension for so many rows: padded, and not a multiple of what maps columns onto the
/// same lines of a cache.
int leading_dimension(int rows) {
  const int padded = (rows + kPadding - 1) / kPadding * kPadding;
  return padded % 64 == 0 ? padded + kPadding : padded;
}

/// Calls visit(first, count) for the numbers of the columns that are on or below the diagonal, from
/// a multiple of kPadding on: all at once where that is little. What else the kernels read reaches
/// scratch alone.
template <typename Visit>
void visit_trapezoid(int rows, int columns, int ld, const Visit& visit) {
  constexpr int kFew = 64;
  if (columns <= kFew) {
    visit(0, static_cast<std::ptrdiff_t>(ld) * columns);
    return;
  }
  for (int c = 0; c < columns; ++c) {
    const int first = c / kPadding * kPadding;
    visit(static_cast<std::ptrdiff_t>(c) * ld + first, std::min(rows + kPadding, ld) - first);
  }
}

/// A number of 64 bits from one, without pattern (splitmix64).
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

bool FrontTree::knows(const SparsePattern& pattern) const {
  return pattern_outer_.size() == static_cast<std::size_t>(pattern.columns) + 1 &&
         pattern_inner_.size() == static_cast<std::size_t>(pattern.entries()) &&
         std::equal(pattern_outer_.begin(), pattern_outer_.end(), pattern.outer) &&
         std::equal(pattern_inner_.begin(), pattern_inner_.end(), pattern.inner);
}

void FrontTree::keep(const SparsePattern& pattern) {
  pattern_inner_.assign(pattern.inner, pattern.inner + pattern.entries());
  pattern_outer_.assign(pattern.outer, pattern.outer + pattern.columns + 1);
}

void FrontTree::analyse(const SparsePattern& pattern) {
  pattern_outer_.clear();
  lower_start_.resize(pattern.columns);
  for (int j = 0; j < pattern.columns; ++j) {
    const int* end = pattern.inner + pattern.outer[j + 1];
    const int* first = std::lower_bound(pattern.inner + pattern.outer[j], end, j);
    lower_start_[j] = static_cast<int>(first - pattern.inner);
  }
  find_blocks(pattern);
  find_graph(pattern);
  supernodes_ = &least_fill_.find(graph_);
  lay_out_fronts();
  lay_out_stack();
  find_runs();
}

/// Cuts the columns into blocks: column j + 1 continues the block of j if both have the same rows
/// below, j + 1 included in j's, and the same columns to the left (compared by a hash: a mistake
/// would make a block with zeros in it, and nothing wrong).
void FrontTree::find_blocks(const SparsePattern& pattern) {
  const int n = pattern.columns;
  const int* outer = pattern.outer;
  const int* inner = pattern.inner;
  const std::vector<int>& lower = lower_start_;
  block_start_.clear();
  for (int j = 0; j < n; ++j) {
    const int before = j > 0 ? outer[j] - lower[j - 1] : 0;
    const int rows = outer[j + 1] - lower[j];
    if (j == 0 || before != rows + 1 ||
        !std::equal(inner + lower[j], inner + outer[j + 1], inner + lower[j - 1] + 1)) {
      block_start_.push_back(j);
    }
  }
  block_start_.push_back(n);
  const int candidates = static_cast<int>(block_start_.size()) - 1;
  std::vector<std::uint64_t> left(n, 0);
  for (int b = 0; b < candidates; ++b) {
    for (int j = block_start_[b]; j < block_start_[b + 1]; ++j) {
      for (int k = lower[j]; k < outer[j + 1]; ++k) {
        if (inner[k] >= block_start_[b + 1]) {
          left[inner[k]] += mix(j);
        }
      }
    }
  }
  std::vector<int> starts;
  for (int b = 0; b < candidates; ++b) {
    for (int j = block_start_[b]; j < block_start_[b + 1]; ++j) {
      if (j == block_start_[b] || left[j] != left[j - 1]) {
        starts.push_back(j);
      }
    }
  }
  starts.push_back(n);
  block_start_.swap(starts);
  block_of_.resize(n);
  for (std::size_t b = 0; b + 1 < block_start_.size(); ++b) {
    std::fill(block_of_.begin() + block_start_[b], block_of_.begin() + block_start_[b + 1],
              static_cast<int>(b));
  }
}

/// The graph of the blocks: an edge where any column of one has a row in the other.
void FrontTree::find_graph(const SparsePattern& pattern) {
  const int blocks = static_cast<int>(block_start_.size()) - 1;
  const int* outer = pattern.outer;
  const int* inner = pattern.inner;
  graph_.weight.resize(blocks);
  graph_.start.assign(blocks + 1, 0);
  // Twice over the pattern: counting degrees, then filling, each edge from both ends.
  for (const bool fill : {false, true}) {
    mark_.assign(blocks, -1);
    for (int b = 0; b < blocks; ++b) {
      graph_.weight[b] = block_start_[b + 1] - block_start_[b];
      for (int j = block_start_[b]; j < block_start_[b + 1]; ++j) {
        for (int k = lower_start_[j]; k < outer[j + 1]; ++k) {
          const int other = block_of_[inner[k]];
          if (other == b || mark_[other] == b) {
            continue;
          }
          mark_[other] = b;
          if (fill) {
            graph_.neighbours[bucket_[b]++] = other;
            graph_.neighbours[bucket_[other]++] = b;
          } else {
            ++graph_.start[b + 1];
            ++graph_.start[other + 1];
          }
        }
      }
    }
    if (!fill) {
      std::partial_sum(graph_.start.begin(), graph_.start.end(), graph_.start.begin());
      graph_.neighbours.resize(graph_.start.back());
      bucket_.assign(graph_.start.begin(), graph_.start.end() - 1);
    }
  }
  for (int b = 0; b < blocks; ++b) {
    std::sort(graph_.neighbours.begin() + graph_.start[b],
              graph_.neighbours.begin() + graph_.start[b + 1]);
  }
}

/// Sizes and places of the fronts' panels, and the scalar order of elimination.
void FrontTree::lay_out_fronts() {
  const int blocks = graph_.nodes();
  pivot_start_.assign(1, 0);
  scalar_.resize(block_of_.size());
  for (int k = 0; k < blocks; ++k) {
    const int block = supernodes_->order[k];
    for (int i = 0; i < graph_.weight[block]; ++i) {
      scalar_[block_start_[block] + i] = pivot_start_.back() + i;
    }
    pivot_start_.push_back(pivot_start_.back() + graph_.weight[block]);
  }
  const int count = supernodes_->count();
  fronts_.assign(count + 1, {});
  std::ptrdiff_t panel = 0;
  int most_below = 0;
  entries_ = 0.0;
  flops_ = 0.0;
  for (int s = 0; s < count; ++s) {
    Front& front = fronts_[s];
    front.first = pivot_start_[supernodes_->first_pivot[s]];
    front.columns = pivot_start_[supernodes_->first_pivot[s + 1]] - front.first;
    int below = 0;
    for (int k = supernodes_->row_start[s]; k < supernodes_->row_start[s + 1]; ++k) {
      below += graph_.weight[supernodes_->order[supernodes_->rows[k]]];
    }
    front.rows = front.columns + below;
    front.ld = leading_dimension(front.rows);
    if (std::int64_t{front.ld} * front.columns > std::numeric_limits<int>::max()) {
      throw std::bad_alloc();  // 17 GB for one front, which Scatter does not count
    }
    front.ld_update = leading_dimension(below);
    front.panel = panel;
    panel += static_cast<std::ptrdiff_t>(front.ld) * front.columns;
    front.parent = supernodes_->parent[s];
    front.child = -1;
    front.sibling = -1;
    most_below = std::max(most_below, below);
    for (int c = 0; c < front.columns; ++c) {
      const double length = front.rows - c;
      entries_ += length;
      flops_ += length * length;
    }
  }
  for (int s = count - 1; s >= 0; --s) {
    if (const int parent = fronts_[s].parent; parent >= 0) {
      fronts_[s].sibling = fronts_[parent].child;
      fronts_[parent].child = s;
    }
  }
  panels_size_ = static_cast<std::size_t>(panel) + kPadding;
  below_size_ = static_cast<std::size_t>(most_below) + kPadding;
}

/// Where each front's update stands: on top of its children's while it is made, then moved down to
/// where the first of them stood.
void FrontTree::lay_out_stack() {
  std::ptrdiff_t top = 0;
  std::ptrdiff_t highest = 0;
  for (int s = 0; s + 1 < static_cast<int>(fronts_.size()); ++s) {
    Front& front = fronts_[s];
    const std::ptrdiff_t size =
        static_cast<std::ptrdiff_t>(front.ld_update) * (front.rows - front.columns);
    front.update = top;
    front.moved_update = front.child >= 0 ? fronts_[front.child].moved_update : top;
    highest = std::max(highest, front.update + size);
    top = front.moved_update + size;
  }
  stack_size_ = static_cast<std::size_t>(highest) + kPadding;
}

void FrontTree::find_scatter(const SparsePattern& pattern, Triangle triangle, Scatter& scatter) {
  const int count = supernodes_->count();
  mark_.resize(pattern.columns);  // the front of a column, in the order of elimination
  for (int s = 0; s < count; ++s) {
    std::fill_n(mark_.begin() + fronts_[s].first, fronts_[s].columns, s);
  }
  // Calls visit(entry, column, row) in the order of elimination, column <= row.
  const auto visit_triangle = [&](const auto& visit) {
    for (int j = 0; j < pattern.columns; ++j) {
      for (int k = pattern.outer[j]; k < pattern.outer[j + 1]; ++k) {
        const int column = scalar_[j];
        const int row = scalar_[pattern.inner[k]];
        const Triangle its = row >= column || !pattern.whole ? Triangle::kLower : Triangle::kUpper;
        if (its == triangle) {
          visit(k, std::min(column, row), std::max(column, row));
        }
      }
    }
  };
  scatter.start.assign(count + 1, 0);
  visit_triangle([&](int, int column, int) { ++scatter.start[mark_[column] + 1]; });
  std::partial_sum(scatter.start.begin(), scatter.start.end(), scatter.start.begin());
  scatter.entries.resize(scatter.start.back());
  place_.resize(scatter.start.back());  // the row
  bucket_.assign(scatter.start.begin(), scatter.start.end());
  visit_triangle([&](int entry, int column, int row) {
    const int to = bucket_[mark_[column]]++;
    scatter.entries[to] = {entry, column};
    place_[to] = row;
  });
  bucket_.resize(pattern.columns);  // from here on: the row of the front at hand
  for (int s = 0; s < count; ++s) {
    const Front& front = fronts_[s];
    std::iota(bucket_.begin() + front.first, bucket_.begin() + front.first + front.columns, 0);
    int row = front.columns;
    for (int k = supernodes_->row_start[s]; k < supernodes_->row_start[s + 1]; ++k) {
      const int pivot = supernodes_->rows[k];
      for (int i = pivot_start_[pivot]; i < pivot_start_[pivot + 1]; ++i) {
        bucket_[i] = row++;
      }
    }
    for (int k = scatter.start[s]; k < scatter.start[s + 1]; ++k) {
      int& target = scatter.entries[k].target;
      target = (target - front.first) * front.ld + bucket_[place_[k]];
    }
  }
}

/// Where the rows below each front's columns are, among all columns and among its parent's rows.
void FrontTree::find_runs() {
  const int count = supernodes_->count();
  global_runs_.clear();
  parent_runs_.clear();
  for (int s = 0; s < count; ++s) {
    Front& front = fronts_[s];
    front.global_run = static_cast<int>(global_runs_.size());
    int row = 0;
    for (int k = supernodes_->row_start[s]; k < supernodes_->row_start[s + 1]; ++k) {
      const int pivot = supernodes_->rows[k];
      const int length = pivot_start_[pivot + 1] - pivot_start_[pivot];
      const int to = pivot_start_[pivot];
      if (static_cast<int>(global_runs_.size()) > front.global_run &&
          global_runs_.back().to + global_runs_.back().length == to) {
        global_runs_.back().length += length;
      } else {
        global_runs_.push_back({row, length, to});
      }
      row += length;
    }
  }
  fronts_[count].global_run = static_cast<int>(global_runs_.size());
  for (int s = 0; s < count; ++s) {
    Front& front = fronts_[s];
    front.parent_run = static_cast<int>(parent_runs_.size());
    if (front.parent < 0) {
      continue;
    }
    const Front& parent = fronts_[front.parent];
    // Both lists of rows increase: one pass over the two.
    int run = parent.global_run;
    const auto row_of_parent = [&](int column) {
      if (column < parent.first + parent.columns) {
        return column - parent.first;
      }
      while (global_runs_[run].to + global_runs_[run].length <= column) {
        ++run;
      }
      return parent.columns + global_runs_[run].from + column - global_runs_[run].to;
    };
    for (int k = front.global_run; k < fronts_[s + 1].global_run; ++k) {
      const Run& mine = global_runs_[k];
      for (int i = 0; i < mine.length; ++i) {
        const int to = row_of_parent(mine.to + i);
        if (static_cast<int>(parent_runs_.size()) > front.parent_run &&
            parent_runs_.back().to + parent_runs_.back().length == to) {
          ++parent_runs_.back().length;
        } else {
          parent_runs_.push_back({mine.from + i, 1, to});
        }
      }
    }
  }
  fronts_[count].parent_run = static_cast<int>(parent_runs_.size());
}

/// Adds a child's update to the front: to the panel where the column is factored there, else to the
/// front's own update.
void FrontTree::add_update(const Front& child, const Front& front, const double* from,
                           double* panel, double* update) const {
  const Run* runs = parent_runs_.data() + child.parent_run;
  const Run* end = parent_runs_.data() + (&child + 1)->parent_run;
  for (const Run* columns = runs; columns != end; ++columns) {
    for (int c = 0; c < columns->length; ++c) {
      const double* source =
          from + static_cast<std::ptrdiff_t>(columns->from + c) * child.ld_update;
      const int to = columns->to + c;
      // Row 0 of the front's column.
      double* target = to < front.columns
                           ? panel + static_cast<std::ptrdiff_t>(to) * front.ld
                           : update +
                                 static_cast<std::ptrdiff_t>(to - front.columns) * front.ld_update -
                                 front.columns;
      for (int i = c; i < columns->length; ++i) {
        target[columns->to + i] += source[columns->from + i];
      }
      for (const Run* rows = columns + 1; rows != end; ++rows) {
        for (int i = 0; i < rows->length; ++i) {
          target[rows->to + i] += source[rows->from + i];
        }
      }
    }
  }
}

void FrontTree::assemble(int s, const Scatter& scatter, const double* values, double* panels,
                         double* stack) const {
  const Front& front = fronts_[s];
  double* panel = panels + front.panel;
  double* update = stack + front.update;
  visit_trapezoid(
      front.rows, front.columns, front.ld,
      [&](std::ptrdiff_t at, std::ptrdiff_t count) { std::fill_n(panel + at, count, 0.0); });
  visit_trapezoid(
      front.below(), front.below(), front.ld_update,
      [&](std::ptrdiff_t at, std::ptrdiff_t count) { std::fill_n(update + at, count, 0.0); });
  for (int k = scatter.start[s]; k < scatter.start[s + 1]; ++k) {
    panel[scatter.entries[k].target] = values[scatter.entries[k].source];
  }
  for (int child = front.child; child >= 0; child = fronts_[child].sibling) {
    add_update(fronts_[child], front, stack + fronts_[child].moved_update, panel, update);
  }
}

void FrontTree::move_update(int s, double* stack) const {
  const Front& front = fronts_[s];
  if (front.moved_update == front.update) {
    return;
  }
  double* to = stack + front.moved_update;  // below what is moved
  const double* from = stack + front.update;
  visit_trapezoid(front.below(), front.below(), front.ld_update,
                  [&](std::ptrdiff_t at, std::ptrdiff_t count) {
                    std::memmove(to + at, from + at, count * sizeof(double));
                  });
}

void FrontTree::permute(const double* x, double* ordered) const {
  for (std::size_t i = 0; i < scalar_.size(); ++i) {
    ordered[scalar_[i]] = x[i];
  }
}

void FrontTree::permute_back(const double* ordered, double* x) const {
  for (std::size_t i = 0; i < scalar_.size(); ++i) {
    x[i] = ordered[scalar_[i]];
  }
}

void FrontTree::gather_below(int s, const double* ordered, double* below) const {
  for (int k = fronts_[s].global_run; k < fronts_[s + 1].global_run; ++k) {
    const Run& run = global_runs_[k];
    std::copy_n(ordered + run.to, run.length, below + run.from);
  }
}

void FrontTree::scatter_below(int s, const double* below, double* ordered) const {
  for (int k = fronts_[s].global_run; k < fronts_[s + 1].global_run; ++k) {
    const Run& run = global_runs_[k];
    std::copy_n(below + run.from, run.length, ordered + run.to);
  }
}

std::size_t FrontTree::bytes() const {
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  return bytes(fronts_) + bytes(global_runs_) + bytes(parent_runs_) + bytes(pattern_inner_) +
         bytes(pattern_outer_);
}

}  // namespace signorini::lcp
