#include <signorini/collision/shape.h>
#include <signorini/core/model/number_text.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace signorini::collision {
namespace {

constexpr double kUnitTolerance = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void require_positive(const char* field, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(field) + ": must be finite and > 0, got " +
                                number_text(value));
  }
}

struct Validate {
  void operator()(const Sphere& sphere) const { require_positive("sphere: radius", sphere.radius); }
  void operator()(const Box& box) const {
    require_positive("box: half_extents.x", box.half_extents.x());
    require_positive("box: half_extents.y", box.half_extents.y());
    require_positive("box: half_extents.z", box.half_extents.z());
  }
  void operator()(const HalfSpace&) const {}
};

struct Mass {
  double density;

  MassProperties operator()(const Sphere& sphere) const {
    const double r = sphere.radius;
    const double mass = density * 4.0 / 3.0 * M_PI * r * r * r;
    return {mass, Mat3::Identity() * (0.4 * mass * r * r)};
  }
  MassProperties operator()(const Box& box) const {
    const Vec3 edge = 2.0 * box.half_extents;
    const double mass = density * edge.prod();
    const Vec3 square = edge.cwiseAbs2();
    const Vec3 moments(square.y() + square.z(), square.z() + square.x(), square.x() + square.y());
    return {mass, Mat3((mass / 12.0 * moments).asDiagonal())};
  }
  MassProperties operator()(const HalfSpace&) const {
    throw std::invalid_argument("half-space: mass: it has no finite mass");
  }
};

struct Radius {
  const Pose& pose;

  double operator()(const Sphere& sphere) const { return pose.position.norm() + sphere.radius; }
  double operator()(const Box& box) const {
    const Vec3 centre = (pose.orientation.conjugate() * pose.position).cwiseAbs();
    return (centre + box.half_extents).norm();
  }
  double operator()(const HalfSpace&) const { return kInfinity; }
};

struct Support {
  const Pose& pose;
  const Vec3& n;

  double operator()(const Sphere& sphere) const { return n.dot(pose.position) + sphere.radius; }
  double operator()(const Box& box) const {
    return n.dot(pose.position) +
           (pose.orientation.conjugate() * n).cwiseAbs().dot(box.half_extents);
  }
  double operator()(const HalfSpace&) const {
    constexpr double kParallel = 1e-12;
    const bool is_normal = (pose.orientation * Vec3::UnitZ() - n).norm() <= kParallel;
    return is_normal ? n.dot(pose.position) : kInfinity;
  }
};

}  // namespace

void validate(const Shape& shape) {
  std::visit(Validate{}, shape);
}

void validate(const Pose& pose) {
  if (!pose.position.allFinite()) {
    throw std::invalid_argument("pose: position: must be finite, got " +
                                number_text(pose.position) + " m");
  }
  const double norm = pose.orientation.coeffs().norm();
  if (!(std::abs(norm - 1.0) <= kUnitTolerance)) {
    throw std::invalid_argument(
        "pose: orientation: must be a unit quaternion to 1e-6, its norm is " + number_text(norm));
  }
}

void validate(const Collider& collider, int body_count) {
  try {
    if (collider.body < 0 || collider.body >= body_count) {
      throw std::invalid_argument("body: must be in [0, " + std::to_string(body_count) + "), got " +
                                  std::to_string(collider.body));
    }
    validate(collider.shape);
    validate(collider.local);
    validate(collider.material);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("collider '" + collider.name + "': " + error.what());
  }
}

MassProperties mass_properties(const Shape& shape, double density) {
  validate(shape);
  require_positive("density", density);
  return std::visit(Mass{density}, shape);
}

double bounding_radius(const Shape& shape, const Pose& pose) {
  return std::visit(Radius{pose}, shape);
}

double support(const Shape& shape, const Pose& pose, const Vec3& n) {
  return std::visit(Support{pose, n}, shape);
}

}  // namespace signorini::collision
