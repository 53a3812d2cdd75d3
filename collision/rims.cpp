#include <signorini/collision/rims.h>

#include <Eigen/Dense>
#include <cmath>

namespace signorini::collision {
namespace {

/// A circle by angle.
struct Circle {
  Vec3 centre;
  Vec3 u;  ///< u, v: in its plane, as long as its radius
  Vec3 v;

  explicit Circle(const Stratum& rim)
      : centre(rim.anchor), u(rim.radius * rim.axis.unitOrthogonal()), v(rim.axis.cross(u)) {}
  [[nodiscard]] Vec3 out(double angle) const { return std::cos(angle) * u + std::sin(angle) * v; }
  [[nodiscard]] Vec3 along(double angle) const { return std::cos(angle) * v - std::sin(angle) * u; }
  [[nodiscard]] double angle_of(const Vec3& point) const {
    return std::atan2(v.dot(point - centre), u.dot(point - centre));
  }
};

/// Newton from two angles; P_A - P_B, or zero.
Vec3 between_nearest(const Circle& a, const Circle& b, double angle_a, double angle_b) {
  constexpr int kSteps = 20;
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 out_a = a.out(angle_a);
    const Vec3 out_b = b.out(angle_b);
    const Vec3 W = a.centre + out_a - (b.centre + out_b);
    const Vec3 along_a = a.along(angle_a);
    const Vec3 along_b = b.along(angle_b);
    Eigen::Matrix2d H;
    H << along_a.squaredNorm() - W.dot(out_a), -along_a.dot(along_b), -along_a.dot(along_b),
        along_b.squaredNorm() + W.dot(out_b);
    const Eigen::LLT<Eigen::Matrix2d> factor(H);
    if (factor.info() != Eigen::Success) {
      return Vec3::Zero();
    }
    const Eigen::Vector2d step = factor.solve(Eigen::Vector2d(-W.dot(along_a), W.dot(along_b)));
    if (!(step.norm() <= 1.0)) {
      return Vec3::Zero();
    }
    angle_a += step[0];
    angle_b += step[1];
    if (step.norm() <= 1e-15) {
      break;
    }
  }
  return a.centre + a.out(angle_a) - (b.centre + b.out(angle_b));
}

}  // namespace

RimDirections crossing_rims(const Stratum& a, const Stratum& b, const Vec3& n) {
  RimDirections result;
  const Circle circle_a(a);
  const Circle circle_b(b);
  const Vec3 apart = b.anchor - a.anchor;
  const Vec3 aside = apart - apart.dot(n) * n;
  const double distance = aside.norm();
  const double along = 0.5 * (distance + (a.radius - b.radius) * (a.radius + b.radius) / distance);
  const double squared = (a.radius - along) * (a.radius + along);
  if (!(squared >= 0.0)) {
    return result;
  }
  const Vec3 middle = a.anchor + along / distance * aside;
  const Vec3 half = std::sqrt(squared) / distance * n.cross(aside);
  for (const Vec3& crossing : {Vec3(middle + half), Vec3(middle - half)}) {
    const Vec3 W = between_nearest(circle_a, circle_b, circle_a.angle_of(crossing),
                                   circle_b.angle_of(crossing));
    if (W.dot(n) > 0.0) {
      result.normals[result.count++] = W.normalized();
    }
  }
  return result;
}

}  // namespace signorini::collision
