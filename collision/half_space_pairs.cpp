#include <signorini/collision/box_geometry.h>
#include <signorini/collision/half_space_pairs.h>

#include <limits>

namespace signorini::collision::narrow {
namespace {

Vec3 plane_normal(const Pose& pose) {
  return pose.orientation * Vec3::UnitZ();
}

}  // namespace

double distance(const Box& a, const Pose& pose_a, const HalfSpace&, const Pose& pose_b) {
  const Vec3 n = plane_normal(pose_b);
  return n.dot(pose_a.position - pose_b.position) - PlacedBox(a, pose_a).support(n);
}

bool test(const Box& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

void find(const Box& a, const Pose& pose_a, const HalfSpace&, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  const Vec3 n = plane_normal(pose_b);
  const PlacedBox box(a, pose_a);
  for (const BoxSides& corner : face_corners(face_against(box, n))) {
    const Vec3 point = box.at(corner);
    const double gap = n.dot(point - pose_b.position);
    if (gap <= margin) {
      Contact contact = make_contact(point, point - gap * n, n, gap,
                                     feature_pair_id(box_feature(corner), 0), NormalOwner::kFaceB);
      contact.surface_a = LocalSurface::vertex();
      contact.surface_b = LocalSurface::face();
      contacts.push_back(contact);
    }
  }
}

double distance(const HalfSpace&, const Pose& pose_a, const HalfSpace&, const Pose& pose_b) {
  constexpr double kParallel = 1e-12;
  const Vec3 n = plane_normal(pose_b);
  if ((plane_normal(pose_a) + n).norm() > kParallel) {
    return -std::numeric_limits<double>::infinity();
  }
  return n.dot(pose_a.position - pose_b.position);
}

bool test(const HalfSpace& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

void find(const HalfSpace&, const Pose&, const HalfSpace&, const Pose&, double,
          std::vector<Contact>&) {}

}  // namespace signorini::collision::narrow
