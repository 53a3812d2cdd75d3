#include <signorini/collision/box_separation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::collision {
namespace {

using Kind = BoxAxis::Kind;

/// Edges within this angle (radians) of parallel span no axis of their own: the faces' normals
/// differ from every such axis by at most this much.
constexpr double kParallelEdges = 1e-10;

/// The axis, turned so that `along` (a number along it) is >= 0.
Vec3 towards(const Vec3& axis, double along) {
  return along < 0.0 ? Vec3(-axis) : axis;
}

BoxAxis edges_along(const PlacedBox& a, const PlacedBox& b, const Vec3& axis, int axis_a,
                    int axis_b) {
  const double offset = axis.dot(a.centre - b.centre);
  return {Kind::kEdges, axis_a, axis_b, towards(axis, offset),
          std::abs(offset) - a.support(axis) - b.support(axis)};
}

/// Calls visit(axis) for the 6 normals of faces, then for each of the 9 products of edges of which
/// may_matter(bound) says so, bound being no less than its separation; until it returns false.
///
/// With R = A^T B and t = A^T (c_A - c_B), all numbers along a face's normal or a_i x b_j are sums
/// of entries of R (Gottschalk, Lin, Manocha 1996). Rounding of R counts over the sine of the angle
/// between the edges, so that of edges the axis itself has the last word.
template <class MayMatter, class Visit>
void for_each_axis(const PlacedBox& a, const PlacedBox& b, MayMatter&& may_matter, Visit&& visit) {
  const Mat3 R = a.axes.transpose() * b.axes;
  const Mat3 sizes = R.cwiseAbs();
  const Vec3 between = a.centre - b.centre;
  const Vec3 t = a.axes.transpose() * between;
  const Vec3 t_b = b.axes.transpose() * between;
  const Vec3 reach_b = sizes * b.half;  // of B along the axes of A
  const Vec3 reach_a = sizes.transpose() * a.half;
  for (int i = 0; i < 3; ++i) {
    const double separation = std::abs(t[i]) - a.half[i] - reach_b[i];
    if (!visit(BoxAxis{Kind::kFaceOfA, i, -1, towards(a.axes.col(i), t[i]), separation})) {
      return;
    }
  }
  for (int j = 0; j < 3; ++j) {
    const double separation = std::abs(t_b[j]) - b.half[j] - reach_a[j];
    if (!visit(BoxAxis{Kind::kFaceOfB, -1, j, towards(b.axes.col(j), t_b[j]), separation})) {
      return;
    }
  }
  const double rounding = 64.0 * std::numeric_limits<double>::epsilon() *
                          (a.half.sum() + b.half.sum() + t.cwiseAbs().sum());
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      const double sine = std::sqrt(R(i1, j) * R(i1, j) + R(i2, j) * R(i2, j));
      const double apart = std::abs(t[i2] * R(i1, j) - t[i1] * R(i2, j)) -
                           (a.half[i1] * sizes(i2, j) + a.half[i2] * sizes(i1, j)) -
                           (b.half[j1] * sizes(i, j2) + b.half[j2] * sizes(i, j1));
      if (sine > 0.5 * kParallelEdges && !may_matter((apart + rounding) / sine)) {
        continue;
      }
      const Vec3 product = a.axes.col(i).cross(b.axes.col(j));
      const double length = product.norm();
      if (length > kParallelEdges && !visit(edges_along(a, b, product / length, i, j))) {
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
  // Edges that are no further apart than some axis before them are neither preferred nor largest.
  const auto may_matter = [&](double bound) { return bound > largest; };
  for_each_axis(a, b, may_matter, [&](const BoxAxis& axis) {
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
  for_each_axis(
      a, b, [](double bound) { return bound > 0.0; },
      [&](const BoxAxis& axis) { return result = axis.separation <= 0.0; });
  return result;
}

}  // namespace signorini::collision
