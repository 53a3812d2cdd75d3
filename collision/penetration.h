#pragma once

#include <signorini/collision/convex.h>

#include <vector>

namespace signorini::collision {

/// A direction along which the cores are `separation` apart (< 0: they overlap by that much).
struct Axis {
  Vec3 normal;  ///< unit, from B to A
  double separation;
};

/// The directions of the least translation that parts two cores that overlap or nearly touch: the
/// largest separation first, then those of other faces that are within `tolerance` of it.
///
/// Expanding polytope (van den Bergen 2001): a polytope inside the difference of the cores A - B
/// grows by support points beyond the face that is nearest to the origin, until that face is within
/// `tolerance` of the surface. The origin may lie outside: faces then count by their signed
/// distance, so that cores that are a little apart are no special case.
///
/// Minus the largest separation is then the least translation, to tolerance. After 256 points it
/// ends with the best direction so far and returns false. Allocates nothing once no polytope is
/// larger than an earlier one of this thread.
/// @param tolerance m, > 0
/// @param axes replaced
/// @pre the difference has volume: not both cores are points or segments
[[nodiscard]] bool penetration(const Convex& a, const Convex& b, double tolerance,
                               std::vector<Axis>& axes);

}  // namespace signorini::collision
