#pragma once

#include <signorini/core/model/motion.h>
#include <signorini/core/response/contact_acceleration.h>

namespace signorini {

/// A body under a constant force and torque (world axes) for a while: the piece of an event-driven
/// run between two decisions.
///
///     x(t) = x0 + v0 t + F t^2/(2 m),   p(t) = p0 + F t,   L(t) = L0 + tau t,
///
/// and q(t) by one energy-momentum step of length t (unconstrained_motion.h: fourth order without
/// torque, second with). Kinematic bodies move with their velocity, fixed ones not at all.
class SegmentMotion final : public Motion {
 public:
  SegmentMotion(const Body& body, const BodyState& start, const Wrench& load);
  [[nodiscard]] BodyState state(double t) const;
  [[nodiscard]] Pose pose(double t) const override { return state(t).pose(); }
  /// |v| is convex in t: the larger of both ends. |w| <= |L|/J_min, and <= |w0| + t |w'|_max.
  [[nodiscard]] SpeedBound speed_bound(double t0, double t1) const override;

 private:
  const Body& body_;
  BodyState start_;
  Wrench load_;
  double largest_inverse_inertia_ = 0.0;  // 1/J_min
};

}  // namespace signorini
