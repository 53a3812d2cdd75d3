#pragma once

#include <signorini/collision/bounds.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace signorini::collision {

/// Every pair (i, j), i < j, of bounds that overlap (touching counts), in ascending order.
///
/// Sort and sweep inside the columns of a grid: the bounds are sorted along the axis on which their
/// centres spread most, put into each column of a grid over the other two axes that they reach into
/// (about two mean extents wide), and swept there. A pair is reported in one column only, the one
/// with the larger of the two low ends on both axes. What is sorted, gridded and compared first is
/// in float, rounded outwards; the last word is had by the doubles.
///
/// Nothing is carried from step to step, so the pairs depend on the bounds alone and bodies that
/// jump cost no more than those that creep. Cost: linear in the bounds and the pairs where sizes
/// are alike; at worst (all alike on two axes) a plain sweep. Measured in bench/README.md.
class BroadPhase {
 public:
  /// @param fixed one a bound, or empty: pairs of two that are not 0 are left out
  /// @param pairs are replaced. Allocates nothing once no count exceeds an earlier one.
  void find(const std::vector<Bounds>& bounds, const std::vector<std::uint8_t>& fixed,
            std::vector<std::pair<int, int>>& pairs);

 private:
  /// Bounds along the sweep axis s and the axes u, v of the grid, relative to the centre of all,
  /// rounded outwards.
  struct Entry {
    float s_low, s_high, u_low, u_high, v_low, v_high;
    std::int32_t index;
    std::uint16_t column_u, column_v;  ///< of the low ends
  };
  static constexpr int kMaxColumns = 1 << 12;  ///< on one axis

  struct Grid {
    std::array<int, 3> axes{0, 1, 2};  ///< s, u, v
    Vec3 centre = Vec3::Zero();
    std::array<float, 2> low{0.0F, 0.0F};        ///< of the grid, axes u and v
    std::array<float, 2> columns_a_metre{0, 0};  ///< 1/m
    std::array<std::uint16_t, 2> columns = {1, 1};

    [[nodiscard]] std::uint16_t column(int axis, float x) const;
  };

  void choose_grid(const std::vector<Bounds>& bounds);
  void sort_entries(const std::vector<Bounds>& bounds);
  void fill_columns();
  void sweep_column(std::size_t begin, std::size_t end, const std::vector<Bounds>& bounds,
                    const std::vector<std::uint8_t>& fixed, std::uint32_t column);
  void write_sorted(std::size_t bound_count, std::vector<std::pair<int, int>>& pairs);

  Grid grid_;
  std::vector<Entry> entries_;  ///< by s_low
  std::vector<Entry> columns_;  ///< the entries of each column, each by s_low
  std::vector<std::uint32_t> column_begin_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> keys_;  ///< sort key and index
  std::vector<std::pair<std::uint32_t, std::uint32_t>> other_keys_;
  std::vector<std::pair<int, int>> found_;
  std::vector<std::pair<int, int>> by_second_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace signorini::collision
