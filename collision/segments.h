#pragma once

#include <signorini/core/model/types.h>

#include <array>

namespace signorini::collision {

/// The points centre + t axis, |t| <= half; half = 0: a point.
struct LineSegment {
  Vec3 centre = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  ///< unit
  double half = 0.0;          ///< m, >= 0

  [[nodiscard]] Vec3 at(double t) const { return centre + t * axis; }
  [[nodiscard]] double nearest_to(const Vec3& point) const;
};

/// A point of each of two segments.
struct SegmentPoints {
  double s = 0.0;
  double t = 0.0;
  Vec3 between = Vec3::Zero();  ///< a(s) - b(t), m

  SegmentPoints() = default;
  SegmentPoints(const LineSegment& a, double s_, const LineSegment& b, double t_)
      : s(s_), t(t_), between(a.at(s_) - b.at(t_)) {}
};

/// Ericson 2005, 5.1.9: from the crossing of the lines, held within the ends; each end of either
/// against the other segment besides, so that rounding of nearly parallel lines costs nothing. At
/// an end the parameter is that end's exactly.
[[nodiscard]] SegmentPoints nearest_points(const LineSegment& a, const LineSegment& b);

/// The nearest points of a segment and a triangle.
struct SegmentOnTriangle {
  double s = 0.0;               ///< of the segment
  Vec3 between = Vec3::Zero();  ///< from the triangle's point to the segment's, m; 0: they meet
  int edge = -1;   ///< the triangle's point is on the edge from this corner to the next; -1: inside
  double t = 0.0;  ///< along that edge as edge_of() has it
};

/// A flat triangle, corners counter-clockwise from where its unit normal points.
struct Triangle {
  std::array<Vec3, 3> corners;
  Vec3 normal;

  /// From corner k to the next: t = -half and half are these corners.
  [[nodiscard]] LineSegment edge_of(int k) const;
  /// In the triangle's plane, across the edge from corner k; as long as the edge.
  [[nodiscard]] Vec3 outward_of(int k) const;
  /// The foot of the point on the plane is in the triangle.
  [[nodiscard]] bool is_under(const Vec3& point) const;
};

/// False, and nothing written, where they are proved to be further apart than `reach`: by the
/// triangle's plane, or by a plane that stands on one of its edges.
[[nodiscard]] bool nearest_points(const LineSegment& segment, const Triangle& triangle,
                                  double reach, SegmentOnTriangle& nearest);

}  // namespace signorini::collision
