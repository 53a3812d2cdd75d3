#include <signorini/collision/box_box.h>
#include <signorini/collision/box_distance.h>
#include <signorini/collision/box_separation.h>
#include <signorini/collision/polygon_clip.h>

#include <algorithm>
#include <cmath>

namespace signorini::collision::narrow {
namespace {

/// Edges within this angle (radians) of parallel touch along a line, not in a point.
constexpr double kParallelEdges = 1e-7;

Contact between(const Vec3& point_a, const Vec3& point_b, const Vec3& normal, double gap,
                const BoxSides& sides_a, const BoxSides& sides_b, NormalOwner owner) {
  return make_contact(point_a, point_b, normal, gap,
                      feature_pair_id(box_feature(sides_a), box_feature(sides_b)), owner);
}

/// Face contacts; `axis` is a face of A or of B.
void find_on_face(const PlacedBox& a, const PlacedBox& b, const BoxAxis& axis, double margin,
                  std::vector<Contact>& contacts) {
  const bool of_a = axis.kind == BoxAxis::Kind::kFaceOfA;
  const PlacedBox& reference = of_a ? a : b;
  const PlacedBox& incident = of_a ? b : a;
  const int n = of_a ? axis.axis_a : axis.axis_b;
  // Out of the reference face, towards the incident box.
  const Vec3 outward = of_a ? Vec3(-axis.normal) : axis.normal;
  const BoxFace face{n, reference.axes.col(n).dot(outward) > 0.0 ? 1 : -1};

  const ClippedPolygon polygon = clip_face(incident, face_against(incident, outward), reference,
                                           face, preference_tolerance(a, b));
  // Rounding of the heights must not lose the one contact of boxes that are margin apart.
  const double highest = std::max(margin, polygon.lowest_height());
  for (int k = 0; k < polygon.count; ++k) {
    const ClippedPoint& point = polygon.points[k];
    if (point.height > highest) {
      continue;
    }
    Vec3 local;
    local[n] = face.sign * reference.half[n];
    local[(n + 1) % 3] = point.u;
    local[(n + 2) % 3] = point.v;
    const Vec3 on_reference = reference.to_world(local);
    const Vec3 on_incident = on_reference + point.height * outward;
    Contact contact = of_a ? between(on_reference, on_incident, axis.normal, point.height,
                                     point.reference, point.incident, NormalOwner::kFaceA)
                           : between(on_incident, on_reference, axis.normal, point.height,
                                     point.incident, point.reference, NormalOwner::kFaceB);
    (of_a ? contact.surface_a : contact.surface_b) = LocalSurface::face();
    (of_a ? contact.surface_b : contact.surface_a) = LocalSurface::vertex();
    contacts.push_back(contact);
  }
}

/// The edge of a box along `axis` that reaches furthest along n.
BoxSides edge_towards(const PlacedBox& box, int axis, const Vec3& n) {
  BoxSides sides;
  for (int k = 0; k < 3; ++k) {
    sides[k] = k == axis ? 0 : (box.axes.col(k).dot(n) < 0.0 ? -1 : 1);
  }
  return sides;
}

/// Two edges, not parallel: the nearest points of their lines, held within the edges.
Contact edge_contact(const PlacedBox& a, const PlacedBox& b, const BoxAxis& axis) {
  const Vec3& N = axis.normal;
  const BoxSides sides_a = edge_towards(a, axis.axis_a, -N);
  const BoxSides sides_b = edge_towards(b, axis.axis_b, N);
  const Vec3 u = a.axes.col(axis.axis_a);
  const Vec3 v = b.axes.col(axis.axis_b);
  const Vec3 offset = b.at(sides_b) - a.at(sides_a);
  const double half_a = a.half[axis.axis_a];
  const double half_b = b.half[axis.axis_b];
  // Along the lines; where rounding puts the crossing beyond an end, the nearest points within the
  // edges are those of that end.
  const double crossing = (u - u.dot(v) * v).dot(offset) / u.cross(v).squaredNorm();
  const double t =
      std::clamp(v.dot(std::clamp(crossing, -half_a, half_a) * u - offset), -half_b, half_b);
  const double s = std::clamp(u.dot(offset + t * v), -half_a, half_a);
  const Vec3 middle = 0.5 * (a.at(sides_a) + s * u + b.at(sides_b) + t * v);
  const Vec3 half_gap = 0.5 * axis.separation * N;
  Contact contact = between(middle + half_gap, middle - half_gap, N, axis.separation, sides_a,
                            sides_b, NormalOwner::kEdgeEdge);
  contact.surface_a = LocalSurface::edge(u);
  contact.surface_b = LocalSurface::edge(v);
  return contact;
}

LocalSurface local_surface(const PlacedBox& box, const BoxSides& sides) {
  const auto free = std::find(sides.begin(), sides.end(), 0);
  return free == sides.end() ? LocalSurface::vertex()
                             : LocalSurface::edge(box.axes.col(free - sides.begin()));
}

/// An edge through the nearest point, along `axis`.
struct NearEdge {
  int axis;
  BoxSides sides;
};

/// The edge along `axis` that the feature lies on or is.
NearEdge edge_through(BoxSides sides, int axis) {
  sides[axis] = 0;
  return {axis, sides};
}

bool is_edge(const BoxSides& sides) {
  return std::count(sides.begin(), sides.end(), 0) == 1;
}

/// The ends of the stretch along which two parallel edges face each other; each is a vertex of one
/// box over the edge of the other.
void find_on_parallel_edges(const PlacedBox& a, const NearEdge& edge_a, const PlacedBox& b,
                            const NearEdge& edge_b, const Vec3& N, double margin,
                            std::vector<Contact>& contacts) {
  const Vec3 u = a.axes.col(edge_a.axis);
  const Vec3 v = b.axes.col(edge_b.axis);
  const Vec3 middle_a = a.at(edge_a.sides);
  const Vec3 middle_b = b.at(edge_b.sides);
  const double half_a = a.half[edge_a.axis];
  const double half_b = b.half[edge_b.axis];
  const double same_way = u.dot(v) < 0.0 ? -1.0 : 1.0;
  const double centre_b = u.dot(middle_b - middle_a);  // A's edge is [-half_a, half_a]
  for (const int end : {-1, 1}) {
    const double reach_b = end * centre_b + half_b;
    const bool vertex_of_a = half_a <= reach_b + preference_tolerance(a, b);
    const double s = end * (vertex_of_a ? half_a : reach_b);
    const Vec3 point_a = middle_a + s * u;
    const double gap = N.dot(point_a - (middle_b + same_way * (s - centre_b) * v));
    if (gap > margin) {
      continue;
    }
    BoxSides sides_a = edge_a.sides;
    BoxSides sides_b = edge_b.sides;
    (vertex_of_a ? sides_a[edge_a.axis] : sides_b[edge_b.axis]) =
        vertex_of_a ? end : end * static_cast<int>(same_way);
    Contact contact =
        between(point_a, point_a - gap * N, N, gap, sides_a, sides_b, NormalOwner::kCurved);
    contact.surface_a = vertex_of_a ? LocalSurface::vertex() : LocalSurface::edge(u);
    contact.surface_b = vertex_of_a ? LocalSurface::edge(v) : LocalSurface::vertex();
    contacts.push_back(contact);
  }
}

/// Vertex and vertex, or vertex and edge.
void find_at_corners(const PlacedBox& a, const PlacedBox& b, const BoxNearest& nearest,
                     double margin, std::vector<Contact>& contacts) {
  const Vec3 N = (nearest.point_a - nearest.point_b).normalized();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const NearEdge edge_a = edge_through(nearest.sides_a, i);
      const NearEdge edge_b = edge_through(nearest.sides_b, j);
      const Vec3 u = a.axes.col(i);
      if (is_edge(edge_a.sides) && is_edge(edge_b.sides) && std::abs(u.dot(N)) <= kParallelEdges &&
          u.cross(b.axes.col(j)).norm() <= kParallelEdges) {
        find_on_parallel_edges(a, edge_a, b, edge_b, N, margin, contacts);
        return;
      }
    }
  }
  Contact contact = between(nearest.point_a, nearest.point_b, N, nearest.distance, nearest.sides_a,
                            nearest.sides_b, NormalOwner::kCurved);
  contact.surface_a = local_surface(a, nearest.sides_a);
  contact.surface_b = local_surface(b, nearest.sides_b);
  contacts.push_back(contact);
}

}  // namespace

double distance(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  const PlacedBox box_a(a, pose_a);
  const PlacedBox box_b(b, pose_b);
  const double separation = separate(box_a, box_b).separation;
  return separation <= 0.0 ? separation
                           : std::max(separation, nearest_points(box_a, box_b).distance);
}

bool test(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  return overlap(PlacedBox(a, pose_a), PlacedBox(b, pose_b));
}

void find(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  const PlacedBox box_a(a, pose_a);
  const PlacedBox box_b(b, pose_b);
  const BoxSeparation found = separate(box_a, box_b);
  if (found.separation > margin) {
    return;
  }
  const bool apart = found.separation > 0.0;
  BoxNearest nearest;
  if (apart) {
    nearest = nearest_points(box_a, box_b);
    if (nearest.distance > margin) {
      return;
    }
    // The nearest points lie this far beside each other as the best axis sees them.
    const double beside = std::sqrt(std::max(0.0, nearest.distance - found.separation) *
                                    (nearest.distance + found.separation));
    if (beside > preference_tolerance(box_a, box_b)) {
      find_at_corners(box_a, box_b, nearest, margin, contacts);
      return;
    }
  }
  if (found.preferred.kind == BoxAxis::Kind::kEdges) {
    contacts.push_back(edge_contact(box_a, box_b, found.preferred));
    return;
  }
  find_on_face(box_a, box_b, found.preferred, margin, contacts);
  if (contacts.empty() && apart) {
    // Beside the preferred face by more than the clipping's slack, though not beside the best axis.
    find_at_corners(box_a, box_b, nearest, margin, contacts);
  }
}

}  // namespace signorini::collision::narrow
