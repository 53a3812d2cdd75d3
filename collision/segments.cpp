#include <signorini/collision/segments.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::collision {

double LineSegment::nearest_to(const Vec3& point) const {
  return std::clamp(axis.dot(point - centre), -half, half);
}

SegmentPoints nearest_points(const LineSegment& a, const LineSegment& b) {
  const Vec3 offset = b.centre - a.centre;
  const double sine_squared = a.axis.cross(b.axis).squaredNorm();
  const double crossing =
      sine_squared > 0.0 ? (a.axis - a.axis.dot(b.axis) * b.axis).dot(offset) / sine_squared : 0.0;
  const double t0 = b.nearest_to(a.at(std::clamp(crossing, -a.half, a.half)));
  const double s0 = a.nearest_to(b.at(t0));
  SegmentPoints best(a, s0, b, b.nearest_to(a.at(s0)));
  const auto offer = [&](const SegmentPoints& other) {
    if (other.between.squaredNorm() < best.between.squaredNorm()) {
      best = other;
    }
  };
  for (const double end : {-1.0, 1.0}) {
    offer({a, end * a.half, b, b.nearest_to(a.at(end * a.half))});
    offer({a, a.nearest_to(b.at(end * b.half)), b, end * b.half});
  }
  return best;
}

LineSegment Triangle::edge_of(int k) const {
  const Vec3& from = corners[k];
  const Vec3& to = corners[(k + 1) % 3];
  const double length = (to - from).norm();
  return {0.5 * (from + to), (to - from) / length, 0.5 * length};
}

Vec3 Triangle::outward_of(int k) const {
  return (corners[(k + 1) % 3] - corners[k]).cross(normal);
}

bool Triangle::is_under(const Vec3& point) const {
  for (int k = 0; k < 3; ++k) {
    if (outward_of(k).dot(point - corners[k]) > 0.0) {
      return false;
    }
  }
  return true;
}

bool nearest_points(const LineSegment& segment, const Triangle& triangle, double reach,
                    SegmentOnTriangle& nearest) {
  const std::array<Vec3, 2> ends{segment.at(-segment.half), segment.at(segment.half)};
  const double low = triangle.normal.dot(ends[0] - triangle.corners[0]);
  const double high = triangle.normal.dot(ends[1] - triangle.corners[0]);
  const bool crosses = !((low > 0.0 && high > 0.0) || (low < 0.0 && high < 0.0));
  if (!crosses && std::min(std::abs(low), std::abs(high)) > reach) {
    return false;
  }
  // Where the segment, or its end that is nearer to the plane, is relative to the three edges.
  const double foot =
      crosses && low != high ? low / (low - high) : (std::abs(low) <= std::abs(high) ? 0.0 : 1.0);
  bool is_over = true;
  std::array<bool, 3> is_outside{};
  for (int k = 0; k < 3; ++k) {
    const Vec3 out = triangle.outward_of(k);
    const double here = out.dot(ends[0] - triangle.corners[k]);
    const double there = out.dot(ends[1] - triangle.corners[k]);
    const double least = std::min(here, there);
    if (least > 0.0 && least * least > reach * reach * out.squaredNorm()) {
      return false;
    }
    is_over = is_over && (1.0 - foot) * here + foot * there <= 0.0;
    is_outside[k] = std::max(here, there) >= 0.0;
  }
  if (is_over) {
    // An end over the triangle, or the point where it goes through.
    nearest.s = foot == 0.0 ? -segment.half
                            : (foot == 1.0 ? segment.half : (2.0 * foot - 1.0) * segment.half);
    nearest.between =
        crosses ? Vec3(Vec3::Zero()) : Vec3((foot == 0.0 ? low : high) * triangle.normal);
    nearest.edge = -1;
    return true;
  }
  // Else the triangle's nearest point is on an edge that some of the segment is beyond.
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (!is_outside[k]) {
      continue;
    }
    const SegmentPoints points = nearest_points(segment, triangle.edge_of(k));
    const double squared = points.between.squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = {points.s, points.between, k, points.t};
    }
  }
  return true;
}

}  // namespace signorini::collision
