#include <signorini/collision/hull.h>
#include <signorini/collision/shape.h>
#include <signorini/core/model/number_text.h>

#include <cmath>
#include <stdexcept>

namespace signorini::collision {
namespace {

constexpr double kUnitTolerance = 1e-6;

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
  void operator()(const Capsule& capsule) const {
    require_positive("capsule: radius", capsule.radius);
    require_positive("capsule: half_length", capsule.half_length);
  }
  void operator()(const Cylinder& cylinder) const {
    require_positive("cylinder: radius", cylinder.radius);
    require_positive("cylinder: half_length", cylinder.half_length);
  }
  void operator()(const Cone& cone) const {
    require_positive("cone: radius", cone.radius);
    require_positive("cone: half_height", cone.half_height);
  }
  void operator()(const Ellipsoid& ellipsoid) const {
    require_positive("ellipsoid: radii.x", ellipsoid.radii.x());
    require_positive("ellipsoid: radii.y", ellipsoid.radii.y());
    require_positive("ellipsoid: radii.z", ellipsoid.radii.z());
  }
  void operator()(const ConvexHull& hull) const {
    if (hull.data == nullptr) {
      throw std::invalid_argument("hull: data: must not be null");
    }
  }
  void operator()(const HalfSpace&) const {}
  void operator()(const TriangleMesh& mesh) const {
    if (mesh.data == nullptr) {
      throw std::invalid_argument("mesh: data: must not be null");
    }
  }
  void operator()(const Compound& compound) const {
    if (compound.data == nullptr) {
      throw std::invalid_argument("compound: data: must not be null");
    }
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
    if (!collider.friction_direction.allFinite()) {
      throw std::invalid_argument("friction_direction: must be finite, got " +
                                  number_text(collider.friction_direction));
    }
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("collider '" + collider.name + "': " + error.what());
  }
}

}  // namespace signorini::collision
