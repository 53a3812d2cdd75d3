#include <signorini/collision/convex_shapes.h>

#include <cmath>

namespace signorini::collision {
namespace {

using Kind = Stratum::Kind;

Stratum vertex_stratum(const Vec3& point, Feature feature) {
  Stratum stratum;
  stratum.feature = feature;
  stratum.anchor = point;
  return stratum;
}

Stratum rim_stratum(const Vec3& centre, const Vec3& axis, double radius, Feature feature) {
  Stratum stratum = vertex_stratum(centre, feature);
  stratum.kind = Kind::kRim;
  stratum.axis = axis;
  stratum.radius = radius;
  return stratum;
}

Stratum face_stratum(const Vec3& point, const Vec3& normal, double area, Feature feature) {
  Stratum stratum = vertex_stratum(point, feature);
  stratum.kind = Kind::kFace;
  stratum.axis = normal;
  stratum.area = area;
  return stratum;
}

/// n's part across the axis as a unit vector; of an n along the axis (to 1e-12), any.
Vec3 outward(const Vec3& n, const Vec3& axis) {
  constexpr double kAlong = 1e-12;
  const Vec3 out = n - n.dot(axis) * axis;
  const double length = out.norm();
  if (!(length > kAlong)) {
    return axis.unitOrthogonal();
  }
  const Vec3 unit = out / length;
  return (unit - unit.dot(axis) * axis).normalized();  // rounding grows as n nears the axis
}

FacetCorner corner(const Vec3& point, Feature feature, Feature edge, const LocalSurface& surface) {
  return {point, feature, edge, surface};
}

void disc_facet(const Vec3& centre, const Mat3& axes, double side, double radius, Feature face,
                Feature rim, Facet& facet) {
  facet.reset(face, side * axes.col(2));
  facet.disc_radius = radius;
  facet.disc_centre = centre;
  facet.rim = rim;
  const Feature upper = rim == feature::kHighRim ? 8 : 0;
  for (int k = 0; k < 8; ++k) {
    const int number = side > 0.0 ? k : 7 - k;  // counter-clockwise from outside
    const double angle = number * M_PI_4;
    const Vec3 out = std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1);
    facet.corners.push_back(
        corner(centre + radius * out, feature::kRimPoints + upper + number,
               feature::kRimChords + upper + (side > 0.0 ? number : (number + 7) % 8),
               LocalSurface::vertex()));
  }
}

}  // namespace

Vec3 PointCore::support(const Vec3&) const {
  return centre();
}

void PointCore::add_strata(const Vec3&, double, std::vector<Stratum>& strata) const {
  strata.push_back(vertex_stratum(centre(), 0));
}

void PointCore::facet(const Vec3&, Facet& facet) const {
  facet.reset(0, Vec3::Zero());
  facet.corners.push_back(corner(centre(), 0, 0, LocalSurface::sphere(rounding())));
}

Feature feature_at(const LineSegment& core, double t) {
  if (core.half == 0.0 || std::abs(t) < core.half) {
    return feature::kSide;
  }
  return t < 0.0 ? feature::kLow : feature::kHigh;
}

Stratum piece_at(const LineSegment& core, double t) {
  const Feature feature = feature_at(core, t);
  if (core.half == 0.0 || feature != feature::kSide) {
    return vertex_stratum(core.at(t), feature);
  }
  Stratum line = vertex_stratum(core.centre, feature);
  line.kind = Kind::kLine;
  line.axis = core.axis;
  line.range = {-core.half, core.half};
  line.ends = {feature::kLow, feature::kHigh};
  return line;
}

Vec3 SegmentCore::support(const Vec3& n) const {
  return core_.at(n.dot(core_.axis) < 0.0 ? -core_.half : core_.half);
}

void SegmentCore::add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const {
  const double along = n.dot(core_.axis);
  const bool sideways = std::abs(along) <= angle;
  if (sideways) {
    strata.push_back(piece_at(core_, 0.0));
  }
  if (sideways || along < 0.0) {
    strata.push_back(piece_at(core_, -core_.half));
  }
  if (sideways || along >= 0.0) {
    strata.push_back(piece_at(core_, core_.half));
  }
}

void SegmentCore::facet(const Vec3&, Facet& facet) const {
  const LocalSurface ball = LocalSurface::sphere(rounding());
  facet.reset(feature::kSide, Vec3::Zero());
  for (const double end : {-core_.half, core_.half}) {
    facet.corners.push_back(corner(core_.at(end), feature_at(core_, end), feature::kSide, ball));
  }
}

CylinderCore::CylinderCore(const Cylinder& cylinder, const Pose& pose)
    : Convex(pose.position, std::hypot(cylinder.radius, cylinder.half_length), 0.0),
      axes_(pose.orientation.toRotationMatrix()),
      radius_(cylinder.radius),
      half_(cylinder.half_length) {}

Vec3 CylinderCore::support(const Vec3& n) const {
  const Vec3 axis = axes_.col(2);
  return centre() + (n.dot(axis) < 0.0 ? -half_ : half_) * axis + radius_ * outward(n, axis);
}

void CylinderCore::add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const {
  const Vec3 axis = axes_.col(2);
  const double along = n.dot(axis);
  const bool sideways = std::abs(along) <= angle;
  if (n.cross(axis).norm() <= angle) {
    const double side = along < 0.0 ? -1.0 : 1.0;
    strata.push_back(face_stratum(centre() + side * half_ * axis, side * axis,
                                  M_PI * radius_ * radius_,
                                  along < 0.0 ? feature::kLow : feature::kHigh));
  }
  if (sideways) {
    Stratum line = rim_stratum(centre(), axis, radius_, feature::kSide);
    line.kind = Kind::kLine;
    line.range = {-half_, half_};
    line.ends = {feature::kLowRim, feature::kHighRim};
    line.end_radii = {radius_, radius_};
    strata.push_back(line);
  }
  if (sideways || along < 0.0) {
    strata.push_back(rim_stratum(centre() - half_ * axis, axis, radius_, feature::kLowRim));
  }
  if (sideways || along >= 0.0) {
    strata.push_back(rim_stratum(centre() + half_ * axis, axis, radius_, feature::kHighRim));
  }
}

void CylinderCore::facet(const Vec3& n, Facet& facet) const {
  const Vec3 axis = axes_.col(2);
  const double along = n.dot(axis);
  if (std::abs(along) >= M_SQRT1_2) {
    const double side = along < 0.0 ? -1.0 : 1.0;
    disc_facet(centre() + side * half_ * axis, axes_, side, radius_,
               along < 0.0 ? feature::kLow : feature::kHigh,
               along < 0.0 ? feature::kLowRim : feature::kHighRim, facet);
    return;
  }
  facet.reset(0, Vec3::Zero());
  for (const double side : {-1.0, 1.0}) {
    const Stratum rim = rim_stratum(centre() + side * half_ * axis, axis, radius_,
                                    side < 0.0 ? feature::kLowRim : feature::kHighRim);
    const Vec3 point = rim.point(n);
    facet.corners.push_back(corner(point, rim.feature, feature::kSide, rim.surface(n, point, 0.0)));
  }
}

ConeCore::ConeCore(const Cone& cone, const Pose& pose)
    : Convex(pose.position, std::hypot(cone.radius, cone.half_height), 0.0),
      axes_(pose.orientation.toRotationMatrix()),
      radius_(cone.radius),
      half_(cone.half_height),
      slope_(cone.radius / std::hypot(cone.radius, 2.0 * cone.half_height)) {}

Vec3 ConeCore::support(const Vec3& n) const {
  const Vec3 rim = base() + radius_ * outward(n, axes_.col(2));
  return n.dot(apex() - rim) > 0.0 ? apex() : rim;
}

void ConeCore::add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const {
  const Vec3 axis = axes_.col(2);
  const double along = n.dot(axis);
  const bool on_side = std::abs(along - slope_) <= angle;
  if (along < 0.0 && n.cross(axis).norm() <= angle) {
    strata.push_back(face_stratum(base(), -axis, M_PI * radius_ * radius_, feature::kLow));
  }
  if (on_side) {
    Stratum line = vertex_stratum(apex(), feature::kSide);
    line.kind = Kind::kLine;
    line.axis = axis;
    line.slope = slope_;
    line.range = {-std::hypot(radius_, 2.0 * half_), 0.0};
    line.ends = {feature::kLowRim, feature::kHigh};
    line.end_radii = {radius_, 0.0};
    strata.push_back(line);
  }
  if (on_side || along >= slope_) {
    strata.push_back(vertex_stratum(apex(), feature::kHigh));
  }
  if (on_side || along < slope_) {
    strata.push_back(rim_stratum(base(), axis, radius_, feature::kLowRim));
  }
}

void ConeCore::facet(const Vec3& n, Facet& facet) const {
  const Vec3 axis = axes_.col(2);
  const Vec3 side = slope_ * axis + std::sqrt((1.0 - slope_) * (1.0 + slope_)) * outward(n, axis);
  if (-n.dot(axis) >= n.dot(side)) {
    disc_facet(base(), axes_, -1.0, radius_, feature::kLow, feature::kLowRim, facet);
    return;
  }
  const Stratum rim = rim_stratum(base(), axis, radius_, feature::kLowRim);
  const Vec3 point = base() + radius_ * outward(n, axis);
  // The rim as what lies across n meets it; from above the apex it is only far away.
  const Vec3& met_by = n.cross(axis).norm() > 1e-6 ? n : side;
  facet.reset(feature::kSide, Vec3::Zero());
  facet.corners.push_back(
      corner(point, rim.feature, feature::kSide, rim.surface(met_by, point, 0.0)));
  facet.corners.push_back(corner(apex(), feature::kHigh, feature::kSide, LocalSurface::vertex()));
}

EllipsoidCore::EllipsoidCore(const Ellipsoid& ellipsoid, const Pose& pose)
    : Convex(pose.position, ellipsoid.radii.maxCoeff(), 0.0) {
  const Mat3 axes = pose.orientation.toRotationMatrix();
  moment_ = axes * ellipsoid.radii.cwiseAbs2().asDiagonal() * axes.transpose();
}

Stratum EllipsoidCore::stratum() const {
  Stratum stratum = vertex_stratum(centre(), 0);
  stratum.kind = Kind::kEllipsoid;
  stratum.moment = moment_;
  return stratum;
}

Vec3 EllipsoidCore::support(const Vec3& n) const {
  const Vec3 gradient = moment_ * n;
  return centre() + gradient / std::sqrt(n.dot(gradient));
}

void EllipsoidCore::add_strata(const Vec3&, double, std::vector<Stratum>& strata) const {
  strata.push_back(stratum());
}

void EllipsoidCore::facet(const Vec3& n, Facet& facet) const {
  const Vec3 point = support(n);
  facet.reset(0, Vec3::Zero());
  facet.corners.push_back(corner(point, 0, 0, stratum().surface(n, point, 0.0)));
}

}  // namespace signorini::collision
