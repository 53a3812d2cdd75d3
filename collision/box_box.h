#pragma once

#include <signorini/collision/narrow.h>

#include <vector>

namespace signorini::collision::narrow {

/// Apart: the Euclidean distance. Overlapping: minus the least translation (separating axes).
[[nodiscard]] double distance(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b);
[[nodiscard]] bool test(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b);

/// The contact set, by the axis that separate() prefers:
/// - a face: the other box's face that faces it, clipped against it, its points with gap <= margin;
///   owner: the face; the other side's points count as points of its body (LocalSurface::vertex());
/// - two edges: one point, owner kEdgeEdge, LocalSurface::edge() of both;
/// and, for boxes that are apart by more than their axes say, so that the nearest features are
/// vertex and vertex or vertex and edge:
/// - the nearest points, owner kCurved, with LocalSurface::vertex() and edge(). Two of them, at the
///   ends of the overlap, where the features are parallel edges.
/// Features that are nearer than margin but belong to neither face of the chosen pair are not
/// listed: they are no part of the contact that closes first.
void find(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts);

}  // namespace signorini::collision::narrow
