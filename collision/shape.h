#pragma once

#include <signorini/collision/bounds.h>
#include <signorini/collision/pair_filter.h>
#include <signorini/core/model/body.h>
#include <signorini/core/model/material.h>
#include <signorini/core/model/types.h>

#include <memory>
#include <string>
#include <variant>

namespace signorini::collision {

/// A ball about the origin of its frame.
struct Sphere {
  double radius = 0.5;  ///< m, > 0
};

/// |x| <= half_extents, componentwise, in its frame.
struct Box {
  Vec3 half_extents = Vec3::Constant(0.5);  ///< m, each > 0
};

/// All points within radius of the segment from (0, 0, -half_length) to (0, 0, half_length).
struct Capsule {
  double radius = 0.5;       ///< m, > 0
  double half_length = 0.5;  ///< of the segment, m, > 0
};

/// x^2 + y^2 <= radius^2, |z| <= half_length.
struct Cylinder {
  double radius = 0.5;       ///< m, > 0
  double half_length = 0.5;  ///< m, > 0
};

/// Base: the disc of this radius in z = -half_height. Apex: (0, 0, half_height).
struct Cone {
  double radius = 0.5;       ///< m, > 0
  double half_height = 0.5;  ///< m, > 0
};

/// (x/a)^2 + (y/b)^2 + (z/c)^2 <= 1.
struct Ellipsoid {
  Vec3 radii = Vec3::Constant(0.5);  ///< (a, b, c), m, each > 0
};

struct HullData;

/// A convex polyhedron: made by make_hull() (hull.h) or hull_of_points() (hull_builder.h).
struct ConvexHull {
  std::shared_ptr<const HullData> data;  ///< not null
};

/// z <= 0 in its frame: the surface is the plane z = 0, the outward normal +z.
struct HalfSpace {};

struct MeshData;

/// A surface of triangles on a body that is not dynamic: made by make_mesh() or make_height_field()
/// (mesh.h).
struct TriangleMesh {
  std::shared_ptr<const MeshData> data;  ///< not null
};

struct CompoundData;

/// Several convex shapes as one: made by make_compound() (compound.h).
struct Compound {
  std::shared_ptr<const CompoundData> data;  ///< not null
};

using Shape = std::variant<Sphere, Box, Capsule, Cylinder, Cone, Ellipsoid, ConvexHull, HalfSpace,
                           TriangleMesh, Compound>;

/// Half-spaces and meshes belong to bodies that are not dynamic.
[[nodiscard]] inline bool must_be_immovable(const Shape& shape) {
  return std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<TriangleMesh>(shape);
}

/// A shape fixed to a body.
struct Collider {
  int body = -1;  ///< index into Bodies
  Shape shape;
  Pose local;  ///< shape frame in the body frame (whose origin is the centre of mass)
  Material material;
  std::string name;  ///< for reports
  CollisionFilter filter = {};
  /// In the shape's frame: along it mu is material.friction, across it friction_ratio times that.
  /// Zero: none. Of a pair that of the first collider which has one counts.
  Vec3 friction_direction = Vec3::Zero();
};

/// @throws std::invalid_argument naming the shape, the field, its value and the bound.
void validate(const Shape& shape);
/// Finite, unit quaternion to 1e-6. @throws std::invalid_argument naming the field and its value.
void validate(const Pose& pose);
/// The shape, its pose, its material, its body in [0, body_count).
/// @throws std::invalid_argument naming the collider, the field, its value and the bound.
void validate(const Collider& collider, int body_count);

/// Mass, centre of mass, and inertia about it along the shape's axes, of a solid of uniform
/// density.
struct MassProperties {
  double mass;                 ///< kg
  Mat3 inertia;                ///< kg m^2
  Vec3 centre = Vec3::Zero();  ///< in the shape's frame, m; not its origin: cone, hull
};
/// With m the mass and z the axis:
/// - sphere: 2/5 m r^2; box: m/12 (b^2 + c^2) with full edges; ellipsoid: m/5 (b^2 + c^2);
/// - cylinder: I_z = m/2 r^2, I_x = m (r^2/4 + h^2/3), h half its length;
/// - capsule: the cylinder between the ends, and of both half balls together (mass m_s)
///   I_z = 2/5 m_s r^2, I_x = m_s (2/5 r^2 + h^2 + 3/4 h r);
/// - cone, height H: I_z = 3/10 m r^2, I_x = 3/80 m (4 r^2 + H^2), the centre H/4 over the base;
/// - hull: exact integrals, see make_hull();
/// - compound: the sum over its parts, so that where they overlap the mass counts twice.
/// @param density kg/m^3, finite and > 0
/// @throws std::invalid_argument for a bad shape or density, and for a half-space and a mesh, which
/// have none.
[[nodiscard]] MassProperties mass_properties(const Shape& shape, double density);

/// The largest distance of a point of the shape from the origin of a frame in which the shape has
/// this pose, m; for an ellipsoid, mesh or compound off the origin a bound of it; +infinity for a
/// half-space.
[[nodiscard]] double bounding_radius(const Shape& shape, const Pose& pose);

/// The support function: the largest n.x over the shape, m (n unit). +infinity for a half-space
/// unless n is its normal to 1e-12.
[[nodiscard]] double support(const Shape& shape, const Pose& pose, const Vec3& n);

/// The smallest axis-aligned bounds, to rounding (of meshes: the bounds of their own); infinite on
/// every axis for a half-space.
[[nodiscard]] Bounds bounds(const Shape& shape, const Pose& pose);

}  // namespace signorini::collision
