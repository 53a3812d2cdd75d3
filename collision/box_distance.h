#pragma once

#include <signorini/collision/box_geometry.h>

namespace signorini::collision {

/// The nearest points of two boxes that are apart, and the features they lie on.
struct BoxNearest {
  double distance = 0.0;  ///< m
  Vec3 point_a = Vec3::Zero();
  Vec3 point_b = Vec3::Zero();
  BoxSides sides_a{0, 0, 0};
  BoxSides sides_b{0, 0, 0};
};

/// By features: 8 + 8 vertices against the other box, and the pairs of edges that are nearest
/// between their ends, those skipped that cannot be nearer. Each candidate is a pair of points of
/// the two boxes, so the distance is never too small; for boxes that are apart the nearest pair is
/// among them. Of equally near pairs the first is kept (vertices of A, vertices of B, edges).
/// @pre the boxes are apart
[[nodiscard]] BoxNearest nearest_points(const PlacedBox& a, const PlacedBox& b);

}  // namespace signorini::collision
