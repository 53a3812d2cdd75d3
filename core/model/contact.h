#pragma once

#include <signorini/core/model/material.h>
#include <signorini/core/model/types.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace signorini {

/// Which feature carries the contact normal, hence how the normal turns when the bodies move.
enum class NormalOwner : std::uint8_t {
  kFaceA,     ///< N is fixed in A (a face of A): N' = w_A x N
  kFaceB,     ///< N is fixed in B: N' = w_B x N
  kEdgeEdge,  ///< N is perpendicular to an edge of A and an edge of B
  kCurved,    ///< N follows from the local curvature of both surfaces (spheres, axes, vertices)
};

/// A surface near the contact point: its two principal radii of curvature. 0 is sharp (a vertex, or
/// across an edge), +infinity is flat (a face, or along an edge), R is a rounded feature.
struct LocalSurface {
  Vec3 direction = Vec3::UnitX();  ///< unit tangent, world axes: the first principal direction
  double radius_along = 0.0;       ///< of curvature along `direction`, m, in [0, +infinity]
  double radius_across = 0.0;      ///< along N x direction, m

  [[nodiscard]] static LocalSurface vertex() { return {}; }
  [[nodiscard]] static LocalSurface edge(const Vec3& direction) {
    return {direction, std::numeric_limits<double>::infinity(), 0.0};
  }
  [[nodiscard]] static LocalSurface face() {
    constexpr double kFlat = std::numeric_limits<double>::infinity();
    return {Vec3::UnitX(), kFlat, kFlat};
  }
  [[nodiscard]] static LocalSurface sphere(double radius) {
    return {Vec3::UnitX(), radius, radius};
  }
};

/// One point of a contact set. Starts as NaN: what was not filled in cannot pass for data.
///
/// N points from B to A. d = N.(P_A - P_B) > 0 apart, < 0 overlapping. A force f >= 0 pushes A
/// along +N and B along -N.
struct Contact {
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  int body_a = -1;  ///< index into Bodies and State
  int body_b = -1;
  Vec3 point_a = Vec3::Constant(kNaN);  ///< P_A on the surface of A, world, m
  Vec3 point_b = Vec3::Constant(kNaN);  ///< P_B on the surface of B; P_A - P_B = d N
  Vec3 normal = Vec3::Constant(kNaN);   ///< N, unit
  double gap = kNaN;                    ///< d, m

  /// The same pair of features has the same id from step to step, whatever else touches.
  std::uint64_t feature_id = 0;
  NormalOwner owner = NormalOwner::kFaceB;
  LocalSurface surface_a = {};  ///< for N' and d''
  LocalSurface surface_b = {};
  Material material = {};  ///< of the pair, by the pairing rule
  /// Along which mu is material.friction; its part across N counts, world axes. Zero, or along N:
  /// any. Only with a friction_ratio other than 1.
  Vec3 friction_direction = Vec3::Zero();
};

/// The reduced contact set of a state, in an order that depends on the input alone.
using ContactSet = std::vector<Contact>;

/// Checks a contact set that came from outside. @throws std::invalid_argument naming the contact's
/// number, the field, its value and the bound: bodies in range and different, points and gap
/// finite, |N| within 1e-9 of 1 (a zero normal is named as such), radii of the surfaces in
/// [0, infinity] and their directions unit to 1e-9, material valid, friction_direction finite.
void validate(const ContactSet& contacts, int body_count);

}  // namespace signorini
