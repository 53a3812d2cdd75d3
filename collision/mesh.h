#pragma once

#include <signorini/collision/bounds_tree.h>
#include <signorini/collision/feature_id.h>
#include <signorini/collision/shape.h>

#include <array>
#include <vector>

namespace signorini::collision {

/// A triangle mesh, immutable once made, shared by the shapes that show it.
///
/// Triangles that share an edge and lie in one plane to 1e-6 rad are one flat piece: the edges and
/// vertices inside it are there for the storage only, and no contact ever sits on them.
struct MeshData {
  /// A triangle with what its neighbourhood makes of it.
  struct Triangle {
    std::array<int, 3> vertices;  ///< counter-clockwise seen from the front
    Vec3 normal;                  ///< unit, to the front
    int piece;                    ///< the flat piece: the number of its first triangle
    /// Edge k runs from corner k to corner k + 1. The first half edge, 3 t + k, of the same edge.
    std::array<int, 3> edges;
    std::array<bool, 3> is_inner_edge;    ///< inside a flat piece
    std::array<bool, 3> is_inner_corner;  ///< all triangles at the corner are of this piece
    /// The same corner in the first triangle of the piece that has it: 3 t + k.
    std::array<int, 3> corners;
  };

  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::vector<int>> neighbours;  ///< of each vertex: the other ends of its edges
  /// The vertices opposite to each edge, by its first half edge; of boundary edges one.
  std::vector<std::vector<int>> opposite;
  BoundsTree tree;      ///< of the triangles
  double radius = 0.0;  ///< the largest distance of a vertex from the origin, m
  int degenerate = 0;   ///< triangles of the input that were left out: no area

  // The numbers of features: pieces (by their first triangle), edges, edges as the border of a
  // piece, corners of a piece, vertices.
  [[nodiscard]] Feature piece_feature(int triangle) const;
  [[nodiscard]] Feature edge_feature(int triangle, int k) const;
  [[nodiscard]] Feature border_feature(int triangle, int k) const;
  [[nodiscard]] Feature corner_feature(int triangle, int k) const;
  [[nodiscard]] Feature vertex_feature(int vertex) const;
};

/// A surface of triangles; equal vertices are merged, triangles without area (less than 1e-12 of
/// their longest edge squared) left out and counted.
/// @throws std::invalid_argument naming the vertex or triangle and the bound: not finite, a number
/// out of range, no triangle with an area.
[[nodiscard]] TriangleMesh make_mesh(const std::vector<Vec3>& vertices,
                                     const std::vector<std::array<int, 3>>& triangles);

/// A height field as a mesh: the vertex (i, j) at (i dx, j dy, heights[i + j columns]), centred on
/// the origin in x and y; each cell split along its diagonal from (i, j) to (i + 1, j + 1), front
/// side up.
/// @param columns, rows >= 2 vertices along x and y
/// @throws std::invalid_argument naming what is wrong: sizes, spacings (finite, > 0), heights
/// (finite)
[[nodiscard]] TriangleMesh make_height_field(const std::vector<double>& heights, int columns,
                                             int rows, double dx, double dy);

}  // namespace signorini::collision
