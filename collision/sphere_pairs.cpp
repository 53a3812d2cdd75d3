#include <signorini/collision/box_geometry.h>
#include <signorini/collision/sphere_pairs.h>

#include <algorithm>
#include <cmath>

namespace signorini::collision::narrow {
namespace {

/// The point of a box's surface nearest to a point, and the outward normal there.
struct NearestOnBox {
  Vec3 point;       ///< query frame
  Vec3 normal;      ///< unit, query frame
  double distance;  ///< > 0 outside; <= 0 inside: minus the depth
  BoxSides sides;   ///< the feature that the point lies on
};

NearestOnBox leave_through_nearest_face(const PlacedBox& box, Vec3 local) {
  int axis = 0;
  const Vec3 depth = box.half - local.cwiseAbs();
  for (int k = 1; k < 3; ++k) {
    if (depth[k] < depth[axis]) {
      axis = k;
    }
  }
  BoxFace face{axis, local[axis] >= 0.0 ? 1 : -1};
  local[axis] = face.sign * box.half[axis];
  return {box.to_world(local), face.sign * box.axes.col(axis), -depth[axis], face.sides()};
}

NearestOnBox nearest_on_box(const PlacedBox& box, const Vec3& point) {
  const Vec3 local = box.to_local(point);
  const Vec3 nearest = local.cwiseMax(-box.half).cwiseMin(box.half);
  const Vec3 outside = local - nearest;
  const double distance = outside.stableNorm();
  if (distance == 0.0) {
    return leave_through_nearest_face(box, local);
  }
  BoxSides sides;
  for (int k = 0; k < 3; ++k) {
    sides[k] = (outside[k] > 0.0) - (outside[k] < 0.0);
  }
  return {box.to_world(nearest), box.axes * outside.stableNormalized().normalized(), distance,
          sides};
}

/// How the box looks at a feature: face, edge (with its direction), vertex.
LocalSurface local_surface(const PlacedBox& box, const BoxSides& sides) {
  const auto set = 3 - std::count(sides.begin(), sides.end(), 0);
  if (set == 1) {
    return LocalSurface::face();
  }
  if (set == 2) {
    const auto free = std::find(sides.begin(), sides.end(), 0) - sides.begin();
    return LocalSurface::edge(box.axes.col(free));
  }
  return LocalSurface::vertex();
}

bool is_face(const BoxSides& sides) {
  return std::count(sides.begin(), sides.end(), 0) == 2;
}

Vec3 plane_normal(const Pose& pose) {
  return pose.orientation * Vec3::UnitZ();
}

}  // namespace

double distance(const Sphere& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b) {
  return (pose_a.position - pose_b.position).stableNorm() - (a.radius + b.radius);
}

bool test(const Sphere& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

void find(const Sphere& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  const double gap = distance(a, pose_a, b, pose_b);
  if (gap > margin) {
    return;
  }
  const Vec3 between = pose_a.position - pose_b.position;
  const Vec3 normal =
      between.isZero(0.0) ? Vec3(Vec3::UnitZ()) : between.stableNormalized().normalized();
  Contact contact =
      make_contact(pose_a.position - a.radius * normal, pose_b.position + b.radius * normal, normal,
                   gap, feature_pair_id(0, 0), NormalOwner::kCurved);
  contact.surface_a = LocalSurface::sphere(a.radius);
  contact.surface_b = LocalSurface::sphere(b.radius);
  contacts.push_back(contact);
}

double distance(const Sphere& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  return nearest_on_box(PlacedBox(b, pose_b), pose_a.position).distance - a.radius;
}

bool test(const Sphere& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

void find(const Sphere& a, const Pose& pose_a, const Box& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  const PlacedBox box(b, pose_b);
  const NearestOnBox nearest = nearest_on_box(box, pose_a.position);
  const double gap = nearest.distance - a.radius;
  if (gap > margin) {
    return;
  }
  Contact contact =
      make_contact(pose_a.position - a.radius * nearest.normal, nearest.point, nearest.normal, gap,
                   feature_pair_id(0, box_feature(nearest.sides)),
                   is_face(nearest.sides) ? NormalOwner::kFaceB : NormalOwner::kCurved);
  contact.surface_a = LocalSurface::sphere(a.radius);
  contact.surface_b = local_surface(box, nearest.sides);
  contacts.push_back(contact);
}

double distance(const Sphere& a, const Pose& pose_a, const HalfSpace&, const Pose& pose_b) {
  return plane_normal(pose_b).dot(pose_a.position - pose_b.position) - a.radius;
}

bool test(const Sphere& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

void find(const Sphere& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b,
          double margin, std::vector<Contact>& contacts) {
  const double gap = distance(a, pose_a, b, pose_b);
  if (gap > margin) {
    return;
  }
  const Vec3 normal = plane_normal(pose_b);
  const Vec3 point_a = pose_a.position - a.radius * normal;
  Contact contact = make_contact(point_a, point_a - gap * normal, normal, gap,
                                 feature_pair_id(0, 0), NormalOwner::kFaceB);
  contact.surface_a = LocalSurface::sphere(a.radius);
  contact.surface_b = LocalSurface::face();
  contacts.push_back(contact);
}

}  // namespace signorini::collision::narrow
