#pragma once

#include <signorini/collision/box_geometry.h>

namespace signorini::collision {

/// An axis that separates two boxes A and B, or along which they overlap least.
struct BoxAxis {
  enum class Kind : unsigned char { kFaceOfA, kFaceOfB, kEdges };

  Kind kind = Kind::kFaceOfA;
  int axis_a = -1;             ///< of the face or the edge of A; -1: none
  int axis_b = -1;             ///< of B
  Vec3 normal = Vec3::Zero();  ///< unit, from B to A
  double separation = 0.0;     ///< along normal, m; < 0: overlap
};

struct BoxSeparation {
  /// The largest separation over the 15 axes. Boxes that are apart: a lower bound of the distance.
  /// Boxes that overlap: minus the least translation that parts them.
  double separation = 0.0;
  /// The axis for the contact set: a face's where its separation is within the preference tolerance
  /// of the largest, and of the faces of A and B the larger one likewise.
  BoxAxis preferred;
};

/// 1e-6 of the smaller box's half diagonal: below it separations count as equal when the axis of a
/// contact set is chosen, so that rounding and the jitter of resting stacks do not choose. Larger:
/// steadier features; smaller: gaps nearer to the least translation.
[[nodiscard]] double preference_tolerance(const PlacedBox& a, const PlacedBox& b);

/// Separating axes of two boxes (Gottschalk, Lin, Manocha 1996): 3 + 3 face normals and 9 products
/// of edges. Every product is used with the full support of both boxes, so that each axis gives a
/// valid bound however nearly parallel its edges are.
[[nodiscard]] BoxSeparation separate(const PlacedBox& a, const PlacedBox& b);

/// separate(a, b).separation <= 0, with an early end at the first axis that separates.
[[nodiscard]] bool overlap(const PlacedBox& a, const PlacedBox& b);

}  // namespace signorini::collision
