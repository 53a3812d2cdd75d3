#include <signorini/collision/broad_phase.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace signorini::collision {
namespace {

/// Beyond this float has no numbers; larger ends meet as if they were here, and the doubles decide.
constexpr double kLargest = 3e38;
constexpr float kRelative = 0x1p-23F;  // twice the rounding of a float
constexpr float kSmallest = std::numeric_limits<float>::min();

/// A float <= x, >= x.
float below(double x) {
  const auto f = static_cast<float>(std::clamp(x, -kLargest, kLargest));
  return f - std::abs(f) * kRelative - kSmallest;
}
float above(double x) {
  return -below(-x);
}

/// Unsigned numbers in the order of the floats.
std::uint32_t sort_key(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return bits ^ ((bits >> 31) != 0 ? 0xffffffffU : 0x80000000U);
}

/// Least significant digits first, 11 bits each.
void radix_sort(std::vector<std::pair<std::uint32_t, std::uint32_t>>& keys,
                std::vector<std::pair<std::uint32_t, std::uint32_t>>& scratch) {
  constexpr int kBits = 11;
  constexpr std::uint32_t kMask = (1U << kBits) - 1;
  constexpr std::size_t kWorthwhile = 512;
  if (keys.size() < kWorthwhile) {
    std::sort(keys.begin(), keys.end());
    return;
  }
  scratch.resize(keys.size());
  for (int shift = 0; shift < 32; shift += kBits) {
    std::array<std::uint32_t, 1U << kBits> begin{};
    for (const auto& key : keys) {
      ++begin[(key.first >> shift) & kMask];
    }
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0U);
    for (const auto& key : keys) {
      scratch[begin[(key.first >> shift) & kMask]++] = key;
    }
    keys.swap(scratch);
  }
}

/// Sums over the bounds that are finite.
struct Spread {
  double count = 0.0;
  Vec3 centres = Vec3::Zero();
  Vec3 squares = Vec3::Zero();
  Vec3 extents = Vec3::Zero();
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  explicit Spread(const std::vector<Bounds>& bounds) {
    for (const Bounds& b : bounds) {
      const Vec3 extent = b.high - b.low;
      if (!extent.allFinite()) {
        continue;
      }
      const Vec3 centre = b.low + 0.5 * extent;
      count += 1.0;
      centres += centre;
      squares += centre.cwiseAbs2();
      extents += extent;
      low = low.cwiseMin(b.low);
      high = high.cwiseMax(b.high);
    }
  }
};

}  // namespace

std::uint16_t BroadPhase::Grid::column(int axis, float x) const {
  const float at = (x - low[axis]) * columns_a_metre[axis];
  const auto last = static_cast<float>(columns[axis] - 1);
  return static_cast<std::uint16_t>(at > 0.0F ? std::min(at, last) : 0.0F);
}

void BroadPhase::choose_grid(const std::vector<Bounds>& bounds) {
  grid_ = Grid{};
  const Spread spread(bounds);
  if (spread.count == 0.0) {
    return;
  }
  constexpr double kExtentsAColumn = 2.0;
  const Vec3 variance = spread.squares - spread.centres.cwiseAbs2() / spread.count;
  int s = 0;
  variance.maxCoeff(&s);
  grid_.axes = {s, (s + 1) % 3, (s + 2) % 3};
  grid_.centre = 0.5 * spread.low + 0.5 * spread.high;
  // At most a column for four bounds, so that a few large bounds among small ones stay cheap.
  const double most = std::clamp(std::sqrt(spread.count / 4.0), 1.0, double{kMaxColumns});
  for (int k = 0; k < 2; ++k) {
    const int axis = grid_.axes[k + 1];
    const double width = spread.high[axis] - spread.low[axis];
    const double mean = spread.extents[axis] / spread.count;
    const double columns = std::floor(std::min(most, width / (kExtentsAColumn * mean)));
    if (columns >= 2.0) {  // false for NaN
      grid_.columns[k] = static_cast<std::uint16_t>(columns);
      grid_.low[k] = below(spread.low[axis] - grid_.centre[axis]);
      grid_.columns_a_metre[k] = static_cast<float>(columns / width);
    }
  }
}

void BroadPhase::sort_entries(const std::vector<Bounds>& bounds) {
  const int s = grid_.axes[0];
  keys_.clear();
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    keys_.emplace_back(sort_key(below(bounds[i].low[s] - grid_.centre[s])),
                       static_cast<std::uint32_t>(i));
  }
  radix_sort(keys_, other_keys_);

  const Vec3 centre(grid_.centre[s], grid_.centre[grid_.axes[1]], grid_.centre[grid_.axes[2]]);
  entries_.clear();
  for (const auto& [key, index] : keys_) {
    const Bounds& b = bounds[index];
    Entry entry;
    entry.s_low = below(b.low[s] - centre[0]);
    entry.s_high = above(b.high[s] - centre[0]);
    entry.u_low = below(b.low[grid_.axes[1]] - centre[1]);
    entry.u_high = above(b.high[grid_.axes[1]] - centre[1]);
    entry.v_low = below(b.low[grid_.axes[2]] - centre[2]);
    entry.v_high = above(b.high[grid_.axes[2]] - centre[2]);
    entry.index = static_cast<std::int32_t>(index);
    entry.column_u = grid_.column(0, entry.u_low);
    entry.column_v = grid_.column(1, entry.v_low);
    entries_.push_back(entry);
  }
}

void BroadPhase::fill_columns() {
  const std::uint32_t across = grid_.columns[1];
  const auto for_each_column = [&](const Entry& entry, auto&& visit) {
    const std::uint32_t last_u = grid_.column(0, entry.u_high);
    const std::uint32_t last_v = grid_.column(1, entry.v_high);
    for (std::uint32_t u = entry.column_u; u <= last_u; ++u) {
      for (std::uint32_t v = entry.column_v; v <= last_v; ++v) {
        visit(u * across + v);
      }
    }
  };
  column_begin_.assign(grid_.columns[0] * across + 2, 0);
  for (const Entry& entry : entries_) {
    for_each_column(entry, [&](std::uint32_t column) { ++column_begin_[column + 2]; });
  }
  std::partial_sum(column_begin_.begin(), column_begin_.end(), column_begin_.begin());
  columns_.resize(column_begin_.back());
  // begin[c + 1] runs from the begin of column c to its end, and so becomes what begin[c + 1] is.
  for (const Entry& entry : entries_) {
    for_each_column(entry,
                    [&](std::uint32_t column) { columns_[column_begin_[column + 1]++] = entry; });
  }
}

void BroadPhase::sweep_column(std::size_t begin, std::size_t end, const std::vector<Bounds>& bounds,
                              const std::vector<std::uint8_t>& fixed, std::uint32_t column) {
  const std::uint32_t across = grid_.columns[1];
  for (std::size_t i = begin; i < end; ++i) {
    const Entry& a = columns_[i];
    for (std::size_t j = i + 1; j < end && columns_[j].s_low <= a.s_high; ++j) {
      const Entry& b = columns_[j];
      const bool near = (a.u_low <= b.u_high) & (b.u_low <= a.u_high) & (a.v_low <= b.v_high) &
                        (b.v_low <= a.v_high);
      if (!near) {
        continue;
      }
      const std::uint32_t home =
          std::max(a.column_u, b.column_u) * across + std::max(a.column_v, b.column_v);
      const bool both_fixed = !fixed.empty() && fixed[a.index] != 0 && fixed[b.index] != 0;
      if (home == column && !both_fixed && bounds[a.index].overlaps(bounds[b.index])) {
        found_.emplace_back(std::min(a.index, b.index), std::max(a.index, b.index));
      }
    }
  }
}

/// Counting sort by the second number, then by the first.
void BroadPhase::write_sorted(std::size_t bound_count, std::vector<std::pair<int, int>>& pairs) {
  const auto sort_by = [&](auto number, const auto& from, auto& to) {
    counts_.assign(bound_count + 1, 0);
    for (const auto& pair : from) {
      ++counts_[number(pair) + 1];
    }
    std::partial_sum(counts_.begin(), counts_.end(), counts_.begin());
    to.resize(from.size());
    for (const auto& pair : from) {
      to[counts_[number(pair)]++] = pair;
    }
  };
  sort_by([](const auto& pair) { return pair.second; }, found_, by_second_);
  sort_by([](const auto& pair) { return pair.first; }, by_second_, pairs);
}

void BroadPhase::find(const std::vector<Bounds>& bounds, const std::vector<std::uint8_t>& fixed,
                      std::vector<std::pair<int, int>>& pairs) {
  choose_grid(bounds);
  sort_entries(bounds);
  fill_columns();
  found_.clear();
  for (std::uint32_t c = 0; c + 2 < column_begin_.size(); ++c) {
    sweep_column(column_begin_[c], column_begin_[c + 1], bounds, fixed, c);
  }
  write_sorted(bounds.size(), pairs);
}

}  // namespace signorini::collision
