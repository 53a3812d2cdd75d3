#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace signorini::lcp {

/// The second-order cone L = {x : |x_T| <= x_0} of three numbers x = (x_0, x_T), and what an
/// interior point method needs of it (Alizadeh, Goldfarb, Second-order cone programming, 2003;
/// Vandenberghe, The CVXOPT linear and quadratic cone program solvers, 2010, section 4). A cone in
/// the plane has x_T = (x_1, 0), and keeps the 0.
namespace second_order_cone {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// x_0^2 - |x_T|^2 without cancellation beyond that of x_0 - |x_T|.
inline double determinant(const Vector3& x) {
  const double tangential = std::hypot(x[1], x[2]);
  return (x[0] - tangential) * (x[0] + tangential);
}

/// x o y, the Jordan product.
inline Vector3 product(const Vector3& x, const Vector3& y) {
  Vector3 p = x[0] * y + y[0] * x;
  p[0] = x.dot(y);
  return p;
}

/// The y with x o y = p, x inside L.
inline Vector3 quotient(const Vector3& x, const Vector3& p) {
  Vector3 y;
  y[0] = (x[0] * p[0] - x[1] * p[1] - x[2] * p[2]) / determinant(x);
  y.tail<2>() = (p.tail<2>() - y[0] * x.tail<2>()) / x[0];
  return y;
}

/// The largest t with x + t dx in L; x inside L. Infinity if there is none.
inline double longest_step(const Vector3& x, const Vector3& dx) {
  const double root = std::sqrt(determinant(x));
  const Vector3 unit = x / root;  // and dx in its coordinates
  Vector3 y;
  y[0] = (unit[0] * dx[0] - unit[1] * dx[1] - unit[2] * dx[2]) / root;
  const double along = (y[0] + dx[0] / root) / (unit[0] + 1.0);
  y.tail<2>() = dx.tail<2>() / root - along * unit.tail<2>();
  const double least = y[0] - std::hypot(y[1], y[2]);
  return least < 0.0 ? -1.0 / least : std::numeric_limits<double>::infinity();
}

/// The symmetric W of Nesterov and Todd that makes x and v, both inside L, one point:
/// W^-1 x = W v = lambda.
class NesterovTodd {
 public:
  void set(const Vector3& x, const Vector3& v) {
    const double det_x = std::sqrt(determinant(x));
    const double det_v = std::sqrt(determinant(v));
    const Vector3 unit_x = x / det_x;
    const Vector3 unit_v = v / det_v;
    const double half = std::sqrt(0.5 + 0.5 * unit_x.dot(unit_v));
    w_[0] = (unit_x[0] + unit_v[0]) / (2.0 * half);
    w_.tail<2>() = (unit_x.tail<2>() - unit_v.tail<2>()) / (2.0 * half);
    w_[0] = std::sqrt(1.0 + w_.tail<2>().squaredNorm());
    theta_ = std::sqrt(det_x / det_v);
  }
  /// W y.
  [[nodiscard]] Vector3 times(const Vector3& y) const { return multiply(theta_, w_, y); }
  /// W^-1 y.
  [[nodiscard]] Vector3 inverse_times(const Vector3& y) const {
    return multiply(1.0 / theta_, {w_[0], -w_[1], -w_[2]}, y);
  }
  /// W^2 = theta^2 (2 w w^T - diag(1, -1, -1)).
  [[nodiscard]] Matrix3 square() const {
    const double size = theta_ * theta_;
    Matrix3 D = 2.0 * size * w_ * w_.transpose();
    D(0, 0) = size * (w_[0] * w_[0] + w_.tail<2>().squaredNorm());
    D(1, 1) += size;
    D(2, 2) += size;
    return D;
  }

 private:
  static Vector3 multiply(double theta, const Vector3& w, const Vector3& y) {
    Vector3 p;
    const double along = w[1] * y[1] + w[2] * y[2];
    p[0] = theta * (w[0] * y[0] + along);
    p.tail<2>() = theta * (y.tail<2>() + (y[0] + along / (1.0 + w[0])) * w.tail<2>());
    return p;
  }
  Vector3 w_ = Vector3::Zero();
  double theta_ = 1.0;
};

}  // namespace second_order_cone
}  // namespace signorini::lcp
