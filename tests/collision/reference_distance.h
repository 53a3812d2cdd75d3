#pragma once

#include <signorini/collision/shape.h>

namespace signorini::collision::testing {

/// The distance of two boxes, independent of the library's: the quadratic programme
/// min |c_A + A x - c_B - B y|, |x| <= half_A, |y| <= half_B by trying every choice of coordinates
/// at their bounds that leaves at most three free (a minimum with no more free ones always exists).
/// 0, to rounding, if they overlap.
double reference_box_distance(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b);

/// The least translation that parts two overlapping boxes: the least distance from the origin to a
/// plane through three of the 64 differences of vertices that has all others on one side. Slow.
double reference_box_depth(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b);

}  // namespace signorini::collision::testing
