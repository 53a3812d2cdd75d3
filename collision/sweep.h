#pragma once

#include <signorini/core/model/types.h>

#include <utility>
#include <vector>

namespace signorini::collision {

/// Axis-aligned bounds; infinite where a shape has none.
struct Bounds {
  Vec3 low;
  Vec3 high;

  [[nodiscard]] bool overlaps(const Bounds& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// Sort and sweep: every pair (i, j), i < j, of bounds that overlap, in ascending order. Sorted
/// along the axis on which the bounds' centres spread most. Cost: n log n, plus the pairs that
/// overlap on that axis; bounds that are infinite on it meet all others.
void overlapping_pairs(const std::vector<Bounds>& bounds, std::vector<std::pair<int, int>>& pairs);

}  // namespace signorini::collision
