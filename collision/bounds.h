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
};

}  // namespace signorini::collision
