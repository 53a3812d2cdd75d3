#pragma once

#include "random_pairs.h"

#include <string>

namespace signorini::collision::testing {

struct PairCounts {
  long poses = 0;
  long apart = 0;
  long contacts = 0;
};

/// What must hold for every pair of shapes, wherever they are; returns what does not hold, or
/// nothing. The gap is judged by convex duality, with the support functions of shape.h alone: a
/// direction N along which the shapes are d apart, and a pair of points of theirs that are d apart,
/// prove each other. Overlapping: that no direction of a sample parts them by less.
///
/// - test = (distance <= 0) = the same with A and B exchanged, also in the distance;
/// - a contact set exists exactly where distance <= margin; its least gap is the distance;
/// - |N| = 1, one N a set, P_A - P_B = gap N, points on the shapes, ids different, surfaces valid;
/// - moving A by -gap N along N brings the touch;
/// - a rigid motion of both changes no distance.
[[nodiscard]] std::string broken_property(Random& random, const PlacedPair& pair, double margin,
                                          PairCounts& counts);

/// The pair with A moved along the contact normal until the gap is 0 or up to 1e-9 of the size off.
[[nodiscard]] PlacedPair kissing(Random& random, const PlacedPair& pair);

/// 0, a tenth of the smaller size, or ten times it.
[[nodiscard]] double random_margin(Random& random, const PlacedPair& pair);

/// Runs `poses` random poses of a pair of kinds, a third of them kissing; returns the first failure
/// with everything needed to see it again, or nothing.
[[nodiscard]] std::string check_poses(ShapeKind a, ShapeKind b, long poses, unsigned seed,
                                      PairCounts& counts);

}  // namespace signorini::collision::testing
