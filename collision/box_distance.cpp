#include <signorini/collision/box_distance.h>

#include <cmath>
#include <limits>

namespace signorini::collision {
namespace {

constexpr int kSigns[2] = {-1, 1};

/// Calls visit(sides) for the 8 vertices.
template <class Visit>
void for_each_vertex(Visit&& visit) {
  for (const int x : kSigns) {
    for (const int y : kSigns) {
      for (const int z : kSigns) {
        visit(BoxSides{x, y, z});
      }
    }
  }
}

/// Calls visit(axis, sides) for the 12 edges, `axis` being the one they run along.
template <class Visit>
void for_each_edge(Visit&& visit) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int first : kSigns) {
      for (const int second : kSigns) {
        BoxSides sides{0, 0, 0};
        sides[(axis + 1) % 3] = first;
        sides[(axis + 2) % 3] = second;
        visit(axis, sides);
      }
    }
  }
}

/// A point found, in the frame of one of the boxes.
struct Candidate {
  double squared = std::numeric_limits<double>::infinity();
  Vec3 on_box = Vec3::Zero();    ///< on the box whose frame it is
  Vec3 on_other = Vec3::Zero();  ///< on the other one
  BoxSides sides_box{0, 0, 0};
  BoxSides sides_other{0, 0, 0};

  void offer(const Candidate& other) {
    if (other.squared < squared) {
      *this = other;
    }
  }
};

/// One box seen from the other's frame.
struct SeenBox {
  Vec3 centre;
  Mat3 half_axes;  ///< columns: axis * half extent

  SeenBox(const PlacedBox& box, const PlacedBox& frame)
      : centre(frame.to_local(box.centre)),
        half_axes(frame.axes.transpose() * box.axes * box.half.asDiagonal()) {}

  [[nodiscard]] Vec3 at(const BoxSides& sides) const {
    return centre + half_axes * Vec3(sides[0], sides[1], sides[2]);
  }
};

/// The vertices of `other` against the box |x| <= half.
Candidate nearest_vertex(const Vec3& half, const SeenBox& other) {
  Candidate best;
  for_each_vertex([&](const BoxSides& sides) {
    const Vec3 vertex = other.at(sides);
    const Vec3 nearest = vertex.cwiseMax(-half).cwiseMin(half);
    const Vec3 outside = vertex - nearest;
    BoxSides sides_box;
    for (int k = 0; k < 3; ++k) {
      sides_box[k] = (outside[k] > 0.0) - (outside[k] < 0.0);
    }
    best.offer({outside.squaredNorm(), nearest, vertex, sides_box, sides});
  });
  return best;
}

/// One edge of `other`, middle + s direction (|s| <= 1), against the 12 edges of |x| <= half; pairs
/// whose nearest points are not both inside the edges are left to nearest_vertex().
void offer_edge(const Vec3& half, const Vec3& middle, const Vec3& direction,
                const BoxSides& sides_other, Candidate& best) {
  for_each_edge([&](int axis, const BoxSides& sides) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double du = middle[u] - sides[u] * half[u];
    const double dv = middle[v] - sides[v] * half[v];
    const double across = direction[u] * direction[u] + direction[v] * direction[v];
    const double s = -(du * direction[u] + dv * direction[v]) / across;
    if (!(std::abs(s) <= 1.0)) {
      return;  // parallel edges (0/0, x/0) included
    }
    const Vec3 on_other = middle + s * direction;
    if (std::abs(on_other[axis]) > half[axis]) {
      return;
    }
    Vec3 on_box = on_other;
    on_box[u] = sides[u] * half[u];
    on_box[v] = sides[v] * half[v];
    best.offer({(on_other - on_box).squaredNorm(), on_box, on_other, sides, sides_other});
  });
}

/// The squared distance of |x| <= half and the axis-aligned bounds of the segment: no point of it
/// is nearer.
double squared_bound(const Vec3& half, const Vec3& middle, const Vec3& direction) {
  return (middle.cwiseAbs() - direction.cwiseAbs() - half).cwiseMax(0.0).squaredNorm();
}

}  // namespace

BoxNearest nearest_points(const PlacedBox& a, const PlacedBox& b) {
  const SeenBox a_in_b(a, b);
  const SeenBox b_in_a(b, a);

  Candidate best = nearest_vertex(b.half, a_in_b);
  const Candidate vertex_of_b = nearest_vertex(a.half, b_in_a);
  const bool is_vertex_of_b = vertex_of_b.squared < best.squared;
  const double vertex_squared = std::min(best.squared, vertex_of_b.squared);

  Candidate edges;
  edges.squared = vertex_squared;
  for_each_edge([&](int axis, const BoxSides& sides) {
    const Vec3 middle = a_in_b.at(sides);
    const Vec3 direction = a_in_b.half_axes.col(axis);
    if (squared_bound(b.half, middle, direction) < edges.squared) {
      offer_edge(b.half, middle, direction, sides, edges);
    }
  });

  if (edges.squared < vertex_squared) {
    best = edges;
  } else if (is_vertex_of_b) {
    return {std::sqrt(vertex_of_b.squared), a.to_world(vertex_of_b.on_box),
            b.at(vertex_of_b.sides_other), vertex_of_b.sides_box, vertex_of_b.sides_other};
  }
  return {std::sqrt(best.squared), b.to_world(best.on_other), b.to_world(best.on_box),
          best.sides_other, best.sides_box};
}

}  // namespace signorini::collision
