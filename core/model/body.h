#pragma once

#include <signorini/core/model/types.h>

#include <string>
#include <vector>

namespace signorini {

enum class BodyKind : unsigned char {
  kDynamic,    ///< moved by forces
  kKinematic,  ///< driven: its velocity is given and no force changes it
  kFixed,      ///< never moves
};

/// What of a rigid body does not change. The body frame has its origin in the centre of mass; its
/// axes are the user's, the inertia tensor need not be diagonal.
struct Body {
  BodyKind kind = BodyKind::kDynamic;
  double mass = 1.0;                ///< kg, > 0 (dynamic bodies)
  Mat3 inertia = Mat3::Identity();  ///< J_body about the centre of mass, body axes, kg m^2
  double gravity_scale = 1.0;       ///< 0: gravity does not act on this body (dimensionless)
  std::string name = {};            ///< for reports

  [[nodiscard]] bool is_dynamic() const { return kind == BodyKind::kDynamic; }
};

/// What does: S = [x, q, p, L] of the notes, section 2. All in world axes.
struct BodyState {
  Vec3 x = Vec3::Zero();      ///< centre of mass, m
  Quat q = Quat::Identity();  ///< orientation, unit
  Vec3 p = Vec3::Zero();      ///< momentum, kg m/s (kinematic bodies: v itself, m/s)
  Vec3 L = Vec3::Zero();      ///< angular momentum about x, kg m^2/s (kinematic bodies: w, rad/s)

  [[nodiscard]] Pose pose() const { return {x, q}; }
};

using Bodies = std::vector<Body>;      ///< constant during a run
using State = std::vector<BodyState>;  ///< same length and order as Bodies

/// v and w of a body, world axes.
struct Velocity {
  Vec3 linear = Vec3::Zero();   ///< of the centre of mass, m/s
  Vec3 angular = Vec3::Zero();  ///< rad/s

  /// u = v + w x r at the material point r away from the centre of mass.
  [[nodiscard]] Vec3 at(const Vec3& r) const { return linear + angular.cross(r); }
};

/// Checks a body. @throws std::invalid_argument naming the body, the field, its value and the
/// bound: gravity_scale finite, and for dynamic bodies (the mass and inertia of the others are
/// never used): mass finite and > 0; inertia finite, symmetric to 1e-9 of its largest entry,
/// positive definite, and each principal moment at most the sum of the other two (triangle
/// inequality) to 1e-9 relative.
void validate(const Body& body);
/// Checks a state against its bodies: same length, all finite, |q| within 1e-6 of 1, fixed bodies
/// at rest (p = L = 0). @throws std::invalid_argument naming the body, the field, its value and the
/// bound.
void validate(const Bodies& bodies, const State& state);

/// J^-1 in world axes: R J_body^-1 R^T; zero unless dynamic.
[[nodiscard]] Mat3 inverse_inertia_world(const Body& body, const BodyState& state);
/// 1/m; zero unless dynamic.
[[nodiscard]] double inverse_mass(const Body& body);
/// v = p/m, w = J^-1 L (kinematic: p and L are v and w; fixed: zero).
[[nodiscard]] Velocity velocity(const Body& body, const BodyState& state);
/// Writes p and L so that velocity() gives these (fixed bodies: unchanged).
void set_velocity(const Body& body, const Velocity& velocity, BodyState& state);
/// T = 1/2 p.v + 1/2 L.w of one body; zero unless dynamic. J.
[[nodiscard]] double kinetic_energy(const Body& body, const BodyState& state);
/// The sum over all dynamic bodies.
[[nodiscard]] double kinetic_energy(const Bodies& bodies, const State& state);
/// Potential energy in a uniform field: -sum m gravity_scale g.x, dynamic bodies. J.
[[nodiscard]] double potential_energy(const Bodies& bodies, const State& state,
                                      const Vec3& gravity);

}  // namespace signorini
