#pragma once

#include <signorini/collision/box_geometry.h>
#include <signorini/collision/convex.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/shape.h>

namespace signorini::collision {

/// Features of the round shapes. A rim's 8 fixed points and the chords between them are numbered
/// from kRimPoints and kRimChords (+ 8 for the upper rim); a rim + 4 or + 6 is the point of it
/// where an edge enters or leaves the disc.
namespace feature {
inline constexpr Feature kSide = 0;
inline constexpr Feature kLow = 1;   ///< the cap, end or base at the low end of the axis
inline constexpr Feature kHigh = 2;  ///< the cap or end at the high end; a cone's apex
inline constexpr Feature kLowRim = 3;
inline constexpr Feature kHighRim = 4;
inline constexpr Feature kRimPoints = 16;
inline constexpr Feature kRimChords = 32;
}  // namespace feature

/// The feature of a sphere (half = 0) or capsule at a point of its segment.
[[nodiscard]] Feature feature_at(const LineSegment& core, double t);
/// The piece of the segment's surface there.
[[nodiscard]] Stratum piece_at(const LineSegment& core, double t);

/// A point core: a sphere.
class PointCore final : public Convex {
 public:
  PointCore(const Sphere& sphere, const Pose& pose)
      : Convex(pose.position, sphere.radius, sphere.radius), core_{pose.position} {}

  [[nodiscard]] Vec3 support(const Vec3& n) const override;
  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override;
  void facet(const Vec3& n, Facet& facet) const override;
  [[nodiscard]] const LineSegment* segment() const override { return &core_; }

 private:
  LineSegment core_;
};

/// A segment: a capsule.
class SegmentCore final : public Convex {
 public:
  SegmentCore(const Capsule& capsule, const Pose& pose)
      : Convex(pose.position, capsule.half_length + capsule.radius, capsule.radius),
        core_{pose.position, pose.orientation * Vec3::UnitZ(), capsule.half_length} {}

  [[nodiscard]] Vec3 support(const Vec3& n) const override;
  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override;
  void facet(const Vec3& n, Facet& facet) const override;
  [[nodiscard]] const LineSegment* segment() const override { return &core_; }

 private:
  LineSegment core_;
};

class CylinderCore final : public Convex {
 public:
  CylinderCore(const Cylinder& cylinder, const Pose& pose);

  [[nodiscard]] Vec3 support(const Vec3& n) const override;
  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override;
  void facet(const Vec3& n, Facet& facet) const override;

 private:
  Mat3 axes_;
  double radius_;
  double half_;
};

class ConeCore final : public Convex {
 public:
  ConeCore(const Cone& cone, const Pose& pose);

  [[nodiscard]] Vec3 support(const Vec3& n) const override;
  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override;
  void facet(const Vec3& n, Facet& facet) const override;

 private:
  [[nodiscard]] Vec3 apex() const { return centre() + half_ * axes_.col(2); }
  [[nodiscard]] Vec3 base() const { return centre() - half_ * axes_.col(2); }

  Mat3 axes_;
  double radius_;
  double half_;
  double slope_;  ///< the sine of half the angle at the apex
};

class EllipsoidCore final : public Convex {
 public:
  EllipsoidCore(const Ellipsoid& ellipsoid, const Pose& pose);

  [[nodiscard]] Vec3 support(const Vec3& n) const override;
  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override;
  void facet(const Vec3& n, Facet& facet) const override;

 private:
  [[nodiscard]] Stratum stratum() const;

  Mat3 moment_;
};

class BoxCore final : public Convex {
 public:
  BoxCore(const Box& box, const Pose& pose);
  BoxCore(const BoxCore&) = delete;
  BoxCore& operator=(const BoxCore&) = delete;

  [[nodiscard]] Vec3 support(const Vec3& n) const override;
  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override;
  void facet(const Vec3& n, Facet& facet) const override;
  [[nodiscard]] const Polyhedron* polyhedron() const override { return &polyhedron_; }

 private:
  PlacedBox box_;
  std::array<Vec3, 8> vertices_;
  std::array<double, 6> offsets_;
  std::array<double, 6> areas_;
  Polyhedron polyhedron_;
};

/// Features of a hull: vertex v is v, edge e is (vertices) + e, face f is (vertices) + (edges) + f.
class HullCore final : public Convex {
 public:
  HullCore(const ConvexHull& hull, const Pose& pose);

  [[nodiscard]] Vec3 support(const Vec3& n) const override;
  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override;
  void facet(const Vec3& n, Facet& facet) const override;
  [[nodiscard]] const Polyhedron* polyhedron() const override { return &polyhedron_; }

 private:
  [[nodiscard]] Vec3 vertex(int v) const { return position_ + axes_ * data_->vertices[v]; }
  [[nodiscard]] int support_vertex(const Vec3& local_n) const;
  [[nodiscard]] Feature edge_feature(int e) const;
  [[nodiscard]] Feature face_feature(int f) const;
  void facet_of(int face, Facet& facet) const;

  const HullData* data_;
  Vec3 position_;
  Mat3 axes_;
  Polyhedron polyhedron_;
};

/// The core of each shape that has one.
[[nodiscard]] inline PointCore core_of(const Sphere& shape, const Pose& pose) {
  return {shape, pose};
}
[[nodiscard]] inline SegmentCore core_of(const Capsule& shape, const Pose& pose) {
  return {shape, pose};
}
[[nodiscard]] inline CylinderCore core_of(const Cylinder& shape, const Pose& pose) {
  return {shape, pose};
}
[[nodiscard]] inline ConeCore core_of(const Cone& shape, const Pose& pose) {
  return {shape, pose};
}
[[nodiscard]] inline EllipsoidCore core_of(const Ellipsoid& shape, const Pose& pose) {
  return {shape, pose};
}
[[nodiscard]] inline BoxCore core_of(const Box& shape, const Pose& pose) {
  return {shape, pose};
}
[[nodiscard]] inline HullCore core_of(const ConvexHull& shape, const Pose& pose) {
  return {shape, pose};
}

}  // namespace signorini::collision
