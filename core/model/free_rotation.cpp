#include <signorini/core/model/free_rotation.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace signorini {
namespace {

constexpr int kMostIterations = 20;

/// Pi_m of one midpoint step by Newton's method.
Vec3 midpoint(const Mat3& inverse_inertia, const Vec3& Pi, double h) {
  const double enough = 2.0 * std::numeric_limits<double>::epsilon() * Pi.norm();
  Vec3 middle = Pi + 0.5 * h * Pi.cross(inverse_inertia * Pi);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Vec3 w = inverse_inertia * middle;
    const Vec3 residual = middle - Pi - 0.5 * h * middle.cross(w);
    if (!(residual.norm() > enough)) {
      break;
    }
    const Mat3 slope = Mat3::Identity() - 0.5 * h * (skew(middle) * inverse_inertia - skew(w));
    middle -= slope.inverse() * residual;
  }
  return middle;
}

}  // namespace

Quat free_rotation(const Mat3& inertia, const Vec3& Pi, double step) {
  static const double a = 1.0 / (4.0 - std::cbrt(4.0));
  static const std::array<double, 5> lengths{a, a, 1.0 - 4.0 * a, a, a};
  const Mat3 inverse_inertia = inertia.inverse();
  // |w| <= |Pi| / J_min at any time.
  const double turn = step * Pi.norm() * inverse_inertia.norm();
  const double parts = std::clamp(std::ceil(turn / kMostTurn), 1.0, kMostParts);
  Quat rotation = Quat::Identity();
  Vec3 now = Pi;
  for (int part = 0; part < static_cast<int>(parts); ++part) {
    for (const double length : lengths) {
      const double h = length * step / parts;
      const Vec3 half = 0.5 * h * (inverse_inertia * midpoint(inverse_inertia, now, h));
      const Quat turned = Quat(1.0, half.x(), half.y(), half.z()).normalized();
      now = turned.conjugate() * now;
      rotation = rotation * turned;
    }
  }
  return rotation.normalized();
}

}  // namespace signorini
