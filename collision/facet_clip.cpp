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

/// The edge k of a polygon as a plane that stands on it.
struct Side {
  const Vec3& from;
  Vec3 outward;

  Side(const Facet& polygon, std::size_t k)
      : from(polygon.corners[k].point),
        outward((polygon.corners[k + 1 == polygon.corners.size() ? 0 : k + 1].point - from)
                    .cross(polygon.normal)
                    .normalized()) {}
  /// > 0 outside, m.
  [[nodiscard]] double excess(const Vec3& point) const { return outward.dot(point - from); }
};

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
  int corner_of_incident = -1;  ///< -1: a crossing
  Feature feature = 0;          ///< of the incident polygon there
  int on_reference = -1;        ///< the reference edge that the corner lies on
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

/// Where the line from a corner crosses the edge k of the reference polygon.
ClipCorner crossing(const ClipCorner& from, const Vec3& point, int k, const Facet& incident,
                    int reference_count) {
  ClipCorner result;
  result.point = point;
  result.on_reference = k;
  if (from.reference_edge < 0) {
    result.feature = from.edge;
  } else {
    result.feature = incident.face;
    result.corner_of_reference = shared_corner(from.reference_edge, k, reference_count);
  }
  return result;
}

struct Polygons {
  std::vector<ClipCorner> polygon;
  std::vector<ClipCorner> clipped;
};

/// One step of Sutherland and Hodgman. A corner within `slack` of the edge stays what it is, and
/// there is then no crossing beside it.
void clip_at(const Facet& incident, const Facet& reference, int k, double slack,
             Polygons& polygons) {
  auto& [polygon, clipped] = polygons;
  const Side side(reference, k);
  const int sides = static_cast<int>(reference.corners.size());
  clipped.clear();
  double there = polygon.empty() ? 0.0 : side.excess(polygon.front().point);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ClipCorner& from = polygon[i];
    const ClipCorner& to = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    const double here = there;
    there = side.excess(to.point);
    const auto cross = [&] {
      return crossing(from, from.point + here / (here - there) * (to.point - from.point), k,
                      incident, sides);
    };
    if (here <= slack) {
      clipped.push_back(from);
      if (there > slack) {
        if (here < 0.0) {
          clipped.push_back(cross());
        }
        clipped.back().reference_edge = k;
      }
    } else if (there < 0.0) {
      clipped.push_back(cross());
      clipped.back().edge = from.edge;
      clipped.back().reference_edge = from.reference_edge;
    }
  }
  std::swap(polygon, clipped);
}

/// A point of an edge of the reference polygon that lies beyond its end, beside the next edge (by
/// less than the slack, which is far along the first at an acute corner), goes to that corner. Not
/// if the next edge goes straight on.
void pull_to_corner(const Facet& incident, const Facet& reference, double slack,
                    ClipCorner& corner) {
  const int k = corner.on_reference;
  if (k < 0) {
    return;
  }
  const int count = static_cast<int>(reference.corners.size());
  const int next = (k + 1) % count;
  const Vec3& from = reference.corners[k].point;
  const Vec3 edge = reference.corners[next].point - from;
  const double along = edge.dot(corner.point - from);
  const bool is_before = along < 0.0;
  if (!is_before && along <= edge.squaredNorm()) {
    return;
  }
  const double straight = 1e-6 * slack;  // above rounding
  if (Side(reference, is_before ? (k + count - 1) % count : next).excess(corner.point) > straight) {
    corner.corner_of_reference = is_before ? k : next;
    corner.point =
        onto_plane(reference.corners[corner.corner_of_reference].point, reference.normal, incident);
  }
}

void clip_polygons(const Facet& incident, const Facet& reference, double slack,
                   std::vector<FacetPoint>& points) {
  thread_local Polygons polygons;
  std::vector<ClipCorner>& polygon = polygons.polygon;
  polygon.clear();
  for (std::size_t i = 0; i < incident.corners.size(); ++i) {
    ClipCorner& added = polygon.emplace_back();
    added.point = incident.corners[i].point;
    added.corner_of_incident = static_cast<int>(i);
    added.feature = incident.corners[i].feature;
    added.edge = incident.corners[i].edge;
  }
  for (int k = 0; k < static_cast<int>(reference.corners.size()); ++k) {
    clip_at(incident, reference, k, slack, polygons);
  }
  for (ClipCorner& corner : polygon) {
    pull_to_corner(incident, reference, slack, corner);
    Feature feature = reference.face;
    if (corner.corner_of_reference >= 0) {
      feature = reference.corners[corner.corner_of_reference].feature;
    } else if (corner.on_reference >= 0) {
      feature = reference.corners[corner.on_reference].edge;
    }
    const LocalSurface surface = corner.corner_of_incident < 0
                                     ? LocalSurface::vertex()
                                     : incident.corners[corner.corner_of_incident].surface;
    points.push_back(
        over(reference, corner.point, {corner.point, corner.feature, 0, surface}, feature));
  }
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
    const Side side(polygon, k);
    const double here = side.excess(p);
    const double there = side.excess(q);
    if (here > slack && there > slack) {
      inside.from = 2.0;
    } else if (here > slack) {
      const double enter = there < 0.0 ? here / (here - there) : 1.0;
      if (enter > inside.from) {
        inside.from = enter;
        inside.at_from = polygon.corners[k].edge;
      }
    } else if (there > slack) {
      const double leave = here < 0.0 ? here / (here - there) : 0.0;
      if (leave < inside.to) {
        inside.to = leave;
        inside.at_to = polygon.corners[k].edge;
      }
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

void clip_segment(const Facet& segment, const Facet& reference, double slack,
                  std::vector<FacetPoint>& points) {
  const FacetCorner& p = segment.corners[0];
  const FacetCorner& q = segment.corners[1];
  const Inside inside = reference.is_disc() ? over_disc(p.point, q.point, reference, slack)
                                            : over_polygon(p.point, q.point, reference, slack);
  if (inside.from > inside.to) {
    return;
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
}

// A disc and a polygon (or the corners of another disc), one over the other.

struct DiscPoint {
  Vec3 on_disc;
  FacetCorner of_disc;
  FacetCorner of_polygon;
};

/// Calls add(DiscPoint).
template <class Add>
void disc_over_polygon(const Facet& disc, const Facet& polygon, const Vec3& direction, double slack,
                       Add&& add) {
  // The polygon as it is seen in the disc's plane.
  thread_local Facet seen;
  seen = polygon;
  seen.disc_radius = 0.0;
  seen.normal = polygon.normal.dot(disc.normal) < 0.0 ? Vec3(-disc.normal) : disc.normal;
  for (FacetCorner& corner : seen.corners) {
    corner.point = onto_plane(corner.point, direction, disc);
  }
  const FacetCorner disc_face{Vec3::Zero(), disc.face, 0, LocalSurface::vertex()};
  const FacetCorner polygon_face{Vec3::Zero(), polygon.face, 0, LocalSurface::vertex()};
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
      add(DiscPoint{p.point, disc_face, p});
    } else if (inside.from < 1.0) {
      add(DiscPoint{at(inside.from), rim(inside.at_from), edge});
    }
    if (inside.to > inside.from && inside.to < 1.0) {
      add(DiscPoint{at(inside.to), rim(inside.at_to), edge});
    }
  }
  for (const FacetCorner& corner : disc.corners) {
    if (is_over(seen, corner.point, -slack)) {
      add(DiscPoint{corner.point, corner, polygon_face});
    }
  }
}

void clip_with_disc(const Facet& incident, const Facet& reference, double slack,
                    std::vector<FacetPoint>& points) {
  const bool disc_is_reference = reference.is_disc();
  const Facet& disc = disc_is_reference ? reference : incident;
  const Facet& other = disc_is_reference ? incident : reference;
  disc_over_polygon(disc, other, reference.normal, slack, [&](const DiscPoint& point) {
    const Vec3 on_incident =
        disc_is_reference ? onto_plane(point.on_disc, reference.normal, incident) : point.on_disc;
    const FacetCorner& what = disc_is_reference ? point.of_polygon : point.of_disc;
    const FacetCorner& where = disc_is_reference ? point.of_disc : point.of_polygon;
    points.push_back(over(reference, on_incident, what, where.feature));
  });
}

/// Two discs whose rims cross between their corners: the two crossings, if the discs are so nearly
/// parallel that the incident rim is seen as a circle to `slack`.
void add_crossed_rims(const Facet& incident, const Facet& reference, double slack,
                      std::vector<FacetPoint>& points) {
  const Vec3 centre = onto_plane(incident.disc_centre, reference.normal, reference);
  const Vec3 between = centre - reference.disc_centre;
  const double apart = between.norm();
  const double R = reference.disc_radius;
  const double along =
      0.5 * (apart + (R - incident.disc_radius) * (R + incident.disc_radius) / apart);
  const double squared = (R - along) * (R + along);
  if (!(squared >= 0.0)) {
    return;
  }
  const Vec3 middle = reference.disc_centre + along / apart * between;
  const Vec3 half = std::sqrt(squared) / apart * reference.normal.cross(between);
  for (const int side : {0, 1}) {
    const Feature shift = side == 0 ? 4 : 6;
    const FacetCorner rim{Vec3::Zero(), incident.rim + shift, 0, LocalSurface::vertex()};
    const Vec3 foot = side == 0 ? Vec3(middle - half) : Vec3(middle + half);
    const Vec3 on_incident = onto_plane(foot, reference.normal, incident);
    if (std::abs((on_incident - incident.disc_centre).norm() - incident.disc_radius) <= slack) {
      points.push_back(over(reference, on_incident, rim, reference.rim + shift));
    }
  }
}

}  // namespace

bool is_over(const Facet& reference, const Vec3& point, double slack) {
  if (reference.is_disc()) {
    const Vec3 out = point - reference.disc_centre;
    return (out - out.dot(reference.normal) * reference.normal).norm() <=
           reference.disc_radius + slack;
  }
  for (std::size_t k = 0; k < reference.corners.size(); ++k) {
    if (Side(reference, k).excess(point) > slack) {
      return false;
    }
  }
  return true;
}

void clip_facet(const Facet& incident, const Facet& reference, double slack,
                std::vector<FacetPoint>& points) {
  points.clear();
  if (incident.corners.size() == 1) {
    const FacetCorner& corner = incident.corners.front();
    if (is_over(reference, corner.point, slack)) {
      points.push_back(over(reference, corner.point, corner, reference.face));
    }
  } else if (incident.corners.size() == 2) {
    clip_segment(incident, reference, slack, points);
  } else if (incident.is_disc() || reference.is_disc()) {
    clip_with_disc(incident, reference, slack, points);
    if (points.empty() && incident.is_disc() && reference.is_disc()) {
      add_crossed_rims(incident, reference, slack, points);
    }
  } else {
    clip_polygons(incident, reference, slack, points);
  }
}

}  // namespace signorini::collision
