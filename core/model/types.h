#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace signorini {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;  ///< unit unless said otherwise; body frame to world frame

/// Skew(w) r = w x r.
[[nodiscard]] inline Mat3 skew(const Vec3& w) {
  Mat3 s;
  s << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return s;
}

/// A frame: x_world = position + orientation * x_local. Metres.
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();

  [[nodiscard]] Vec3 operator*(const Vec3& local) const { return position + orientation * local; }
  [[nodiscard]] Pose operator*(const Pose& inner) const {
    return {position + orientation * inner.position, orientation * inner.orientation};
  }
  [[nodiscard]] Pose inverse() const {
    const Quat back = orientation.conjugate();
    return {back * -position, back};
  }
};

}  // namespace signorini
