#pragma once

#include <signorini/collision/pair_filter.h>
#include <signorini/core/model/body.h>
#include <signorini/core/model/material.h>
#include <signorini/core/model/types.h>

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

/// z <= 0 in its frame: the surface is the plane z = 0, the outward normal +z.
struct HalfSpace {};

using Shape = std::variant<Sphere, Box, HalfSpace>;

/// A shape fixed to a body.
struct Collider {
  int body = -1;  ///< index into Bodies
  Shape shape;
  Pose local;  ///< shape frame in the body frame (whose origin is the centre of mass)
  Material material;
  std::string name;  ///< for reports
  CollisionFilter filter = {};
};

/// @throws std::invalid_argument naming the shape, the field, its value and the bound.
void validate(const Shape& shape);
/// Finite, unit quaternion to 1e-6. @throws std::invalid_argument naming the field and its value.
void validate(const Pose& pose);
/// The shape, its pose, its material, its body in [0, body_count).
/// @throws std::invalid_argument naming the collider, the field, its value and the bound.
void validate(const Collider& collider, int body_count);

/// Mass and inertia about the centre of mass, shape axes, of a solid of uniform density.
struct MassProperties {
  double mass;   ///< kg
  Mat3 inertia;  ///< kg m^2
};
/// Sphere: 2/5 m r^2. Box: m/12 (b^2 + c^2) with full edges.
/// @param density kg/m^3, finite and > 0
/// @throws std::invalid_argument for a bad shape or density, and for a half-space, which has none.
[[nodiscard]] MassProperties mass_properties(const Shape& shape, double density);

/// The largest distance of a point of the shape from the origin of a frame in which the shape has
/// this pose; +infinity for a half-space. m.
[[nodiscard]] double bounding_radius(const Shape& shape, const Pose& pose);

/// The support function: the largest n.x over the shape, m (n unit). +infinity for a half-space
/// unless n is its normal to 1e-12.
[[nodiscard]] double support(const Shape& shape, const Pose& pose, const Vec3& n);

}  // namespace signorini::collision
