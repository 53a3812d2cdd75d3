#include "reference_distance.h"

#include <Eigen/QR>
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

/// min |c + D x| over the x whose coordinates k are -half, +half or free as the digits 0, 1, 2 of
/// `pattern` to base 3 say; the free ones put back into their bounds, so that it is never below the
/// minimum over the box.
double value_of_pattern(const Matrix36& D, const Vec3& c, const Vector6& half, int pattern) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> free_columns(3, 0);
  std::array<int, 3> free_index{};
  Vec3 fixed = c;
  for (int k = 0; k < 6; ++k, pattern /= 3) {
    if (pattern % 3 == 2) {
      free_index[free_columns.cols()] = k;
      free_columns.conservativeResize(3, free_columns.cols() + 1);
      free_columns.rightCols<1>() = D.col(k);
    } else {
      fixed += (pattern % 3 == 0 ? -half[k] : half[k]) * D.col(k);
    }
  }
  if (free_columns.cols() > 0) {
    const Eigen::VectorXd x = free_columns.colPivHouseholderQr().solve(-fixed);
    for (int i = 0; i < x.size(); ++i) {
      const double bound = half[free_index[i]];
      fixed += std::clamp(x[i], -bound, bound) * free_columns.col(i);
    }
  }
  return fixed.norm();
}

int free_count(int pattern) {
  int count = 0;
  for (int k = 0; k < 6; ++k, pattern /= 3) {
    count += pattern % 3 == 2;
  }
  return count;
}

}  // namespace

double reference_box_distance(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  Matrix36 D;
  D << pose_a.orientation.toRotationMatrix(), -pose_b.orientation.toRotationMatrix();
  Vector6 half;
  half << a.half_extents, b.half_extents;
  double least = std::numeric_limits<double>::infinity();
  for (int pattern = 0; pattern < 729; ++pattern) {
    if (free_count(pattern) <= 3) {
      least =
          std::min(least, value_of_pattern(D, pose_a.position - pose_b.position, half, pattern));
    }
  }
  return least;
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
