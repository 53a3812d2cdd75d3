#pragma once

#include <signorini/collision/bounds_tree.h>
#include <signorini/collision/shape.h>

#include <vector>

namespace signorini::collision {

/// A convex shape at its place in a compound.
struct CompoundPart {
  Shape shape;
  Pose local;  ///< in the compound's frame
};

/// Convex shapes that move as one, immutable once made. Its distance from another shape is the
/// least of its parts', overlapping or not; its contact set those of the parts, one after another.
struct CompoundData {
  std::vector<CompoundPart> parts;
  BoundsTree tree;      ///< of the parts
  double radius = 0.0;  ///< the largest distance of a point from the origin, or a bound of it, m
};

/// @throws std::invalid_argument naming the part and what is wrong: 1 to 4096 parts, each a valid
/// convex shape at a valid pose (no half-space, mesh or compound), a hull's features < 2^20.
[[nodiscard]] Compound make_compound(std::vector<CompoundPart> parts);

}  // namespace signorini::collision
