#pragma once

#include <signorini/collision/shape.h>

#include <vector>

namespace signorini::collision {

/// A convex polyhedron, immutable once made, shared by the shapes that show it.
struct HullData {
  /// An edge, once for both its directions.
  struct Edge {
    int from;
    int to;
    int left;   ///< the face around which the edge runs from `from` to `to`, counter-clockwise
    int right;  ///< the other one
  };

  std::vector<Vec3> vertices;           ///< m, each one a corner of at least three faces
  std::vector<std::vector<int>> faces;  ///< vertex numbers, counter-clockwise from outside
  std::vector<Vec3> normals;            ///< of the faces, unit, outward
  std::vector<double> offsets;          ///< of the faces: max n.x over the vertices, m
  std::vector<double> areas;            ///< of the faces, m^2
  std::vector<Edge> edges;
  std::vector<Vec3> arcs;  ///< of the edges: across the arc of normals from right to left, unit
  std::vector<std::vector<int>> neighbours;       ///< of each vertex: those it has an edge to
  std::vector<std::vector<int>> faces_of_vertex;  ///< of each vertex, ascending
  std::vector<std::vector<int>> edges_of_vertex;  ///< of each vertex, ascending
  std::vector<std::vector<int>> edges_of_face;    ///< edge k runs from corner k to corner k + 1

  double volume = 0.0;                ///< m^3
  Vec3 centre = Vec3::Zero();         ///< of volume, m
  Mat3 second_moment = Mat3::Zero();  ///< integral of (x - centre)(x - centre)^T, m^5
  double radius = 0.0;                ///< the largest |vertex - centre|, m
};

/// A hull given by its faces.
///
/// Volume, centre and second moment are exact sums over tetrahedra (Tonon 2004, "Explicit exact
/// formulas for the 3-D tetrahedron inertia tensor"): with a, b, c the corners of a triangle of the
/// surface from an inner point, V = det[a b c] / 6 and
/// int x x^T = det / 120 (s s^T + a a^T + b b^T + c c^T), s = a + b + c.
///
/// @param faces each a loop of vertex numbers, counter-clockwise seen from outside
/// @throws std::invalid_argument naming the vertex, face or edge, and the bound: fewer than 4
/// vertices, not finite, a vertex in no face, a number out of range, an edge that is not between
/// exactly two faces, a vertex outside a face's plane or a face that is not flat (by more than 1e-9
/// of the size, the largest extent of the vertices), no volume (< 1e-9 size^3).
/// Cost: (vertices) x (faces).
[[nodiscard]] ConvexHull make_hull(std::vector<Vec3> vertices, std::vector<std::vector<int>> faces);

/// The prism over a convex polygon, from z = bottom to z = top.
/// @param corners x, y, counter-clockwise, m
/// @throws std::invalid_argument as make_hull().
[[nodiscard]] ConvexHull make_prism(const std::vector<Eigen::Vector2d>& corners, double bottom,
                                    double top);

}  // namespace signorini::collision
