#include <signorini/collision/box_separation.h>

#include <algorithm>
#include <cmath>

namespace signorini::collision {
namespace {

using Kind = BoxAxis::Kind;

/// Edges within this angle (radians) of parallel span no axis of their own: the faces' normals
/// differ from every such axis by at most this much.
constexpr double kParallelEdges = 1e-10;

BoxAxis along(const PlacedBox& a, const PlacedBox& b, const Vec3& axis, Kind kind, int axis_a,
              int axis_b) {
  const double offset = axis.dot(a.centre - b.centre);
  return {kind, axis_a, axis_b, offset < 0.0 ? Vec3(-axis) : axis,
          std::abs(offset) - a.support(axis) - b.support(axis)};
}

/// Calls visit(axis) for each of the 15 until it returns false.
template <class Visit>
void for_each_axis(const PlacedBox& a, const PlacedBox& b, Visit&& visit) {
  for (int i = 0; i < 3; ++i) {
    if (!visit(along(a, b, a.axes.col(i), Kind::kFaceOfA, i, -1))) {
      return;
    }
  }
  for (int j = 0; j < 3; ++j) {
    if (!visit(along(a, b, b.axes.col(j), Kind::kFaceOfB, -1, j))) {
      return;
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vec3 product = a.axes.col(i).cross(b.axes.col(j));
      const double sine = product.norm();
      if (sine > kParallelEdges && !visit(along(a, b, product / sine, Kind::kEdges, i, j))) {
        return;
      }
    }
  }
}

double face_area(const PlacedBox& box, int axis) {
  return box.half[(axis + 1) % 3] * box.half[(axis + 2) % 3];
}

/// Which of two faces with equal separation carries the normal: the larger; of equal ones that of
/// the box which lies lower along a direction that no scene is aligned with. The rule gives the
/// same box when A and B are exchanged.
bool prefer_face_of_a(const PlacedBox& a, const BoxAxis& face_a, const PlacedBox& b,
                      const BoxAxis& face_b) {
  const double area_a = face_area(a, face_a.axis_a);
  const double area_b = face_area(b, face_b.axis_b);
  if (area_a != area_b) {
    return area_a > area_b;
  }
  const Vec3 odd_direction(0.2672612, 0.5345225, 0.8017837);
  return (face_a.normal + face_b.normal).dot(odd_direction) < 0.0;
}

}  // namespace

double preference_tolerance(const PlacedBox& a, const PlacedBox& b) {
  return 1e-6 * std::min(a.half.norm(), b.half.norm());
}

BoxSeparation separate(const PlacedBox& a, const PlacedBox& b) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  const double tolerance = preference_tolerance(a, b);
  BoxAxis best[3];  // by kind
  for (BoxAxis& axis : best) {
    axis.separation = kNone;
  }
  double largest = kNone;
  for_each_axis(a, b, [&](const BoxAxis& axis) {
    BoxAxis& best_of_kind = best[static_cast<int>(axis.kind)];
    // Of faces the first may stay, as clipping finds the points of any; edges cross in one point.
    const double better = axis.kind == Kind::kEdges ? 0.0 : tolerance;
    if (axis.separation > best_of_kind.separation + better) {
      best_of_kind = axis;
    }
    largest = std::max(largest, axis.separation);
    return true;
  });

  const BoxAxis& face_a = best[static_cast<int>(Kind::kFaceOfA)];
  const BoxAxis& face_b = best[static_cast<int>(Kind::kFaceOfB)];
  const BoxAxis& edges = best[static_cast<int>(Kind::kEdges)];
  const double difference = face_a.separation - face_b.separation;
  const bool use_a =
      std::abs(difference) <= tolerance ? prefer_face_of_a(a, face_a, b, face_b) : difference > 0.0;
  const BoxAxis& face = use_a ? face_a : face_b;
  return {largest, edges.separation > face.separation + tolerance ? edges : face};
}

bool overlap(const PlacedBox& a, const PlacedBox& b) {
  bool result = true;
  for_each_axis(a, b, [&](const BoxAxis& axis) { return result = axis.separation <= 0.0; });
  return result;
}

}  // namespace signorini::collision
