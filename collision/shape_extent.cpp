#include <signorini/collision/compound.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/collision/shape.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::collision {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Radius {
  const Pose& pose;

  /// The frame's origin seen from the shape.
  [[nodiscard]] Vec3 local() const { return pose.orientation.conjugate() * pose.position; }

  double operator()(const Sphere& sphere) const { return pose.position.norm() + sphere.radius; }
  double operator()(const Box& box) const { return (local().cwiseAbs() + box.half_extents).norm(); }
  double operator()(const Capsule& capsule) const {
    const Vec3 c = local();
    return std::hypot(c.head<2>().norm(), std::abs(c.z()) + capsule.half_length) + capsule.radius;
  }
  double operator()(const Cylinder& cylinder) const {
    const Vec3 c = local();
    return std::hypot(c.head<2>().norm() + cylinder.radius, std::abs(c.z()) + cylinder.half_length);
  }
  double operator()(const Cone& cone) const {
    const Vec3 c = local();
    const double across = c.head<2>().norm();
    return std::max(std::hypot(across, c.z() + cone.half_height),
                    std::hypot(across + cone.radius, c.z() - cone.half_height));
  }
  double operator()(const Ellipsoid& ellipsoid) const {
    return pose.position.norm() + ellipsoid.radii.maxCoeff();
  }
  double operator()(const ConvexHull& hull) const {
    const Vec3 c = local();
    double squared = 0.0;
    for (const Vec3& vertex : hull.data->vertices) {
      squared = std::max(squared, (c + vertex).squaredNorm());
    }
    return std::sqrt(squared);
  }
  double operator()(const HalfSpace&) const { return kInfinity; }
  double operator()(const TriangleMesh& mesh) const {
    return pose.position.norm() + mesh.data->radius;
  }
  double operator()(const Compound& compound) const {
    return pose.position.norm() + compound.data->radius;
  }
};

/// The support function in the shape's frame.
struct Support {
  const Vec3& n;

  double operator()(const Sphere& sphere) const { return sphere.radius * n.norm(); }
  double operator()(const Box& box) const { return n.cwiseAbs().dot(box.half_extents); }
  double operator()(const Capsule& capsule) const {
    return std::abs(n.z()) * capsule.half_length + capsule.radius * n.norm();
  }
  double operator()(const Cylinder& cylinder) const {
    return std::abs(n.z()) * cylinder.half_length + cylinder.radius * n.head<2>().norm();
  }
  double operator()(const Cone& cone) const {
    return std::max(n.z() * cone.half_height,
                    cone.radius * n.head<2>().norm() - n.z() * cone.half_height);
  }
  double operator()(const Ellipsoid& ellipsoid) const {
    return n.cwiseProduct(ellipsoid.radii).norm();
  }
  double operator()(const ConvexHull& hull) const {
    double highest = -kInfinity;
    for (const Vec3& vertex : hull.data->vertices) {
      highest = std::max(highest, n.dot(vertex));
    }
    return highest;
  }
  double operator()(const HalfSpace&) const {
    constexpr double kParallel = 1e-12;
    return (Vec3::UnitZ() - n).norm() <= kParallel ? 0.0 : kInfinity;
  }
  double operator()(const TriangleMesh& mesh) const {
    double highest = -kInfinity;
    for (const Vec3& vertex : mesh.data->vertices) {
      highest = std::max(highest, n.dot(vertex));
    }
    return highest;
  }
  double operator()(const Compound& compound) const {
    double highest = -kInfinity;
    for (const CompoundPart& part : compound.data->parts) {
      highest = std::max(highest, support(part.shape, part.local, n));
    }
    return highest;
  }
};

}  // namespace

double bounding_radius(const Shape& shape, const Pose& pose) {
  return std::visit(Radius{pose}, shape);
}

double support(const Shape& shape, const Pose& pose, const Vec3& n) {
  return n.dot(pose.position) + std::visit(Support{pose.orientation.conjugate() * n}, shape);
}

Bounds bounds(const Shape& shape, const Pose& pose) {
  if (std::holds_alternative<HalfSpace>(shape)) {
    return {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};
  }
  const Mat3 axes = pose.orientation.toRotationMatrix();
  if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
    const Bounds& own = mesh->data->tree.all();
    const Vec3 centre = pose * Vec3(0.5 * (own.low + own.high));
    const Vec3 half = axes.cwiseAbs() * (0.5 * (own.high - own.low));
    return {centre - half, centre + half};
  }
  Bounds result;
  for (int k = 0; k < 3; ++k) {
    const Vec3 n = axes.row(k);
    result.high[k] = pose.position[k] + std::visit(Support{n}, shape);
    result.low[k] = pose.position[k] - std::visit(Support{-n}, shape);
  }
  return result;
}

}  // namespace signorini::collision
