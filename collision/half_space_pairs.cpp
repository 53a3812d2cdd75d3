#include <signorini/collision/box_geometry.h>
#include <signorini/collision/half_space_pairs.h>

#include <algorithm>
#include <array>
#include <limits>

namespace signorini::collision::narrow {
namespace {

Vec3 plane_normal(const Pose& pose) {
  return pose.orientation * Vec3::UnitZ();
}

/// The corners of the face of the box that faces the plane most, one of which is the lowest.
struct LowFace {
  Vec3 n;  ///< of the plane
  std::array<BoxSides, 4> corners;
  std::array<Vec3, 4> points;
  std::array<double, 4> gaps;

  LowFace(const Box& a, const Pose& pose_a, const Pose& plane) : n(plane_normal(plane)) {
    const PlacedBox box(a, pose_a);
    corners = face_corners(face_against(box, n));
    for (int k = 0; k < 4; ++k) {
      points[k] = box.at(corners[k]);
      gaps[k] = n.dot(points[k] - plane.position);
    }
  }
};

}  // namespace

double distance(const Box& a, const Pose& pose_a, const HalfSpace&, const Pose& pose_b) {
  const LowFace face(a, pose_a, pose_b);
  return *std::min_element(face.gaps.begin(), face.gaps.end());
}

bool test(const Box& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

void find(const Box& a, const Pose& pose_a, const HalfSpace&, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  const LowFace face(a, pose_a, pose_b);
  for (int k = 0; k < 4; ++k) {
    const double gap = face.gaps[k];
    if (gap <= margin) {
      Contact contact =
          make_contact(face.points[k], face.points[k] - gap * face.n, face.n, gap,
                       feature_pair_id(box_feature(face.corners[k]), 0), NormalOwner::kFaceB);
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
