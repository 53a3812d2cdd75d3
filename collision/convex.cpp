#include <signorini/collision/convex.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace signorini::collision {
namespace {

/// The part of n across the axis, across it to rounding of its own length.
Vec3 across(const Vec3& n, const Vec3& axis) {
  const Vec3 out = n - n.dot(axis) * axis;
  return out - out.dot(axis) * axis;
}

}  // namespace

Vec3 Stratum::point(const Vec3& n) const {
  if (kind == Kind::kRim) {
    return anchor + radius * across(n, axis).normalized();
  }
  if (kind == Kind::kEllipsoid) {
    const Vec3 gradient = moment * n;
    return anchor + gradient / std::sqrt(n.dot(gradient));
  }
  return anchor;
}

Mat3 Stratum::radii(const Vec3& n) const {
  if (kind == Kind::kRim) {
    const Vec3 out = across(n, axis);
    const Vec3 t = axis.cross(out).normalized();
    return radius / out.norm() * t * t.transpose();
  }
  if (kind == Kind::kEllipsoid) {
    const Vec3 gradient = moment * n;
    const double squared = n.dot(gradient);
    return (moment - gradient * gradient.transpose() / squared) / std::sqrt(squared);
  }
  return Mat3::Zero();
}

Vec3 Stratum::direction(const Vec3& n) const {
  return slope == 0.0 ? axis : Vec3((axis - slope * n).normalized());
}

LocalSurface Stratum::surface(const Vec3& n, const Vec3& core_point, double rounding) const {
  constexpr double kFlat = std::numeric_limits<double>::infinity();
  switch (kind) {
    case Kind::kVertex: return {Vec3::UnitX(), rounding, rounding};
    case Kind::kFace: return LocalSurface::face();
    case Kind::kRim: {
      const Vec3 out = across(n, axis);
      return {axis.cross(out).normalized(), radius / out.norm() + rounding, rounding};
    }
    case Kind::kLine: {
      // A cone: the distance from the apex times the tangent of half its angle.
      const double tangent = slope / std::sqrt((1.0 - slope) * (1.0 + slope));
      const double curved = radius + std::abs((core_point - anchor).dot(direction(n)) * tangent);
      return {direction(n), kFlat, curved + rounding};
    }
    case Kind::kEllipsoid: {
      Eigen::Matrix<double, 3, 2> tangents;
      tangents.col(0) = n.unitOrthogonal();
      tangents.col(1) = n.cross(tangents.col(0));
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal;
      principal.computeDirect(tangents.transpose() * radii(n) * tangents);
      const Vec3 direction = (tangents * principal.eigenvectors().col(0)).normalized();
      return {direction, principal.eigenvalues()[0] + rounding,
              principal.eigenvalues()[1] + rounding};
    }
  }
  return {};
}

}  // namespace signorini::collision
