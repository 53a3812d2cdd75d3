#include "random_pairs.h"

#include <signorini/collision/hull.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace signorini::collision::testing {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Shape random_shape(Random& random, ShapeKind kind, double scale) {
  switch (kind) {
    case ShapeKind::kSphere: return Sphere{scale};
    case ShapeKind::kBox: {
      if (uniform(random, 0.0, 1.0) < 0.3) {
        return Box{Vec3::Constant(scale)};
      }
      return Box{scale * Vec3(log_uniform(random, -1.5, 0.0), log_uniform(random, -1.5, 0.0), 1.0)};
    }
    case ShapeKind::kCapsule: return Capsule{scale * log_uniform(random, -1.5, 0.0), scale};
    case ShapeKind::kCylinder:
      return Cylinder{scale * log_uniform(random, -1.0, 0.0),
                      scale * log_uniform(random, -1.0, 0.0)};
    case ShapeKind::kCone:
      return Cone{scale * log_uniform(random, -1.0, 0.0), scale * log_uniform(random, -1.0, 0.0)};
    case ShapeKind::kEllipsoid:
      return Ellipsoid{scale *
                       Vec3(log_uniform(random, -1.0, 0.0), log_uniform(random, -1.0, 0.0), 1.0)};
    case ShapeKind::kHull: return random_hull(random, scale);
    case ShapeKind::kHalfSpace: return HalfSpace{};
  }
  return Sphere{};
}

Quat aligned_orientation(Random& random) {
  std::uniform_int_distribution<int> quarter(0, 3);
  const auto turn = [&](const Vec3& axis) {
    return Quat(Eigen::AngleAxisd(quarter(random) * M_PI_2, axis));
  };
  Quat result = turn(Vec3::UnitX()) * turn(Vec3::UnitY()) * turn(Vec3::UnitZ());
  if (uniform(random, 0.0, 1.0) < 0.3) {
    result = Quat(Eigen::AngleAxisd(uniform(random, 0.0, M_PI), Vec3::UnitZ())) * result;
  }
  return result.normalized();
}

Quat orientation(Random& random, Placement placement) {
  switch (placement) {
    case Placement::kAnywhere: return random_orientation(random);
    case Placement::kAligned: return aligned_orientation(random);
    case Placement::kNearlyAligned:
      return (Quat(Eigen::AngleAxisd(log_uniform(random, -15.0, -3.0), random_direction(random))) *
              aligned_orientation(random))
          .normalized();
  }
  return Quat::Identity();
}

double extent(const Shape& shape) {
  return std::holds_alternative<HalfSpace>(shape) ? 0.0 : bounding_radius(shape, Pose{});
}

}  // namespace

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double log_uniform(Random& random, double low_exponent, double high_exponent) {
  return std::pow(10.0, uniform(random, low_exponent, high_exponent));
}

Vec3 random_direction(Random& random) {
  std::normal_distribution<double> normal;
  Vec3 v;
  do {
    v = Vec3(normal(random), normal(random), normal(random));
  } while (v.norm() < 1e-3);
  return v.normalized();
}

Quat random_orientation(Random& random) {
  std::normal_distribution<double> normal;
  Quat q;
  do {
    q.coeffs() = Eigen::Vector4d(normal(random), normal(random), normal(random), normal(random));
  } while (q.norm() < 1e-3);
  return q.normalized();
}

ConvexHull random_hull(Random& random, double scale) {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;
  const double kind = uniform(random, 0.0, 3.0);
  if (kind < 1.0) {
    points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  } else if (kind < 2.0) {
    points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    faces = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4},
             {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  } else {
    faces.resize(2);
    for (int k = 0; k < 8; ++k) {
      const double angle = k * M_PI_4;
      points.emplace_back(std::cos(angle), std::sin(angle), -1.0);
      points.emplace_back(std::cos(angle), std::sin(angle), 1.0);
      faces[0].push_back(2 * (7 - k));
      faces[1].push_back(2 * k + 1);
      const int next = (k + 1) % 8;
      faces.push_back({2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
    }
  }
  const Vec3 stretch(log_uniform(random, -1.0, 0.0), log_uniform(random, -1.0, 0.0), 1.0);
  const Vec3 shift = 0.2 * random_direction(random);
  const bool is_turned = uniform(random, 0.0, 1.0) < 0.5;
  const Mat3 turn = is_turned ? random_orientation(random).toRotationMatrix() : Mat3::Identity();
  for (Vec3& point : points) {
    point = scale * (turn * stretch.cwiseProduct(point) + shift);
  }
  return make_hull(points, faces);
}

PlacedPair random_pair(Random& random, ShapeKind a, ShapeKind b, Placement placement) {
  PlacedPair pair;
  const bool plain = uniform(random, 0.0, 1.0) < 0.5;
  const double scale_a = plain ? uniform(random, 0.3, 2.0) : log_uniform(random, -3.0, 3.0);
  const double ratio = plain ? uniform(random, 0.3, 3.0) : log_uniform(random, -3.0, 3.0);
  pair.a = random_shape(random, a, scale_a);
  pair.b = random_shape(random, b, std::clamp(scale_a * ratio, 1e-3, 1e3));
  if (a == b && uniform(random, 0.0, 1.0) < 0.1) {
    pair.b = pair.a;
  }
  const double reach = extent(pair.a) + extent(pair.b);
  const double far = uniform(random, 0.0, 1.0) < 0.7 ? reach : log_uniform(random, 0.0, 6.0);
  const Pose frame{far * random_direction(random), Quat::Identity()};
  pair.pose_b = {frame.position, orientation(random, placement)};
  const double spread = std::holds_alternative<HalfSpace>(pair.b) ? 2.0 : 1.5;
  pair.pose_a = {
      frame.position + spread * reach * uniform(random, 0.0, 1.0) * random_direction(random),
      orientation(random, placement)};
  const double extent_a = extent(pair.a);
  const double extent_b = extent(pair.b);
  pair.size =
      extent_a == 0.0 ? extent_b : (extent_b == 0.0 ? extent_a : std::min(extent_a, extent_b));
  pair.rounding = kEpsilon * (reach + far);
  return pair;
}

PlacedPair moved(const PlacedPair& pair, const Vec3& offset) {
  PlacedPair result = pair;
  result.pose_a.position += offset;
  return result;
}

PlacedPair exchanged(const PlacedPair& pair) {
  return {pair.b, pair.pose_b, pair.a, pair.pose_a, pair.size, pair.rounding};
}

PlacedPair carried(const PlacedPair& pair, const Pose& motion) {
  PlacedPair result = pair;
  result.pose_a = motion * pair.pose_a;
  result.pose_b = motion * pair.pose_b;
  return result;
}

namespace {

struct Describe {
  std::ostream& out;

  void operator()(const Sphere& sphere) const { out << "sphere " << sphere.radius; }
  void operator()(const Box& box) const { out << "box " << box.half_extents.transpose(); }
  void operator()(const Capsule& capsule) const {
    out << "capsule " << capsule.radius << " " << capsule.half_length;
  }
  void operator()(const Cylinder& cylinder) const {
    out << "cylinder " << cylinder.radius << " " << cylinder.half_length;
  }
  void operator()(const Cone& cone) const {
    out << "cone " << cone.radius << " " << cone.half_height;
  }
  void operator()(const Ellipsoid& ellipsoid) const {
    out << "ellipsoid " << ellipsoid.radii.transpose();
  }
  void operator()(const ConvexHull& hull) const {
    out << "hull";
    for (const Vec3& vertex : hull.data->vertices) {
      out << " (" << vertex.transpose() << ")";
    }
  }
  void operator()(const HalfSpace&) const { out << "half-space"; }
  void operator()(const auto&) const {}  // meshes, compounds: not here
};

void describe(std::ostream& out, const Shape& shape, const Pose& pose) {
  std::visit(Describe{out}, shape);
  out << " at " << pose.position.transpose() << ", q (x y z w) "
      << pose.orientation.coeffs().transpose() << "\n";
}

}  // namespace

std::string describe(const PlacedPair& pair) {
  std::ostringstream out;
  out.precision(17);
  describe(out, pair.a, pair.pose_a);
  describe(out, pair.b, pair.pose_b);
  return out.str();
}

}  // namespace signorini::collision::testing
