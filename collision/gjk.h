#pragma once

#include <signorini/collision/convex.h>

namespace signorini::collision {

/// What GJK knows of the distance of two cores when it stops.
struct GjkResult {
  /// The two cores' distance is in [lower, upper]; upper = 0: they overlap or touch.
  double lower = 0.0;
  double upper = 0.0;
  /// From B to A, along which the cores are `lower` apart; zero if no direction was looked at.
  Vec3 normal = Vec3::Zero();
};

/// Gilbert, Johnson, Keerthi 1988: the point nearest to the origin of the difference of the cores,
/// in simplices whose nearest points come from their faces' Voronoi regions (Ericson 2005, 5.1).
/// Ends once upper - lower <= relative * upper, the simplex contains the origin, upper <= touch, or
/// rounding lets it go no further.
/// @param touch m: nearer than this the cores count as touching: the normal is then uncertain by
/// some roundings of their sizes over their distance
[[nodiscard]] GjkResult gjk(const Convex& a, const Convex& b, double relative, double touch);

}  // namespace signorini::collision
