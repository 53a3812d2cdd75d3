#pragma once

#include <signorini/collision/box_geometry.h>

#include <algorithm>
#include <array>
#include <limits>

namespace signorini::collision {

/// A point of a face of one box (the incident one) that lies over a face of another (the reference
/// one), in the frame of the reference face.
struct ClippedPoint {
  double u = 0.0;       ///< along the reference box's axis (face axis + 1) % 3, from its centre, m
  double v = 0.0;       ///< along its axis (face axis + 2) % 3
  double height = 0.0;  ///< over the reference face, m
  BoxSides incident{0, 0, 0};   ///< the incident box's feature: vertex, edge or face
  BoxSides reference{0, 0, 0};  ///< the reference box's: face, edge or vertex
};

/// At most four corners, and one more for each of the four sides they are clipped against.
struct ClippedPolygon {
  std::array<ClippedPoint, 8> points;
  int count = 0;

  /// +infinity if there are no points.
  [[nodiscard]] double lowest_height() const {
    double lowest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < count; ++k) {
      lowest = std::min(lowest, points[k].height);
    }
    return lowest;
  }
};

/// The incident face clipped against the prism over the reference face (Sutherland and Hodgman
/// 1974), the prism widened by `slack` on each side: corners that rounding alone puts outside stay
/// corners, so that features do not flicker where faces are flush. Corners of the result: vertices
/// of the incident face, crossings of edges of the two, vertices of the reference face.
/// @param slack m, >= 0
[[nodiscard]] ClippedPolygon clip_face(const PlacedBox& incident, const BoxFace& incident_face,
                                       const PlacedBox& reference, const BoxFace& reference_face,
                                       double slack);

}  // namespace signorini::collision
