#include <signorini/collision/facet_clip.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace signorini::collision {
namespace {

using Vec2 = Eigen::Vector2d;

/// A point of a plane, carried along `direction` from x.
Vec3 onto_plane(const Vec3& x, const Vec3& direction, const Facet& plane) {
  const Vec3 at = plane.is_disc() ? plane.disc_centre : plane.corners.front().point;
  return x + plane.normal.dot(at - x) / plane.normal.dot(direction) * direction;
}

/// > 0 outside the edge k of a polygon, seen along its normal.
double excess(const Facet& polygon, std::size_t k, const Vec3& point) {
  const Vec3& from = polygon.corners[k].point;
  const Vec3& to = polygon.corners[(k + 1) % polygon.corners.size()].point;
  return (to - from).cross(polygon.normal).normalized().dot(point - from);
}

/// Height over the reference and the foot of it, from a point of the incident shape.
FacetPoint over(const Facet& reference, const Vec3& on_incident, const FacetCorner& incident,
                Feature reference_feature) {
  const Vec3 foot = onto_plane(on_incident, reference.normal, reference);
  FacetPoint point;
  point.on_incident = on_incident;
  point.on_reference = foot;
  point.height = reference.normal.dot(on_incident - foot);
  point.incident = incident.feature;
  point.reference = reference_feature;
  point.surface = incident.surface;
  return point;
}

// Polygon over polygon.

/// A corner of the clipped polygon and the line from it to the next: an edge of the incident
/// polygon, or (number >= 0) of the reference polygon.
struct ClipCorner {
  Vec3 point = Vec3::Zero();
  FacetCorner what;
  int on_reference = -1;  ///< the reference edge that the corner lies on
  int corner_of_reference = -1;
  Feature edge = 0;
  int reference_edge = -1;
};

/// The corner that two edges of a polygon of n edges share; -1 if none.
int shared_corner(int p, int q, int n) {
  if ((p + 1) % n == q) {
    return q;
  }
  return (q + 1) % n == p ? p : -1;
}

ClipCorner crossing(const ClipCorner& from, double here, const ClipCorner& to, double there, int k,
                    const Facet& incident, int reference_count) {
  ClipCorner result;
  result.point = from.point + here / (here - there) * (to.point - from.point);
  result.what.surface = LocalSurface::vertex();
  result.on_reference = k;
  if (from.reference_edge < 0) {
    result.what.feature = from.edge;
  } else {
    result.what.feature = incident.face;
    result.corner_of_reference = shared_corner(from.reference_edge, k, reference_count);
  }
  return result;
}

std::vector<FacetPoint> clip_polygons(const Facet& incident, const Facet& reference, double slack) {
  std::vector<ClipCorner> polygon;
  for (const FacetCorner& corner : incident.corners) {
    ClipCorner& added = polygon.emplace_back();
    added.point = corner.point;
    added.what = corner;
    added.edge = corner.edge;
  }
  const int sides = static_cast<int>(reference.corners.size());
  std::vector<ClipCorner> clipped;
  for (int k = 0; k < sides; ++k) {
    clipped.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const ClipCorner& from = polygon[i];
      const ClipCorner& to = polygon[(i + 1) % polygon.size()];
      const double here = excess(reference, k, from.point) - slack;
      const double there = excess(reference, k, to.point) - slack;
      if (here <= 0.0) {
        clipped.push_back(from);
        if (here == 0.0 && there > 0.0) {
          clipped.back().reference_edge = k;
        } else if (there > 0.0) {
          clipped.push_back(crossing(from, here, to, there, k, incident, sides));
          clipped.back().reference_edge = k;
        }
      } else if (there < 0.0) {
        clipped.push_back(crossing(from, here, to, there, k, incident, sides));
        clipped.back().edge = from.edge;
        clipped.back().reference_edge = from.reference_edge;
      }
    }
    std::swap(polygon, clipped);
  }
  std::vector<FacetPoint> points;
  for (const ClipCorner& corner : polygon) {
    Feature feature = reference.face;
    if (corner.corner_of_reference >= 0) {
      feature = reference.corners[corner.corner_of_reference].feature;
    } else if (corner.on_reference >= 0) {
      feature = reference.corners[corner.on_reference].edge;
    }
    points.push_back(over(reference, corner.point, corner.what, feature));
  }
  return points;
}

// A segment over a polygon or disc.

/// Where a segment p + t (q - p) lies over a facet, and the features of the facet there.
struct Inside {
  double from = 0.0;
  double to = 1.0;
  Feature at_from = 0;
  Feature at_to = 0;
};

Inside over_polygon(const Vec3& p, const Vec3& q, const Facet& polygon, double slack) {
  Inside inside{0.0, 1.0, polygon.face, polygon.face};
  for (std::size_t k = 0; k < polygon.corners.size(); ++k) {
    const double here = excess(polygon, k, p) - slack;
    const double there = excess(polygon, k, q) - slack;
    if (here > 0.0 && there > 0.0) {
      inside.from = 2.0;
    } else if (here > 0.0 && here / (here - there) > inside.from) {
      inside.from = here / (here - there);
      inside.at_from = polygon.corners[k].edge;
    } else if (there > 0.0 && here / (here - there) < inside.to) {
      inside.to = here / (here - there);
      inside.at_to = polygon.corners[k].edge;
    }
  }
  return inside;
}

Inside over_disc(const Vec3& p, const Vec3& q, const Facet& disc, double slack) {
  const auto flat = [&](const Vec3& x) { return Vec3(x - x.dot(disc.normal) * disc.normal); };
  const Vec3 start = flat(p - disc.disc_centre);
  const Vec3 along = flat(q - p);
  const double radius = disc.disc_radius + slack;
  // |start + t along|^2 = radius^2.
  const double a = along.squaredNorm();
  const double b = start.dot(along);
  const double c = start.squaredNorm() - radius * radius;
  const double root = b * b - a * c;
  Inside inside{0.0, 1.0, disc.face, disc.face};
  if (!(root >= 0.0) || a == 0.0) {
    inside.from = c <= 0.0 ? 0.0 : 2.0;
    return inside;
  }
  const double far = b + std::copysign(std::sqrt(root), b);
  double enter = -far / a;
  double leave = far == 0.0 ? 0.0 : -c / far;
  if (enter > leave) {
    std::swap(enter, leave);
  }
  if (enter > 0.0) {
    inside.from = enter;
    inside.at_from = disc.rim + 4;
  }
  if (leave < 1.0) {
    inside.to = leave;
    inside.at_to = disc.rim + 6;
  }
  return inside;
}

std::vector<FacetPoint> clip_segment(const Facet& segment, const Facet& reference, double slack) {
  const FacetCorner& p = segment.corners[0];
  const FacetCorner& q = segment.corners[1];
  const Inside inside = reference.is_disc() ? over_disc(p.point, q.point, reference, slack)
                                            : over_polygon(p.point, q.point, reference, slack);
  std::vector<FacetPoint> points;
  if (inside.from > inside.to) {
    return points;
  }
  const auto add = [&](double t, const FacetCorner& end, bool is_end, Feature feature) {
    FacetCorner corner = end;
    if (!is_end) {
      corner.feature = segment.face;
      corner.surface = LocalSurface::vertex();
      // A rounded line: a ball along it.
      if (end.surface.radius_along == end.surface.radius_across) {
        corner.surface = end.surface;
      }
    }
    points.push_back(over(reference, p.point + t * (q.point - p.point), corner, feature));
  };
  add(inside.from, p, inside.from == 0.0, inside.at_from);
  if (inside.to > inside.from) {
    add(inside.to, q, inside.to == 1.0, inside.at_to);
  }
  return points;
}

// A disc and a polygon (or the corners of another disc), one over the other.

struct DiscPoint {
  Vec3 on_disc;
  FacetCorner of_disc;
  FacetCorner of_polygon;
};

std::vector<DiscPoint> disc_over_polygon(const Facet& disc, const Facet& polygon,
                                         const Vec3& direction, double slack) {
  // The polygon as it is seen in the disc's plane.
  Facet seen = polygon;
  seen.disc_radius = 0.0;
  seen.normal = polygon.normal.dot(disc.normal) < 0.0 ? Vec3(-disc.normal) : disc.normal;
  for (FacetCorner& corner : seen.corners) {
    corner.point = onto_plane(corner.point, direction, disc);
  }
  const FacetCorner disc_face{Vec3::Zero(), disc.face, 0, LocalSurface::vertex()};
  const FacetCorner polygon_face{Vec3::Zero(), polygon.face, 0, LocalSurface::vertex()};
  std::vector<DiscPoint> points;
  for (std::size_t k = 0; k < seen.corners.size(); ++k) {
    const FacetCorner& p = seen.corners[k];
    const FacetCorner& q = seen.corners[(k + 1) % seen.corners.size()];
    const Inside inside = over_disc(p.point, q.point, disc, slack);
    if (inside.from > inside.to) {
      continue;
    }
    const auto at = [&](double t) { return Vec3(p.point + t * (q.point - p.point)); };
    const auto rim = [&](Feature feature) {
      return FacetCorner{Vec3::Zero(), feature, 0, LocalSurface::vertex()};
    };
    const FacetCorner edge{Vec3::Zero(), p.edge, 0, LocalSurface::vertex()};
    if (inside.from == 0.0) {
      points.push_back({p.point, disc_face, p});
    } else if (inside.from < 1.0) {
      points.push_back({at(inside.from), rim(inside.at_from), edge});
    }
    if (inside.to > inside.from && inside.to < 1.0) {
      points.push_back({at(inside.to), rim(inside.at_to), edge});
    }
  }
  for (const FacetCorner& corner : disc.corners) {
    if (is_over(seen, corner.point, -slack)) {
      points.push_back({corner.point, corner, polygon_face});
    }
  }
  return points;
}

std::vector<FacetPoint> clip_with_disc(const Facet& incident, const Facet& reference,
                                       double slack) {
  std::vector<FacetPoint> points;
  const bool disc_is_reference = reference.is_disc();
  const Facet& disc = disc_is_reference ? reference : incident;
  const Facet& other = disc_is_reference ? incident : reference;
  for (const DiscPoint& point : disc_over_polygon(disc, other, reference.normal, slack)) {
    const Vec3 on_incident =
        disc_is_reference ? onto_plane(point.on_disc, reference.normal, incident) : point.on_disc;
    const FacetCorner& what = disc_is_reference ? point.of_polygon : point.of_disc;
    const FacetCorner& where = disc_is_reference ? point.of_disc : point.of_polygon;
    points.push_back(over(reference, on_incident, what, where.feature));
  }
  return points;
}

/// Two discs whose rims cross between their corners: the two crossings.
std::vector<FacetPoint> crossed_rims(const Facet& incident, const Facet& reference) {
  const Vec3 centre = onto_plane(incident.disc_centre, reference.normal, reference);
  const Vec3 between = centre - reference.disc_centre;
  const double apart = between.norm();
  const double R = reference.disc_radius;
  const double along =
      0.5 * (apart + (R - incident.disc_radius) * (R + incident.disc_radius) / apart);
  const double squared = (R - along) * (R + along);
  std::vector<FacetPoint> points;
  if (!(squared >= 0.0)) {
    return points;
  }
  const Vec3 middle = reference.disc_centre + along / apart * between;
  const Vec3 half = std::sqrt(squared) / apart * reference.normal.cross(between);
  for (const int side : {0, 1}) {
    const Feature shift = side == 0 ? 4 : 6;
    const FacetCorner rim{Vec3::Zero(), incident.rim + shift, 0, LocalSurface::vertex()};
    const Vec3 foot = side == 0 ? Vec3(middle - half) : Vec3(middle + half);
    points.push_back(
        over(reference, onto_plane(foot, reference.normal, incident), rim, reference.rim + shift));
  }
  return points;
}

}  // namespace

bool is_over(const Facet& reference, const Vec3& point, double slack) {
  if (reference.is_disc()) {
    const Vec3 out = point - reference.disc_centre;
    return (out - out.dot(reference.normal) * reference.normal).norm() <=
           reference.disc_radius + slack;
  }
  for (std::size_t k = 0; k < reference.corners.size(); ++k) {
    if (excess(reference, k, point) > slack) {
      return false;
    }
  }
  return true;
}

std::vector<FacetPoint> clip_facet(const Facet& incident, const Facet& reference, double slack) {
  if (incident.corners.size() == 1) {
    const FacetCorner& corner = incident.corners.front();
    if (!is_over(reference, corner.point, slack)) {
      return {};
    }
    return {over(reference, corner.point, corner, reference.face)};
  }
  if (incident.corners.size() == 2) {
    return clip_segment(incident, reference, slack);
  }
  if (incident.is_disc() || reference.is_disc()) {
    std::vector<FacetPoint> points = clip_with_disc(incident, reference, slack);
    if (points.empty() && incident.is_disc() && reference.is_disc()) {
      points = crossed_rims(incident, reference);
    }
    return points;
  }
  return clip_polygons(incident, reference, slack);
}

}  // namespace signorini::collision
