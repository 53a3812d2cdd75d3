#include <signorini/core/model/unconstrained_motion.h>
#include <signorini/core/response/segment_motion.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace signorini {

SegmentMotion::SegmentMotion(const Body& body, const BodyState& start, const Wrench& load)
    : body_(body), start_(start), load_(load) {
  if (body.is_dynamic()) {
    const Eigen::SelfAdjointEigenSolver<Mat3> moments(body.inertia, Eigen::EigenvaluesOnly);
    largest_inverse_inertia_ = 1.0 / moments.eigenvalues()[0];
  }
}

BodyState SegmentMotion::state(double t) const {
  BodyState moved = start_;
  if (!body_.is_dynamic()) {
    integrate_free(body_, Vec3::Zero(), Vec3::Zero(), t, Integrator::kEnergyMomentum, moved);
    return moved;
  }
  integrate_free(body_, load_.force, load_.torque, t, Integrator::kEnergyMomentum, moved);
  moved.x = start_.x + t / body_.mass * (start_.p + 0.5 * t * load_.force);
  return moved;
}

SpeedBound SegmentMotion::speed_bound(double t0, double t1) const {
  if (!body_.is_dynamic()) {
    const Velocity v = velocity(body_, start_);
    return {v.linear.norm(), v.angular.norm()};
  }
  const auto speed = [this](double t) { return (start_.p + t * load_.force).norm() / body_.mass; };
  const double L = std::max(start_.L.norm(), (start_.L + t1 * load_.torque).norm());
  const double fastest = L * largest_inverse_inertia_;
  const double change = (load_.torque.norm() + fastest * L) * largest_inverse_inertia_;
  const double w = velocity(body_, start_).angular.norm();
  return {std::max(speed(t0), speed(t1)), std::min(fastest, w + t1 * change)};
}

}  // namespace signorini
