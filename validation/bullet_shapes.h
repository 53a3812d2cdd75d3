#pragma once

#include <signorini/collision/shape.h>

#include <btBulletDynamicsCommon.h>
#include <memory>
#include <string>
#include <vector>

namespace signorini::validation {

/// A shape of ours as Bullet's, with what Bullet wants kept alive beside it.
struct BulletShape {
  std::unique_ptr<btStridingMeshInterface> mesh;  ///< outlives the shape
  std::unique_ptr<btCollisionShape> shape;
  Pose in_ours;        ///< Bullet's shape frame in ours
  std::string remark;  ///< how it differs from ours, for the report; empty: it does not
};

/// Bullet's matching shape:
/// - sphere, box, capsule, cylinder: Bullet's own;
/// - cone, convex hull: Bullet's own, larger than ours by a collision margin of 1/1000 of the
///   smallest size (Bullet's default, 4 cm, is not small beside most shapes); hulls with their
///   polyhedral features, so that Bullet clips faces;
/// - ellipsoid, which Bullet lacks: a convex shape by its support function, exact;
/// - half-space: a box of half edge `ground_half_edge` with a face in the plane;
/// - mesh, height field: btBvhTriangleMeshShape of the same triangles, without a margin.
/// A compound comes out as one shape a part.
[[nodiscard]] std::vector<BulletShape> make_bullet_shapes(const collision::Shape& shape,
                                                          double ground_half_edge);

}  // namespace signorini::validation
