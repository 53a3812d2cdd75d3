#pragma once

#include <signorini/core/model/types.h>

namespace signorini {

/// Bounds on how fast a frame moves.
struct SpeedBound {
  double linear = 0.0;   ///< |v| of the frame's origin, m/s
  double angular = 0.0;  ///< |w|, rad/s
};

/// A pose as a function of time, and a bound on its speed: all that a contact-time query needs of a
/// stepper. The stepper hands over the motion that it will really take, so that the contact time
/// belongs to that motion and not to another one.
class Motion {
 public:
  virtual ~Motion() = default;
  /// The body frame (origin: centre of mass) at time t in [0, duration], seconds.
  [[nodiscard]] virtual Pose pose(double t) const = 0;
  /// Valid for every t in [t0, t1]. Must be a true bound, and finite; tight is fast.
  [[nodiscard]] virtual SpeedBound speed_bound(double t0, double t1) const = 0;
};

/// A frame that does not move.
class StillMotion final : public Motion {
 public:
  explicit StillMotion(const Pose& pose) : pose_(pose) {}
  [[nodiscard]] Pose pose(double) const override { return pose_; }
  [[nodiscard]] SpeedBound speed_bound(double, double) const override { return {}; }

 private:
  Pose pose_;
};

/// Constant v and constant w: x(t) = x0 + v t, q(t) = exp(w t / 2) q0 (world-frame w).
class ConstantVelocityMotion final : public Motion {
 public:
  ConstantVelocityMotion(const Pose& start, const Vec3& linear, const Vec3& angular);
  [[nodiscard]] Pose pose(double t) const override;
  [[nodiscard]] SpeedBound speed_bound(double t0, double t1) const override;

 private:
  Pose start_;
  Vec3 linear_;
  Vec3 angular_;
};

}  // namespace signorini
