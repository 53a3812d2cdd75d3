#pragma once

#include <signorini/collision/separation.h>

#include <optional>

namespace signorini::collision {

/// How far apart two convex polyhedra are.
struct PolyhedronSeparation {
  /// The largest separation over the axes that were tried, m; never more than the signed distance.
  double separation = 0.0;
  /// It is the signed distance. False where they are apart and no face has the other's nearest
  /// vertex over it: the nearest features are then edges or vertices, and separate() finds them.
  bool is_distance = false;
  std::optional<FacingFace> face;  ///< as Separation's. Without one, if is_distance: two edges do
  Meeting edges;                   ///< @pre is_distance, no face
};

/// Separating axes of two polyhedra: the normals of the faces of both, and the products of those
/// pairs of edges whose arcs cross on the Gauss map, that is of those that span a face of the
/// Minkowski difference (Gregorius, "The separating axis test between convex polyhedra", GDC 2013).
///
/// What cannot win is not looked at:
/// - a face, where a vertex of the other shape that is known already lies deeper below it than the
///   best separation s says;
/// - an edge, where the shapes overlap (proved by a vertex or a point of the best edge that lies
///   inside, or by GJK). With D the depth along the best face: an edge of A can give less only if a
///   known vertex of B lies less than D below one of its two faces (between the two normals the
///   depth below the edge is at least that below the less deep face); and as the least translation
///   joins points of the two edges that are at most D apart, both come within D or 2 D of where the
///   best face's separation is measured.
///
/// Every axis counts with the full support of both shapes, so that each gives a valid bound
/// however nearly parallel its edges are. Cost: for shallow overlaps about (faces + vertices); at
/// worst (edges of A) x (edges of B). Allocates nothing once no polyhedron is larger than an
/// earlier one of this thread.
/// @pre a.polyhedron() and b.polyhedron()
void separate_polyhedra(const Convex& a, const Convex& b, PolyhedronSeparation& result);

}  // namespace signorini::collision
