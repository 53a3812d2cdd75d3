#pragma once

#include <signorini/core/model/types.h>

namespace signorini::collision {

/// Axis-aligned bounds; infinite where a shape has none.
struct Bounds {
  Vec3 low;
  Vec3 high;

  [[nodiscard]] bool overlaps(const Bounds& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  /// The Euclidean distance; 0 where they overlap.
  [[nodiscard]] double distance(const Bounds& other) const {
    return (low - other.high).cwiseMax(other.low - high).cwiseMax(0.0).norm();
  }
};

}  // namespace signorini::collision
