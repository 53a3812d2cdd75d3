#include <signorini/lcp/row_groups.h>

#include <algorithm>
#include <numeric>

namespace signorini::lcp {

void RowGroups::set(const ScaledRows& scaled, std::span<const SweepRow> rows, RowOrder order) {
  collect(scaled);
  color_starts_.assign(1, 0);
  if (order == RowOrder::kColoured) {
    color(scaled, rows);
    order_by_color();
  }
}

void RowGroups::collect(const ScaledRows& scaled) {
  groups_.clear();
  const auto rows = scaled.rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int row = static_cast<int>(i);
    if (!groups_.empty() && !rows[i].general && !groups_.back().general &&
        groups_.back().form < RowForm::kFour) {
      Group& last = groups_.back();
      const auto& first = rows[last.rows[0]];
      if (first.blocks[0] == rows[i].blocks[0] && first.blocks[1] == rows[i].blocks[1]) {
        last.rows[rows_of(last.form)] = row;
        last.form = static_cast<RowForm>(static_cast<int>(last.form) + 1);
        last.kind = std::max(last.kind, rows[i].kind);
        continue;
      }
    }
    groups_.push_back({{row, -1, -1, -1}, RowForm::kOne, rows[i].kind, rows[i].general});
  }
}

/// A group uses its blocks, and of a coupled row also the normal row.
void RowGroups::color(const ScaledRows& scaled, std::span<const SweepRow> rows) {
  resource_starts_.assign(1, 0);
  resources_.clear();
  const int blocks = scaled.block_count();
  bool is_coupled = false;
  for (const SweepRow& row : rows) {
    is_coupled = is_coupled || row.normal_row >= 0;
  }
  for (const Group& group : groups_) {
    for (const auto& entry : scaled.entries(scaled.rows()[group.rows[0]])) {
      resources_.push_back(entry.block);
    }
    for (int k = 0; is_coupled && k < rows_of(group.form); ++k) {
      const int row = group.rows[k];
      resources_.push_back(blocks + (rows[row].normal_row >= 0 ? rows[row].normal_row : row));
    }
    resource_starts_.push_back(static_cast<int>(resources_.size()));
  }
  coloring_.set(resource_starts_, resources_,
                blocks + (is_coupled ? static_cast<int>(rows.size()) : 0));
}

namespace {

constexpr int kKeys = 32;  // more than any key_of()

/// Groups of one colour are taken in the order of this: same form and kind together, general rows
/// last.
int key_of(const RowGroups::Group& group) {
  return group.general ? kKeys - 1
                       : 4 * static_cast<int>(group.form) + static_cast<int>(group.kind);
}

}  // namespace

/// Colour by colour; groups that may share keep their order.
void RowGroups::order_by_color() {
  const auto colors = coloring_.colors();
  const auto bucket_of = [&](std::size_t k) {
    return colors[k] < RowColoring::kColors ? kKeys * colors[k] + key_of(groups_[k])
                                            : kKeys * RowColoring::kColors;
  };
  bucket_starts_.assign(kKeys * RowColoring::kColors + 2, 0);
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    ++bucket_starts_[bucket_of(k) + 1];
  }
  std::partial_sum(bucket_starts_.begin(), bucket_starts_.end(), bucket_starts_.begin());
  ordered_.resize(groups_.size());
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    ordered_[bucket_starts_[bucket_of(k)]++] = groups_[k];  // now the bucket's end
  }
  groups_.clear();
  int first = 0;
  for (int color = 0; color < coloring_.color_count(); ++color) {
    const int last = bucket_starts_[kKeys * color + kKeys - 1];
    make_packets(first, last);
    color_starts_.push_back(static_cast<int>(groups_.size()));
    first = last;
  }
  groups_.insert(groups_.end(), ordered_.begin() + first, ordered_.end());
}

/// Appends the groups of a colour, single rows four at a time.
void RowGroups::make_packets(int first, int last) {
  const auto is_single = [](const Group& group, RowKind kind) {
    return !group.general && group.form == RowForm::kOne && group.kind == kind &&
           kind != RowKind::kCoupled;
  };
  for (int k = first; k < last; ++k) {
    Group group = ordered_[k];
    if (k + kLanes <= last && is_single(group, group.kind) &&
        is_single(ordered_[k + kLanes - 1], group.kind)) {
      for (int lane = 1; lane < kLanes; ++lane) {
        group.rows[lane] = ordered_[k + lane].rows[0];
      }
      group.form = RowForm::kPacket;
      k += kLanes - 1;
    }
    groups_.push_back(group);
  }
}

}  // namespace signorini::lcp
