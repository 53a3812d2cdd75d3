#pragma once

#include <signorini/collision/feature_id.h>
#include <signorini/collision/segments.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/model/types.h>

#include <array>
#include <vector>

namespace signorini::collision {

/// A piece of the surface of a convex core on which the support function h(n) = max n.x is smooth,
/// by the outward normals n that it carries:
///
/// | kind      | normals          | h(n)                                  |
/// |-----------|------------------|---------------------------------------|
/// | vertex    | an open set      | anchor.n                              |
/// | rim       | an open set      | anchor.n + radius |n - (n.axis) axis| |
/// | ellipsoid | all              | anchor.n + |moment^(1/2) n|           |
/// | line      | n.axis = slope   | anchor.n + radius                     |
/// | face      | n = axis         | anchor.n                              |
///
/// A line is an edge (slope 0, radius 0), a generator of a cylinder (slope 0) or of a cone (radius
/// 0, anchor its apex, slope the sine of half its angle).
struct Stratum {
  enum class Kind : unsigned char { kVertex, kRim, kEllipsoid, kLine, kFace };

  Kind kind = Kind::kVertex;
  Feature feature = 0;
  Vec3 anchor = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
  double radius = 0.0;
  double slope = 0.0;
  Mat3 moment = Mat3::Zero();         ///< ellipsoid: R diag(a^2, b^2, c^2) R^T
  std::array<double, 2> range{};      ///< line: from the anchor along direction(), m
  std::array<Feature, 2> ends{};      ///< line: the features at its two ends
  std::array<double, 2> end_radii{};  ///< line: of the rims there; 0: a vertex
  double area = 0.0;                  ///< face, m^2

  [[nodiscard]] bool is_free() const { return kind < Kind::kLine; }
  /// The point of the core with this outward normal. @pre is_free()
  [[nodiscard]] Vec3 point(const Vec3& n) const;
  /// h'' in the tangent plane of n: the radii of curvature. @pre is_free()
  [[nodiscard]] Mat3 radii(const Vec3& n) const;
  /// Along the line that carries n. @pre a line
  [[nodiscard]] Vec3 direction(const Vec3& n) const;
  /// A point of that line. @pre a line
  [[nodiscard]] Vec3 line_point(const Vec3& n) const { return anchor + radius * n; }
  /// The surface at a point of the core, grown by `rounding`.
  [[nodiscard]] LocalSurface surface(const Vec3& n, const Vec3& core_point, double rounding) const;
};

/// A corner of a facet, and the edge from it to the next corner.
struct FacetCorner {
  Vec3 point = Vec3::Zero();  ///< of the core
  Feature feature = 0;
  Feature edge = 0;
  LocalSurface surface;  ///< of the rounded shape there, as what a face meets
};

/// The flat piece of a core's surface whose normal is nearest to a direction: a point, a segment,
/// a polygon (counter-clockwise from outside), or a disc, whose corners are 8 points of its rim,
/// fixed in the body.
struct Facet {
  std::vector<FacetCorner> corners;
  Feature face = 0;
  Vec3 normal = Vec3::Zero();  ///< of a polygon or disc, outward
  double disc_radius = 0.0;    ///< 0: no disc
  Vec3 disc_centre = Vec3::Zero();
  Feature rim = 0;  ///< of a disc: rim + 4: where a line enters it; rim + 6: where one leaves it

  [[nodiscard]] bool is_disc() const { return disc_radius > 0.0; }
  [[nodiscard]] bool is_polygon() const { return !is_disc() && corners.size() >= 3; }

  /// A facet without corners, which keeps its memory.
  void reset(Feature number, const Vec3& outward) {
    corners.clear();
    face = number;
    normal = outward;
    disc_radius = 0.0;
    disc_centre.setZero();
    rim = 0;
  }
};

struct HullData;

/// A convex polyhedron in its own frame, and where that is. A box is the cube |x| <= 1, stretched.
struct Polyhedron {
  const HullData* shape = nullptr;  ///< faces, edges and normals
  const Vec3* vertices = nullptr;   ///< as many as the shape's, m
  const double* offsets = nullptr;  ///< of the faces, m
  const double* areas = nullptr;    ///< of the faces, m^2
  Vec3 position = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
  double size = 0.0;  ///< as Convex::size()
  int corners = 0;    ///< how many
  int faces = 0;
  bool is_box = false;

  [[nodiscard]] Stratum edge(int number) const;
};

/// A convex shape in the frame of a query: all points within `rounding` of a core.
class Convex {
 public:
  virtual ~Convex() = default;

  /// A point of the core with the largest n.x.
  [[nodiscard]] virtual Vec3 support(const Vec3& n) const = 0;
  /// Every piece of the core's surface that carries a normal within `angle` (radians, roughly) of
  /// n; those that carry n itself always.
  virtual void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const = 0;
  /// @param facet replaced
  virtual void facet(const Vec3& n, Facet& facet) const = 0;

  /// The shape as a polyhedron; null: it is none, or is not met as one.
  [[nodiscard]] virtual const Polyhedron* polyhedron() const { return nullptr; }
  /// The core as a segment, or (half = 0) a point; null: it is none. Only these have a rounding.
  [[nodiscard]] virtual const LineSegment* segment() const { return nullptr; }

  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] const Vec3& centre() const { return centre_; }
  /// The largest distance of a point of the rounded shape from the centre, m.
  [[nodiscard]] double size() const { return size_; }

 protected:
  Convex(const Vec3& centre, double size, double rounding)
      : centre_(centre), size_(size), rounding_(rounding) {}
  Convex(const Convex&) = default;
  Convex& operator=(const Convex&) = default;

 private:
  Vec3 centre_;
  double size_;
  double rounding_;
};

}  // namespace signorini::collision
