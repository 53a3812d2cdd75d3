#include <signorini/collision/capsule_pairs.h>
#include <signorini/collision/convex_shapes.h>
#include <signorini/collision/segments.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace signorini::collision::narrow {
namespace {

/// Segments within this angle (radians) of parallel touch along a stretch, not in a point.
constexpr double kParallelSegments = 1e-7;

/// A sphere's centre (half = 0) or a capsule's segment, and its radius.
struct RoundedSegment : LineSegment {
  double radius;

  RoundedSegment(const Sphere& sphere, const Pose& pose)
      : LineSegment{pose.position}, radius(sphere.radius) {}
  RoundedSegment(const Capsule& capsule, const Pose& pose)
      : LineSegment{pose.position, pose.orientation * Vec3::UnitZ(), capsule.half_length},
        radius(capsule.radius) {}

  [[nodiscard]] LocalSurface surface(double t) const {
    if (half == 0.0 || std::abs(t) == half) {
      return LocalSurface::sphere(radius);
    }
    LocalSurface surface = LocalSurface::edge(axis);
    surface.radius_across = radius;
    return surface;
  }
};

Vec3 normal_of(const RoundedSegment& a, const RoundedSegment& b, const SegmentPoints& nearest) {
  if (!nearest.between.isZero(0.0)) {  // twice: denormal numbers lose digits in the first
    return nearest.between.stableNormalized().normalized();
  }
  const Vec3 across = a.half == 0.0 ? Vec3(b.axis.unitOrthogonal()) : Vec3(a.axis.cross(b.axis));
  return across.norm() > kParallelSegments ? Vec3(across.normalized()) : a.axis.unitOrthogonal();
}

double gap_of(const RoundedSegment& a, const RoundedSegment& b, const SegmentPoints& nearest) {
  return nearest.between.stableNorm() - (a.radius + b.radius);
}

void add(const RoundedSegment& a, const RoundedSegment& b, const SegmentPoints& nearest,
         const Vec3& N, double gap, std::vector<Contact>& contacts) {
  const Vec3 point_a = a.at(nearest.s) - a.radius * N;
  Contact contact = make_contact(
      point_a, point_a - gap * N, N, gap,
      feature_pair_id(feature_at(a, nearest.s), feature_at(b, nearest.t)), NormalOwner::kCurved);
  contact.surface_a = a.surface(nearest.s);
  contact.surface_b = b.surface(nearest.t);
  contacts.push_back(contact);
}

/// The ends of the stretch along which two parallel segments face each other: of A along itself.
bool overlap_of(const RoundedSegment& a, const RoundedSegment& b, std::array<double, 2>& stretch) {
  const double centre = a.axis.dot(b.centre - a.centre);
  stretch = {std::max(-a.half, centre - b.half), std::min(a.half, centre + b.half)};
  return stretch[0] < stretch[1];
}

void find_between(const RoundedSegment& a, const RoundedSegment& b, double margin,
                  std::vector<Contact>& contacts) {
  const SegmentPoints nearest = nearest_points(a, b);
  const double gap = gap_of(a, b, nearest);
  if (gap > margin) {
    return;
  }
  const Vec3 N = normal_of(a, b, nearest);
  std::array<double, 2> stretch{};
  if (a.half == 0.0 || b.half == 0.0 || a.axis.cross(b.axis).norm() > kParallelSegments ||
      !overlap_of(a, b, stretch)) {
    add(a, b, nearest, N, gap, contacts);
    return;
  }
  const std::size_t before = contacts.size();
  for (const double s : stretch) {
    // The end is of A or of B; the other's parameter must name its end exactly.
    const double t = b.nearest_to(a.at(s));
    const bool is_end_of_a = std::abs(s) == a.half;
    const double end_b =
        b.axis.dot(a.axis) * (s - a.axis.dot(b.centre - a.centre)) < 0.0 ? -b.half : b.half;
    const SegmentPoints end(a, s, b, is_end_of_a ? t : end_b);
    const double end_gap = N.dot(end.between) - (a.radius + b.radius);
    if (end_gap <= std::max(margin, gap)) {
      add(a, b, end, N, end_gap, contacts);
    }
  }
  if (contacts.size() == before) {  // rounding put both ends above the margin
    add(a, b, nearest, N, gap, contacts);
  }
}

}  // namespace

double distance(const Sphere& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b) {
  const RoundedSegment centre(a, pose_a);
  const RoundedSegment segment(b, pose_b);
  return gap_of(centre, segment, nearest_points(centre, segment));
}

bool test(const Sphere& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

void find(const Sphere& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  find_between(RoundedSegment(a, pose_a), RoundedSegment(b, pose_b), margin, contacts);
}

double distance(const Capsule& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b) {
  const RoundedSegment first(a, pose_a);
  const RoundedSegment second(b, pose_b);
  return gap_of(first, second, nearest_points(first, second));
}

bool test(const Capsule& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

void find(const Capsule& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  find_between(RoundedSegment(a, pose_a), RoundedSegment(b, pose_b), margin, contacts);
}

}  // namespace signorini::collision::narrow
