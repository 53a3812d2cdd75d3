#pragma once

#include <signorini/core/model/motion.h>

#include "random_pairs.h"

namespace signorini::collision::testing {

/// Two shapes that fly towards each other, more or less, and spin.
struct Throw {
  PlacedPair pair;
  ConstantVelocityMotion a;
  ConstantVelocityMotion b;

  [[nodiscard]] double gap(double t) const;
};

/// Velocities of 1 to 6 sizes of the smaller shape per second, up to 10 rad/s each; a half-space
/// stays where it is.
/// @param apart their distance at the start over the smaller size
/// @pre not both are half-spaces
Throw random_throw(Random& random, ShapeKind a, ShapeKind b, double apart);

}  // namespace signorini::collision::testing
