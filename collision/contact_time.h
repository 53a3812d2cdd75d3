#pragma once

#include <signorini/collision/shape.h>
#include <signorini/core/model/motion.h>

#include <optional>

namespace signorini::collision {

/// A shape fixed to a moving frame.
struct MovingShape {
  const Shape& shape;
  const Motion& motion;  ///< of the frame
  Pose local;            ///< the shape in the frame
};

/// Contact time: the first t in [0, duration] at which the shapes touch while approaching.
///
/// With d(t) the signed distance, level(t) = min(0, the largest d so far) and the tolerance
/// eps = 1e-9 of the smaller shape's size (its largest distance from its centre; never less than
/// the rounding of the positions), it is the time after which d falls more than eps/2 below the
/// level:
/// - apart at the start: the time at which d reaches 0;
/// - touching (d <= eps/2, so overlapping too) at the start: exactly 0 if approaching; nothing if
///   resting (d stays within eps/2 of the level); if separating, the next approach.
/// At the returned time d is within rounding of the level, and it was nowhere before it below the
/// level by more than eps. A dip by less than eps/2 (grazing) is no contact, one by more than eps
/// is always found, one in between may be either.
///
/// From an overlapping start all this holds with the largest d at the moments that were looked at
/// in the place of the largest d so far: overlap that shrinks and grows again between two of them
/// may pass. What is certain is that d falls nowhere before the returned time more than eps below
/// what it was at the start; after the first 1000 intervals more than eps, or a tenth of the
/// overlap that was left where an interval began, below the level there (so the work of an overlap
/// that shrinks does not grow with 1/eps). Where a look finds it below the level, its largest value
/// in the last two such intervals becomes the level.
///
/// Method: conservative advancement with two certificates that an interval [t0, t1] is free. One
/// from the speed bound L: d >= (d(t0) + d(t1) - L (t1 - t0)) / 2. One along a fixed direction n
/// (the contact normal at either end) in which the shapes' separation is s_n <= d:
///
///     s_n(t) >= min(s_n(t0), s_n(t1)) - sum of deviation over both shapes,
///     deviation = b_x + (L_x h - |x1 - x0|) + r (|n x a| phi^2/8 + 1.1 (b_phi + W h - phi)),
///     b_x = 1/2 sqrt((L_x h)^2 - |x1 - x0|^2), b_phi = 1/2 sqrt((W h)^2 - phi^2),
///
/// h = t1 - t0, L_x and W the speed bounds, phi and a the angle turned and its axis, r the radius
/// that turns: how far a point of the shape can be from the straight line between its two ends. For
/// motions whose bounds are tight (constant velocities) it is second order in h, so that shapes
/// that slide, roll or rest on each other are passed in few steps. After 100000 intervals (bounds
/// that are loose, or shapes that stay within eps of each other while they move far) the rest is
/// searched at 1000 further samples only, between which a dip may pass.
///
/// Two half-spaces: none. @throws std::invalid_argument: bad shape, pose, duration (finite, >= 0)
/// or speed bound (finite, >= 0).
[[nodiscard]] std::optional<double> contact_time(const MovingShape& a, const MovingShape& b,
                                                 double duration);
[[nodiscard]] std::optional<double> contact_time(const Shape& a, const Motion& motion_a,
                                                 const Shape& b, const Motion& motion_b,
                                                 double duration);

}  // namespace signorini::collision
