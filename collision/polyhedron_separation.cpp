#include <signorini/collision/gjk.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/polyhedron_separation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace signorini::collision {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Arcs that miss each other by this (sines of angles) on the Gauss map count as crossing.
constexpr double kArcSlack = 1e-12;

/// B's frame seen from A's.
struct Relative {
  Mat3 turn;
  Vec3 shift;
};

Relative seen_from(const Polyhedron& p, const Polyhedron& q) {
  return {p.axes.transpose() * q.axes, p.axes.transpose() * (q.position - p.position)};
}

/// Without branches that depend on the data.
int support_vertex(const Polyhedron& p, const Vec3& n) {
  const double* x = p.vertices[0].data();
  int best = 0;
  double highest = -kInfinity;
  for (int v = 0; v < p.corners; ++v, x += 3) {
    const double height = n.x() * x[0] + n.y() * x[1] + n.z() * x[2];
    best = height > highest ? v : best;
    highest = height > highest ? height : highest;
  }
  return best;
}

/// The face of a polyhedron along which the other one is furthest from it.
struct FaceAxis {
  int face = -1;
  double separation = -kInfinity;
  Vec3 nearest = Vec3::Zero();  ///< the other's deepest vertex, in the frame of the face
};

struct FaceCandidate {
  int face;
  double separation;
};

/// Does p hold a point of its frame?
bool is_inside(const Polyhedron& p, const Vec3& point) {
  for (int f = 0; f < p.faces; ++f) {
    if (p.shape->normals[f].dot(point) > p.offsets[f]) {
      return false;
    }
  }
  return true;
}

/// What is known of the faces of one polyhedron.
struct FaceTable {
  std::vector<FaceCandidate> near;  ///< may be within the tolerance of the best of both shapes
  std::vector<double> heights;      ///< of a deep vertex of the other over each face, m

  void measure(const Polyhedron& p, const Vec3& point) {
    heights.resize(p.faces);
    for (int f = 0; f < p.faces; ++f) {
      heights[f] = p.shape->normals[f].dot(point) - p.offsets[f];
    }
  }
  /// Do the shapes overlap for sure: that vertex, or the deepest one, lies inside.
  [[nodiscard]] bool holds_a_vertex(const Polyhedron& p, const Vec3& deepest) const {
    return std::all_of(heights.begin(), heights.end(), [](double h) { return h <= 0.0; }) ||
           is_inside(p, deepest);
  }
};

/// The largest separation over the faces of p, where the largest over both shapes is at least
/// `known`.
FaceAxis best_face(const Polyhedron& p, const Polyhedron& q, double known, double tolerance,
                   FaceTable& table) {
  const Relative relative = seen_from(p, q);
  const Vec3* const normals = p.shape->normals.data();
  FaceAxis best;
  table.near.clear();
  const auto look = [&](int f) {
    const Vec3& n = normals[f];
    const int v = support_vertex(q, relative.turn.transpose() * -n);
    const Vec3 deepest = relative.turn * q.vertices[v] + relative.shift;
    const double separation = n.dot(deepest) - p.offsets[f];
    if (separation > best.separation) {
      best = {f, separation, deepest};
    }
    if (separation >= std::max(best.separation, known) - tolerance) {
      table.near.push_back({f, separation});
    }
  };
  int first = 0;
  double highest = -kInfinity;
  for (int f = 0; f < p.faces; ++f) {
    const double height = normals[f].dot(relative.shift) - p.offsets[f];
    first = height > highest ? f : first;
    highest = height > highest ? height : highest;
  }
  look(first);
  table.measure(p, best.nearest);
  for (int f = 0; f < p.faces; ++f) {
    const double wanted = std::max(best.separation, known) - tolerance;
    if (f != first && table.heights[f] >= wanted &&
        normals[f].dot(best.nearest) - p.offsets[f] >= wanted) {
      look(f);
    }
  }
  return best;
}

/// Is a point (in the frame of p) over a face of p?
bool is_over_face(const Polyhedron& p, int face, const Vec3& point) {
  const std::vector<int>& loop = p.shape->faces[face];
  const Vec3& n = p.shape->normals[face];
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3& from = p.vertices[loop[k]];
    const Vec3& to = p.vertices[loop[k + 1 == loop.size() ? 0 : k + 1]];
    if ((to - from).cross(n).dot(point - from) > 0.0) {
      return false;
    }
  }
  return true;
}

/// An edge on the Gauss map, in the frame of A.
struct PlacedEdge {
  Vec3 left;  ///< the normals of its two faces
  Vec3 right;
  Vec3 arc;  ///< unit, across the arc from right to left
  int number;
};

/// Two edges.
struct EdgeAxis {
  int a = -1;
  int b = -1;
  double separation = -kInfinity;
  Vec3 normal = Vec3::Zero();  ///< from B to A, in the frame of A
};

struct Memory {
  FaceTable faces_a;
  FaceTable faces_b;
  std::vector<PlacedEdge> edges_a;
  std::vector<PlacedEdge> edges_b;
};

Memory& memory() {
  thread_local Memory of_this_thread;
  return of_this_thread;
}

/// The edges of p that may give an overlap of less than `depth`: see separate_polyhedra(). Turned
/// by `turn` (null: not at all).
/// @param n, lowest an edge must come as far as n.x >= lowest
void edges_that_may_win(const Polyhedron& p, const FaceTable& table, double depth, const Vec3& n,
                        double lowest, const Mat3* turn, std::vector<PlacedEdge>& edges) {
  edges.clear();
  for (int f = 0; f < p.faces; ++f) {
    if (table.heights[f] < -depth) {
      continue;
    }
    for (const int e : p.shape->edges_of_face[f]) {
      const HullData::Edge& edge = p.shape->edges[e];
      const int other = edge.left == f ? edge.right : edge.left;
      if ((other < f && table.heights[other] >= -depth) ||
          std::max(n.dot(p.vertices[edge.from]), n.dot(p.vertices[edge.to])) < lowest) {
        continue;  // met already, or too far away
      }
      const Vec3& left = p.shape->normals[edge.left];
      const Vec3& right = p.shape->normals[edge.right];
      const Vec3& arc = p.shape->arcs[e];
      if (turn == nullptr) {
        edges.push_back({left, right, arc, e});
      } else {
        edges.push_back({*turn * left, *turn * right, *turn * arc, e});
      }
    }
  }
}

/// Do the arcs of A's edge and of the mirrored edge of B cross on the Gauss map?
bool arcs_cross(const PlacedEdge& a, const PlacedEdge& b) {
  const double left_b = b.left.dot(a.arc);
  const double right_b = b.right.dot(a.arc);
  if (left_b * right_b > kArcSlack) {
    return false;
  }
  const double left_a = a.left.dot(b.arc);
  const double right_a = a.right.dot(b.arc);
  return left_a * right_a <= kArcSlack && left_b * right_a <= kArcSlack;
}

EdgeAxis best_edges(const Polyhedron& a, const Polyhedron& b, const Relative& relative,
                    double at_least, const std::vector<PlacedEdge>& edges_a,
                    const std::vector<PlacedEdge>& edges_b) {
  EdgeAxis best;
  best.separation = at_least;
  for (const PlacedEdge& edge_a : edges_a) {
    for (const PlacedEdge& edge_b : edges_b) {
      if (!arcs_cross(edge_a, edge_b)) {
        continue;
      }
      const HullData::Edge& ends_a = a.shape->edges[edge_a.number];
      const HullData::Edge& ends_b = b.shape->edges[edge_b.number];
      const Vec3& from_a = a.vertices[ends_a.from];
      const Vec3 from_b = relative.turn * b.vertices[ends_b.from] + relative.shift;
      const Vec3 along_b = relative.turn * (b.vertices[ends_b.to] - b.vertices[ends_b.from]);
      const Vec3 cross = (a.vertices[ends_a.to] - from_a).cross(along_b);
      const double length = cross.norm();
      if (!(length > 0.0)) {
        continue;
      }
      const bool is_outward_of_a = cross.dot(edge_a.left + edge_a.right) > 0.0;
      const Vec3 N = (is_outward_of_a ? -1.0 : 1.0) / length * cross;
      if (!(N.dot(from_a - from_b) > best.separation)) {
        continue;
      }
      const Vec3& low_a = a.vertices[support_vertex(a, -N)];
      const Vec3& high_b = b.vertices[support_vertex(b, relative.turn.transpose() * N)];
      const double separation = N.dot(low_a - (relative.turn * high_b + relative.shift));
      if (separation > best.separation) {
        best = {edge_a.number, edge_b.number, separation, N};
      }
    }
  }
  return best;
}

/// Do the shapes overlap for sure: the point of A's edge that is nearest to B's lies in B.
bool edge_is_inside(const Polyhedron& a, const Polyhedron& b, const Relative& relative,
                    const EdgeAxis& edges) {
  if (edges.a < 0) {
    return false;
  }
  const HullData::Edge& ends_a = a.shape->edges[edges.a];
  const HullData::Edge& ends_b = b.shape->edges[edges.b];
  const Vec3& from_a = a.vertices[ends_a.from];
  const Vec3 along_a = a.vertices[ends_a.to] - from_a;
  const Vec3 from_b = relative.turn * b.vertices[ends_b.from] + relative.shift;
  const Vec3 along_b = relative.turn * (b.vertices[ends_b.to] - b.vertices[ends_b.from]);
  const Vec3 cross = along_a.cross(along_b);
  const double t = (from_b - from_a).cross(along_b).dot(cross) / cross.squaredNorm();
  return t >= 0.0 && t <= 1.0 &&
         is_inside(b, relative.turn.transpose() * (from_a + t * along_a - relative.shift));
}

/// Of the faces within the preference tolerance of the distance the one that is preferred.
std::optional<FacingFace> preferred_face(const Convex& shape_a, const Convex& shape_b,
                                         double distance, const Memory& found) {
  std::optional<FacingFace> best;
  double best_area = 0.0;
  const auto look = [&](const Convex& shape, const FaceCandidate& candidate, bool of_a) {
    if (!is_as_far(shape_a, shape_b, distance, candidate.separation)) {
      return;
    }
    const Polyhedron& p = *shape.polyhedron();
    const Vec3 outward = p.axes * p.shape->normals[candidate.face];
    const FacingFace face{of_a, of_a ? Vec3(-outward) : outward, candidate.separation};
    const double area = p.areas[candidate.face];
    if (!best || prefers(face, area, *best, best_area)) {
      best = face;
      best_area = area;
    }
  };
  for (const FaceCandidate& candidate : found.faces_a.near) {
    look(shape_a, candidate, true);
  }
  for (const FaceCandidate& candidate : found.faces_b.near) {
    look(shape_b, candidate, false);
  }
  return best;
}

}  // namespace

void separate_polyhedra(const Convex& shape_a, const Convex& shape_b,
                        PolyhedronSeparation& result) {
  const Polyhedron& a = *shape_a.polyhedron();
  const Polyhedron& b = *shape_b.polyhedron();
  const double tolerance = preference_tolerance(shape_a, shape_b);
  Memory& found = memory();
  const FaceAxis of_a = best_face(a, b, -kInfinity, tolerance, found.faces_a);
  const FaceAxis of_b = best_face(b, a, of_a.separation, tolerance, found.faces_b);
  const double by_faces = std::max(of_a.separation, of_b.separation);
  result.separation = by_faces;
  result.is_distance = false;
  result.face.reset();
  const bool a_is_best = of_a.separation >= of_b.separation;
  if (by_faces > 0.0) {
    const double rounding = 16.0 * kEpsilon * (a.size + b.size + by_faces);
    result.is_distance =
        (of_a.separation >= by_faces - rounding && is_over_face(a, of_a.face, of_a.nearest)) ||
        (of_b.separation >= by_faces - rounding && is_over_face(b, of_b.face, of_b.nearest));
    if (result.is_distance) {
      result.face = preferred_face(shape_a, shape_b, by_faces, found);
    }
    return;
  }
  const Relative relative = seen_from(a, b);
  // N, from B to A, in the frames of A and of B; how far B reaches along it, from A's origin.
  const Vec3 in_a = a_is_best ? Vec3(-a.shape->normals[of_a.face])
                              : Vec3(relative.turn * b.shape->normals[of_b.face]);
  const Vec3 in_b = relative.turn.transpose() * in_a;
  const double shift = in_a.dot(relative.shift);
  const double b_reaches = a_is_best ? in_a.dot(of_a.nearest) : b.offsets[of_b.face] + shift;
  const double depth = -by_faces + 1e-9 * (a.size + b.size);
  edges_that_may_win(a, found.faces_a, depth, -in_a, -b_reaches - depth, nullptr, found.edges_a);
  edges_that_may_win(b, found.faces_b, depth, in_b, b_reaches - shift - 2.0 * depth, &relative.turn,
                     found.edges_b);
  const EdgeAxis edges = best_edges(a, b, relative, by_faces, found.edges_a, found.edges_b);
  if (!found.faces_a.holds_a_vertex(a, of_a.nearest) &&
      !found.faces_b.holds_a_vertex(b, of_b.nearest) && !edge_is_inside(a, b, relative, edges) &&
      gjk(shape_a, shape_b, 0.5, 0.0).upper > 0.0) {
    return;  // they may be apart along the product of two edges, however far
  }
  result.is_distance = true;
  result.separation = edges.separation;
  result.face = preferred_face(shape_a, shape_b, edges.separation, found);
  if (!result.face) {
    result.edges = {a.axes * edges.normal, a.edge(edges.a), b.edge(edges.b)};
  }
}

}  // namespace signorini::collision
