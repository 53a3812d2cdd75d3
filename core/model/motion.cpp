#include <signorini/core/model/motion.h>

namespace signorini {

ConstantVelocityMotion::ConstantVelocityMotion(const Pose& start, const Vec3& linear,
                                               const Vec3& angular)
    : start_(start), linear_(linear), angular_(angular) {}

Pose ConstantVelocityMotion::pose(double t) const {
  const double speed = angular_.norm();
  if (speed == 0.0) {
    return {start_.position + t * linear_, start_.orientation};
  }
  const Quat turn(Eigen::AngleAxisd(speed * t, angular_ / speed));
  return {start_.position + t * linear_, (turn * start_.orientation).normalized()};
}

SpeedBound ConstantVelocityMotion::speed_bound(double, double) const {
  return {linear_.norm(), angular_.norm()};
}

}  // namespace signorini
