#pragma once

#include <signorini/collision/convex.h>

#include <array>

namespace signorini::collision {

/// Directions between nearest points of two rims that are seen along n to cross.
struct RimDirections {
  std::array<Vec3, 2> normals{Vec3::Zero(), Vec3::Zero()};  ///< unit, from B to A
  int count = 0;
};

/// The points of two circles, apart along n and nearly parallel to each other, that are nearest to
/// each other: Newton in the two angles for the least |P_A - P_B|^2 from each of the two places
/// where the circles cross as seen along n. Nothing where they do not cross or Newton leaves them.
///
/// This is well posed where the search over directions is not: within the angle of n to its axis
/// the point of a rim that carries n runs all around it.
/// @pre both pieces are rims
[[nodiscard]] RimDirections crossing_rims(const Stratum& a, const Stratum& b, const Vec3& n);

}  // namespace signorini::collision
