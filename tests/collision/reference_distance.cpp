#include "reference_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace signorini::collision::testing {
namespace {

using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

std::array<Vec3, 8> vertices(const Box& box, const Pose& pose) {
  std::array<Vec3, 8> result;
  for (int k = 0; k < 8; ++k) {
    const Vec3 signs(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0);
    result[k] = pose * box.half_extents.cwiseProduct(signs);
  }
  return result;
}

/// Projected gradient with Nesterov's acceleration, restarted when the value rises.
double minimise(const Matrix36& D, const Vec3& c, const Vector6& half) {
  const double lipschitz = (D * D.transpose()).trace();
  Vector6 x = Vector6::Zero();
  Vector6 y = x;
  double momentum = 1.0;
  double value = c.squaredNorm();
  for (int k = 0; k < 20000; ++k) {
    const Vector6 next =
        (y - D.transpose() * (c + D * y) / lipschitz).cwiseMax(-half).cwiseMin(half);
    const double next_value = (c + D * next).squaredNorm();
    if (next_value > value) {
      momentum = 1.0;
      y = x;
      continue;
    }
    const double next_momentum = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    y = next + (momentum - 1.0) / next_momentum * (next - x);
    const bool still = (next - x).norm() <= 1e-15 * half.norm();
    x = next;
    value = next_value;
    momentum = next_momentum;
    if (still) {
      break;
    }
  }
  return std::sqrt(value);
}

}  // namespace

double reference_box_distance(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  Matrix36 D;
  D << pose_a.orientation.toRotationMatrix(), -pose_b.orientation.toRotationMatrix();
  Vector6 half;
  half << a.half_extents, b.half_extents;
  return minimise(D, pose_a.position - pose_b.position, half);
}

double reference_box_depth(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  const auto of_a = vertices(a, {pose_a.position - pose_b.position, pose_a.orientation});
  const auto of_b = vertices(b, {Vec3::Zero(), pose_b.orientation});
  std::array<Vec3, 64> points;
  for (int i = 0; i < 64; ++i) {
    points[i] = of_a[i / 8] - of_b[i % 8];
  }
  const double size = a.half_extents.norm() + b.half_extents.norm();
  double depth = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < i; ++j) {
      for (int k = 0; k < j; ++k) {
        Vec3 n = (points[j] - points[i]).cross(points[k] - points[i]);
        if (n.norm() <= 1e-9 * size * size) {
          continue;
        }
        n.normalize();
        double low = 0.0;
        double high = 0.0;
        for (const Vec3& p : points) {
          const double over = n.dot(p - points[i]);
          low = std::min(low, over);
          high = std::max(high, over);
        }
        if (low >= -1e-9 * size || high <= 1e-9 * size) {
          depth = std::min(depth, std::abs(n.dot(points[i])));
        }
      }
    }
  }
  return depth;
}

}  // namespace signorini::collision::testing
