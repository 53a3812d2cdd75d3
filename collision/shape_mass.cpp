#include <signorini/collision/compound.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/shape.h>
#include <signorini/core/model/number_text.h>

#include <cmath>
#include <stdexcept>

namespace signorini::collision {
namespace {

/// A diagonal inertia from the squares of three lengths: factor (y + z, z + x, x + y).
Mat3 from_squares(double factor, const Vec3& square) {
  const Vec3 moments(square.y() + square.z(), square.z() + square.x(), square.x() + square.y());
  return Mat3((factor * moments).asDiagonal());
}

Mat3 round_about_z(double across, double axial) {
  return Mat3(Vec3(across, across, axial).asDiagonal());
}

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
    return {mass, from_squares(mass / 12.0, edge.cwiseAbs2())};
  }
  MassProperties operator()(const Capsule& capsule) const {
    const double r = capsule.radius;
    const double h = capsule.half_length;
    const double barrel = density * M_PI * r * r * 2.0 * h;
    const double ends = density * 4.0 / 3.0 * M_PI * r * r * r;
    const double axial = 0.5 * barrel * r * r + 0.4 * ends * r * r;
    const double across =
        barrel * (r * r / 4.0 + h * h / 3.0) + ends * (0.4 * r * r + h * h + 0.75 * h * r);
    return {barrel + ends, round_about_z(across, axial)};
  }
  MassProperties operator()(const Cylinder& cylinder) const {
    const double r = cylinder.radius;
    const double h = cylinder.half_length;
    const double mass = density * M_PI * r * r * 2.0 * h;
    return {mass, round_about_z(mass * (r * r / 4.0 + h * h / 3.0), 0.5 * mass * r * r)};
  }
  MassProperties operator()(const Cone& cone) const {
    const double r = cone.radius;
    const double height = 2.0 * cone.half_height;
    const double mass = density * M_PI * r * r * height / 3.0;
    return {mass,
            round_about_z(3.0 / 80.0 * mass * (4.0 * r * r + height * height), 0.3 * mass * r * r),
            Vec3(0.0, 0.0, -0.25 * height)};
  }
  MassProperties operator()(const Ellipsoid& ellipsoid) const {
    const double mass = density * 4.0 / 3.0 * M_PI * ellipsoid.radii.prod();
    return {mass, from_squares(mass / 5.0, ellipsoid.radii.cwiseAbs2())};
  }
  MassProperties operator()(const ConvexHull& hull) const {
    const Mat3& moment = hull.data->second_moment;
    return {density * hull.data->volume, density * (moment.trace() * Mat3::Identity() - moment),
            hull.data->centre};
  }
  MassProperties operator()(const HalfSpace&) const {
    throw std::invalid_argument("half-space: mass: it has no finite mass");
  }
  MassProperties operator()(const TriangleMesh&) const {
    throw std::invalid_argument("mesh: mass: a surface has no volume");
  }
  MassProperties operator()(const Compound& compound) const {
    MassProperties sum{0.0, Mat3::Zero(), Vec3::Zero()};
    Mat3 about_origin = Mat3::Zero();
    const auto of_point = [](double mass, const Vec3& x) {
      return Mat3(mass * (x.squaredNorm() * Mat3::Identity() - x * x.transpose()));
    };
    for (const CompoundPart& part : compound.data->parts) {
      const MassProperties one = std::visit(*this, part.shape);
      const Vec3 centre = part.local * one.centre;
      const Mat3 axes = part.local.orientation.toRotationMatrix();
      sum.mass += one.mass;
      sum.centre += one.mass * centre;
      about_origin += axes * one.inertia * axes.transpose() + of_point(one.mass, centre);
    }
    sum.centre /= sum.mass;
    sum.inertia = about_origin - of_point(sum.mass, sum.centre);
    return sum;
  }
};

}  // namespace

MassProperties mass_properties(const Shape& shape, double density) {
  validate(shape);
  if (!(density > 0.0) || !std::isfinite(density)) {
    throw std::invalid_argument("density: must be finite and > 0, got " + number_text(density));
  }
  return std::visit(Mass{density}, shape);
}

}  // namespace signorini::collision
