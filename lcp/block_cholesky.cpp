#include <signorini/lcp/block_cholesky.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
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

/// A number of 64 bits from one, without pattern (splitmix64).
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

BlockCholesky::BlockCholesky(const DenseKernels& kernels) : kernels_(kernels) {}

bool BlockCholesky::same_pattern(const SparseMatrix& lower) const {
  const std::size_t columns = static_cast<std::size_t>(lower.cols()) + 1;
  const std::size_t entries = static_cast<std::size_t>(lower.nonZeros());
  return pattern_outer_.size() == columns && pattern_inner_.size() == entries &&
         std::equal(pattern_outer_.begin(), pattern_outer_.end(), lower.outerIndexPtr()) &&
         std::equal(pattern_inner_.begin(), pattern_inner_.end(), lower.innerIndexPtr());
}

void BlockCholesky::analyse(const SparseMatrix& lower) {
  if (same_pattern(lower)) {
    return;
  }
  pattern_outer_.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + lower.cols() + 1);
  pattern_inner_.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros());
  find_blocks(lower);
  find_graph(lower);
  supernodes_ = &least_fill_.find(graph_);
  lay_out_fronts();
  lay_out_stack();
  find_scatter(lower);
  find_runs();
}

/// Cuts the columns into blocks: column j + 1 continues the block of j if both have the same rows
/// below, j + 1 included in j's, and the same columns to the left (compared by a hash: a mistake
/// would make a block with zeros in it, and nothing wrong).
void BlockCholesky::find_blocks(const SparseMatrix& lower) {
  const int n = static_cast<int>(lower.cols());
  const int* outer = lower.outerIndexPtr();
  const int* inner = lower.innerIndexPtr();
  block_start_.clear();
  for (int j = 0; j < n; ++j) {
    const int before = j > 0 ? outer[j] - outer[j - 1] : 0;
    const int rows = outer[j + 1] - outer[j];
    if (j == 0 || before != rows + 1 ||
        !std::equal(inner + outer[j], inner + outer[j + 1], inner + outer[j - 1] + 1)) {
      block_start_.push_back(j);
    }
  }
  block_start_.push_back(n);
  const int candidates = static_cast<int>(block_start_.size()) - 1;
  std::vector<std::uint64_t> left(n, 0);
  for (int b = 0; b < candidates; ++b) {
    for (int j = block_start_[b]; j < block_start_[b + 1]; ++j) {
      for (int k = outer[j]; k < outer[j + 1]; ++k) {
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
void BlockCholesky::find_graph(const SparseMatrix& lower) {
  const int blocks = static_cast<int>(block_start_.size()) - 1;
  const int* outer = lower.outerIndexPtr();
  const int* inner = lower.innerIndexPtr();
  graph_.weight.resize(blocks);
  graph_.start.assign(blocks + 1, 0);
  // Twice over the pattern: counting degrees, then filling, each edge from both ends.
  for (const bool fill : {false, true}) {
    mark_.assign(blocks, -1);
    for (int b = 0; b < blocks; ++b) {
      graph_.weight[b] = block_start_[b + 1] - block_start_[b];
      for (int j = block_start_[b]; j < block_start_[b + 1]; ++j) {
        for (int k = outer[j]; k < outer[j + 1]; ++k) {
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
void BlockCholesky::lay_out_fronts() {
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
  counts_ = {};
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
    front.ld_update = leading_dimension(below);
    front.panel = panel;
    panel += static_cast<std::ptrdiff_t>(front.ld) * front.columns;
    front.parent = supernodes_->parent[s];
    front.child = -1;
    front.sibling = -1;
    most_below = std::max(most_below, below);
    for (int c = 0; c < front.columns; ++c) {
      const double length = front.rows - c;
      counts_.entries += length;
      counts_.flops += length * length;
    }
  }
  for (int s = count - 1; s >= 0; --s) {
    if (const int parent = fronts_[s].parent; parent >= 0) {
      fronts_[s].sibling = fronts_[parent].child;
      fronts_[parent].child = s;
    }
  }
  panels_.resize(panel + kPadding);
  work_.resize(block_of_.size() + kPadding);
  inverse_.resize(block_of_.size());
  below_.resize(most_below + kPadding);
}

/// Where each front's update stands: on top of its children's while it is made, then moved down to
/// where the first of them stood.
void BlockCholesky::lay_out_stack() {
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
  stack_.resize(highest + kPadding);
}

/// Which number of H goes where in which panel.
void BlockCholesky::find_scatter(const SparseMatrix& lower) {
  const int n = static_cast<int>(lower.cols());
  const int count = supernodes_->count();
  const int* outer = lower.outerIndexPtr();
  const int* inner = lower.innerIndexPtr();
  mark_.resize(n);  // the front of a column, in the order of elimination
  for (int s = 0; s < count; ++s) {
    std::fill_n(mark_.begin() + fronts_[s].first, fronts_[s].columns, s);
  }
  bucket_.assign(count + 1, 0);
  for (int j = 0; j < n; ++j) {
    for (int k = outer[j]; k < outer[j + 1]; ++k) {
      ++bucket_[mark_[std::min(scalar_[j], scalar_[inner[k]])] + 1];
    }
  }
  std::partial_sum(bucket_.begin(), bucket_.end(), bucket_.begin());
  for (int s = 0; s <= count; ++s) {
    fronts_[s].scatter = bucket_[s];
  }
  scatter_.resize(lower.nonZeros());
  place_.resize(lower.nonZeros());  // first: the row in the order of elimination
  for (int j = 0; j < n; ++j) {
    for (int k = outer[j]; k < outer[j + 1]; ++k) {
      const int one = scalar_[j];
      const int other = scalar_[inner[k]];
      const int to = bucket_[mark_[std::min(one, other)]]++;
      scatter_[to] = {k, std::min(one, other)};
      place_[to] = std::max(one, other);
    }
  }
  bucket_.resize(n);  // from here on: the row of the front at hand
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
    for (int k = front.scatter; k < fronts_[s + 1].scatter; ++k) {
      scatter_[k].target = (scatter_[k].target - front.first) * front.ld + bucket_[place_[k]];
    }
  }
}

/// Where the rows below each front's columns are, among all columns and among its parent's rows.
void BlockCholesky::find_runs() {
  const int count = supernodes_->count();
  global_runs_.clear();
  parent_runs_.clear();
  place_.resize(block_of_.size());  // the parent's row of a column
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
void BlockCholesky::add_update(const Front& child, const Front& front, double* panel,
                               double* update) {
  const double* from = stack_.data() + child.moved_update;
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

bool BlockCholesky::factor_front(int s, const double* values) {
  const Front& front = fronts_[s];
  const int below = front.rows - front.columns;
  double* panel = panels_.data() + front.panel;
  double* update = stack_.data() + front.update;
  const std::size_t update_size = static_cast<std::size_t>(front.ld_update) * below;
  std::fill_n(panel, static_cast<std::ptrdiff_t>(front.ld) * front.columns, 0.0);
  std::fill_n(update, update_size, 0.0);
  for (int k = front.scatter; k < fronts_[s + 1].scatter; ++k) {
    panel[scatter_[k].target] = values[scatter_[k].source];
  }
  for (int child = front.child; child >= 0; child = fronts_[child].sibling) {
    add_update(fronts_[child], front, panel, update);
  }
  if (!kernels_.factor(panel, front.ld, front.rows, front.columns)) {
    return false;
  }
  kernels_.subtract_product(update, front.ld_update, panel + front.columns, front.ld, below,
                            front.columns);
  for (int c = 0; c < front.columns; ++c) {
    inverse_[front.first + c] = 1.0 / panel[static_cast<std::ptrdiff_t>(c) * front.ld + c];
  }
  if (front.moved_update != front.update && below > 0) {
    std::memmove(stack_.data() + front.moved_update, update, update_size * sizeof(double));
  }
  return true;
}

bool BlockCholesky::factor(const SparseMatrix& lower) {
  for (int s = 0; s < supernodes_->count(); ++s) {
    if (!factor_front(s, lower.valuePtr())) {
      return false;
    }
  }
  return true;
}

void BlockCholesky::solve(Vector& x) {
  for (Index i = 0; i < x.size(); ++i) {
    work_[scalar_[i]] = x[i];
  }
  const int count = supernodes_->count();
  for (int s = 0; s < count; ++s) {
    const Front& front = fronts_[s];
    for (int k = front.global_run; k < fronts_[s + 1].global_run; ++k) {
      const Run& run = global_runs_[k];
      std::copy_n(work_.data() + run.to, run.length, below_.data() + run.from);
    }
    kernels_.forward(panels_.data() + front.panel, front.ld, front.rows, front.columns,
                     inverse_.data() + front.first, work_.data() + front.first, below_.data());
    for (int k = front.global_run; k < fronts_[s + 1].global_run; ++k) {
      const Run& run = global_runs_[k];
      std::copy_n(below_.data() + run.from, run.length, work_.data() + run.to);
    }
  }
  for (int s = count - 1; s >= 0; --s) {
    const Front& front = fronts_[s];
    for (int k = front.global_run; k < fronts_[s + 1].global_run; ++k) {
      const Run& run = global_runs_[k];
      std::copy_n(work_.data() + run.to, run.length, below_.data() + run.from);
    }
    kernels_.backward(panels_.data() + front.panel, front.ld, front.rows, front.columns,
                      inverse_.data() + front.first, work_.data() + front.first, below_.data());
  }
  for (Index i = 0; i < x.size(); ++i) {
    x[i] = work_[scalar_[i]];
  }
}

SparseCholeskyCounts BlockCholesky::counts() const {
  SparseCholeskyCounts counts = counts_;
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  counts.bytes = bytes(panels_) + bytes(stack_) + bytes(work_) + bytes(inverse_) + bytes(below_) +
                 bytes(scatter_) + bytes(fronts_) + bytes(global_runs_) + bytes(parent_runs_) +
                 bytes(pattern_inner_) + bytes(pattern_outer_);
  return counts;
}

}  // namespace signorini::lcp
