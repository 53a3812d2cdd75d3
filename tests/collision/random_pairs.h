#pragma once

#include <signorini/collision/shape.h>

#include <random>
#include <string>

namespace signorini::collision::testing {

using Random = std::mt19937_64;

enum class ShapeKind { kSphere, kBox, kCapsule, kCylinder, kCone, kEllipsoid, kHull, kHalfSpace };

/// How two shapes are put beside each other.
enum class Placement {
  kAnywhere,      ///< random poses near each other
  kAligned,       ///< one of the 24 axis-aligned turns (or a turn about z on top of it)
  kNearlyAligned  ///< the same, off by 1e-15 .. 1e-3 rad
};

struct PlacedPair {
  Shape a;
  Pose pose_a;
  Shape b;
  Pose pose_b;
  double size = 0.0;      ///< of the smaller shape (its radius or half diagonal), m
  double rounding = 0.0;  ///< eps times the largest number that the pair's data holds, m
};

double uniform(Random& random, double low, double high);
/// 10^uniform(low, high).
double log_uniform(Random& random, double low_exponent, double high_exponent);
Vec3 random_direction(Random& random);
Quat random_orientation(Random& random);

/// A tetrahedron, octahedron or prism of 8 sides, stretched and turned, its largest extent about
/// `scale`, about a point near its origin.
ConvexHull random_hull(Random& random, double scale);

/// Sizes 1e-3 .. 1e3 (within a pair by up to 1000 different), coordinates up to 1e6.
PlacedPair random_pair(Random& random, ShapeKind a, ShapeKind b, Placement placement);

/// The pair with A moved by `offset`.
PlacedPair moved(const PlacedPair& pair, const Vec3& offset);
PlacedPair exchanged(const PlacedPair& pair);
/// Both moved by the same rigid motion.
PlacedPair carried(const PlacedPair& pair, const Pose& motion);

/// Everything needed to see a failure again.
std::string describe(const PlacedPair& pair);

}  // namespace signorini::collision::testing
