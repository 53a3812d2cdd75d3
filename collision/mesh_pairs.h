#pragma once

#include <signorini/collision/convex_shapes.h>
#include <signorini/collision/mesh.h>
#include <signorini/collision/narrow.h>

#include <concepts>
#include <vector>

namespace signorini::collision {

/// A mesh in the frame of a query.
struct PlacedMesh {
  const MeshData& data;
  Vec3 position;
  Mat3 axes;

  PlacedMesh(const TriangleMesh& mesh, const Pose& pose)
      : data(*mesh.data), position(pose.position), axes(pose.orientation.toRotationMatrix()) {}
};

/// A convex shape A against a mesh B. `near`: bounds of A in the mesh's frame.
///
/// A mesh is a surface, not a solid: A touches it where it touches a triangle, from either side,
/// and inside a closed mesh it is apart from it. Each triangle is a flat convex polyhedron, and A
/// meets it as it would meet any (convex_contacts.h), the triangle's face before a face of A; but a
/// normal at an edge or vertex of the mesh counts only if it belongs to that feature:
///
///     N.(x - x0) <= 1e-6 |x - x0|  for every vertex x of a triangle at the feature, x0 on it,
///
/// so that no vertex reaches further along N than the feature itself. Inner edges of a flat piece
/// and concave edges never pass. Where a triangle's own normal does not count, A meets the triangle
/// along its plane's normal, on the side on which A is least deep, and only where A is over the
/// triangle. A sphere or capsule whose core comes within 1e-4 of its size of a triangle does too. A
/// triangle that A is apart from, or only touches, beside it and deep below its plane, has no
/// contact: the one whose edge or corner that is has it.
/// Where A's nearest point is above the triangle its plane says all; spheres and capsules meet
/// edges and vertices by the nearest points of their segments (segments.h). Inner edges and
/// vertices of flat pieces carry no contacts, and what two triangles of a piece both report is
/// reported once. Where the set that is found does not reach the nearest triangle (A overlaps it
/// across a border, and its deep points are over none) that one is met along whatever normal.
///
/// The distance is the least over the triangles; overlapping: the least gap of the contact set,
/// which is the deepest translation along the normals that count (of each triangle alone, not of
/// all at once).
[[nodiscard]] double mesh_distance(const Convex& a, const Bounds& near, const PlacedMesh& b);
[[nodiscard]] bool mesh_test(const Convex& a, const Bounds& near, const PlacedMesh& b);
void find_mesh_contacts(const Convex& a, const Bounds& near, const PlacedMesh& b, double margin,
                        std::vector<Contact>& contacts);

namespace narrow {

/// The shapes with a core.
template <class S>
concept HasCore = requires(const S& shape, const Pose& pose) {
  core_of(shape, pose);
};

template <HasCore A>
[[nodiscard]] double distance(const A& a, const Pose& pose_a, const TriangleMesh& b,
                              const Pose& pose_b) {
  return mesh_distance(core_of(a, pose_a), bounds(a, pose_b.inverse() * pose_a), {b, pose_b});
}
template <HasCore A>
[[nodiscard]] bool test(const A& a, const Pose& pose_a, const TriangleMesh& b, const Pose& pose_b) {
  return mesh_test(core_of(a, pose_a), bounds(a, pose_b.inverse() * pose_a), {b, pose_b});
}
template <HasCore A>
void find(const A& a, const Pose& pose_a, const TriangleMesh& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  find_mesh_contacts(core_of(a, pose_a), bounds(a, pose_b.inverse() * pose_a), {b, pose_b}, margin,
                     contacts);
}

/// Two immovable shapes: -infinity where their bounds meet, no contacts.
template <class A>
requires std::same_as<A, HalfSpace> || std::same_as<A, TriangleMesh>
[[nodiscard]] double distance(const A&, const Pose&, const TriangleMesh&, const Pose&) {
  return -std::numeric_limits<double>::infinity();
}
template <class A>
requires std::same_as<A, HalfSpace> || std::same_as<A, TriangleMesh>
[[nodiscard]] bool test(const A&, const Pose&, const TriangleMesh&, const Pose&) {
  return true;
}
template <class A>
requires std::same_as<A, HalfSpace> || std::same_as<A, TriangleMesh>
void find(const A&, const Pose&, const TriangleMesh&, const Pose&, double, std::vector<Contact>&) {}

}  // namespace narrow
}  // namespace signorini::collision
