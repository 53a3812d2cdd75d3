#pragma once

#include <signorini/collision/shape.h>

#include <vector>

namespace signorini::collision {

/// The convex hull of points, by Qhull (Barber, Dobkin, Huhdanpaa 1996), with facets that are
/// coplanar to rounding merged into one face. Its vertices are numbered in the order of `points`;
/// points inside are dropped. Only in builds with Qhull (SIGNORINI_WITH_QHULL): without it a hull
/// is given by its faces, make_hull().
/// @throws std::invalid_argument: fewer than 4 points, a point that is not finite (named), points
/// that lie in a plane or nearer to one than make_hull() accepts.
[[nodiscard]] ConvexHull hull_of_points(const std::vector<Vec3>& points);

}  // namespace signorini::collision
