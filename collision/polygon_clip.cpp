#include <signorini/collision/polygon_clip.h>

namespace signorini::collision {
namespace {

/// A line that carries a side of the polygon: an edge of the incident box, or a side plane of the
/// prism, named by the edge of the reference box that it stands on.
struct Side {
  bool of_incident = true;
  BoxSides edge{0, 0, 0};
};

struct Corner {
  ClippedPoint point;
  Side next;  ///< from this corner to the following one
};

struct Polygon {
  std::array<Corner, 8> corners;
  int count = 0;

  void push(const Corner& corner) { corners[count++] = corner; }
};

/// One side plane of the prism: sign * coordinate <= limit.
struct SidePlane {
  bool on_v = false;
  int sign = 1;
  double limit = 0.0;
  BoxSides edge{0, 0, 0};

  /// > 0 outside.
  [[nodiscard]] double excess(const ClippedPoint& p) const {
    return sign * (on_v ? p.v : p.u) - limit;
  }
};

/// The edge between two neighbouring corners of a face: what they share.
BoxSides shared(const BoxSides& p, const BoxSides& q) {
  BoxSides result;
  for (int k = 0; k < 3; ++k) {
    result[k] = p[k] == q[k] ? p[k] : 0;
  }
  return result;
}

/// The vertex that two edges of a face share: what either has.
BoxSides joined(const BoxSides& p, const BoxSides& q) {
  BoxSides result;
  for (int k = 0; k < 3; ++k) {
    result[k] = p[k] != 0 ? p[k] : q[k];
  }
  return result;
}

ClippedPoint crossing(const Corner& from, const ClippedPoint& to, const SidePlane& plane,
                      const BoxSides& incident_face) {
  const ClippedPoint& p = from.point;
  const double a = plane.excess(p);
  const double b = plane.excess(to);
  const double t = a / (a - b);
  ClippedPoint result;
  result.u = p.u + t * (to.u - p.u);
  result.v = p.v + t * (to.v - p.v);
  result.height = p.height + t * (to.height - p.height);
  if (from.next.of_incident) {
    result.incident = from.next.edge;
    result.reference = plane.edge;
  } else {
    result.incident = incident_face;
    result.reference = joined(from.next.edge, plane.edge);
  }
  return result;
}

bool is_inside(const Polygon& polygon, const SidePlane& plane) {
  for (int i = 0; i < polygon.count; ++i) {
    if (plane.excess(polygon.corners[i].point) > 0.0) {
      return false;
    }
  }
  return true;
}

Polygon clip(const Polygon& polygon, const SidePlane& plane, const BoxSides& incident_face) {
  const Side along_plane{false, plane.edge};
  Polygon result;
  for (int i = 0; i < polygon.count; ++i) {
    const Corner& corner = polygon.corners[i];
    const ClippedPoint& next = polygon.corners[(i + 1) % polygon.count].point;
    const double here = plane.excess(corner.point);
    const double there = plane.excess(next);
    if (here <= 0.0) {
      // A corner on the plane is itself the crossing.
      result.push(here == 0.0 && there > 0.0 ? Corner{corner.point, along_plane} : corner);
      if (here < 0.0 && there > 0.0) {
        result.push({crossing(corner, next, plane, incident_face), along_plane});
      }
    } else if (there < 0.0) {
      result.push({crossing(corner, next, plane, incident_face), corner.next});
    }
  }
  return result;
}

}  // namespace

ClippedPolygon clip_face(const PlacedBox& incident, const BoxFace& incident_face,
                         const PlacedBox& reference, const BoxFace& reference_face, double slack) {
  const int n = reference_face.axis;
  const int u = (n + 1) % 3;
  const int v = (n + 2) % 3;

  const auto corners = face_corners(incident_face);
  Polygon polygon;
  for (int k = 0; k < 4; ++k) {
    const Vec3 local = reference.to_local(incident.at(corners[k]));
    const ClippedPoint point{local[u], local[v], reference_face.sign * local[n] - reference.half[n],
                             corners[k], reference_face.sides()};
    polygon.push({point, {true, shared(corners[k], corners[(k + 1) % 4])}});
  }

  for (const int axis : {u, v}) {
    for (const int sign : {-1, 1}) {
      BoxSides edge = reference_face.sides();
      edge[axis] = sign;
      const SidePlane plane{axis == v, sign, reference.half[axis] + slack, edge};
      if (!is_inside(polygon, plane)) {
        polygon = clip(polygon, plane, incident_face.sides());
      }
    }
  }

  ClippedPolygon result;
  for (; result.count < polygon.count; ++result.count) {
    result.points[result.count] = polygon.corners[result.count].point;
  }
  return result;
}

}  // namespace signorini::collision
