#pragma once

#include <signorini/collision/convex_contacts.h>
#include <signorini/collision/convex_shapes.h>
#include <signorini/collision/narrow.h>
#include <signorini/collision/separation.h>

#include <concepts>
#include <vector>

namespace signorini::collision::narrow {

/// The shapes that meet every other convex shape, and a half-space, through their cores
/// (separation.h, convex_contacts.h).
template <class S>
concept RoundOrHull = std::same_as<S, Capsule> || std::same_as<S, Cylinder> ||
    std::same_as<S, Cone> || std::same_as<S, Ellipsoid> || std::same_as<S, ConvexHull>;
template <class S>
concept Simple = std::same_as<S, Sphere> || std::same_as<S, Box>;

template <class A, class B>
concept ConvexPair = RoundOrHull<B> &&(RoundOrHull<A> || Simple<A>);

template <class A, class B>
requires ConvexPair<A, B>
[[nodiscard]] double distance(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b) {
  return collision::distance(core_of(a, pose_a), core_of(b, pose_b));
}

template <class A, class B>
requires ConvexPair<A, B>
[[nodiscard]] bool test(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b) {
  return overlap(core_of(a, pose_a), core_of(b, pose_b));
}

template <class A, class B>
requires ConvexPair<A, B>
void find(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  find_contacts(core_of(a, pose_a), core_of(b, pose_b), margin, contacts);
}

/// -h(-n) over the plane.
template <RoundOrHull A>
[[nodiscard]] double distance(const A& a, const Pose& pose_a, const HalfSpace&,
                              const Pose& pose_b) {
  const auto core = core_of(a, pose_a);
  const Vec3 n = pose_b.orientation * Vec3::UnitZ();
  return n.dot(core.support(-n) - pose_b.position) - core.rounding();
}

template <RoundOrHull A>
[[nodiscard]] bool test(const A& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b) {
  return distance(a, pose_a, b, pose_b) <= 0.0;
}

/// The corners of the facet that faces the plane most, and the lowest point where it is lower than
/// they by more than 1e-6 of the size (a tilted rim); owner: the plane.
template <RoundOrHull A>
void find(const A& a, const Pose& pose_a, const HalfSpace&, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  find_contacts(core_of(a, pose_a), pose_b.orientation * Vec3::UnitZ(), pose_b.position, margin,
                contacts);
}

}  // namespace signorini::collision::narrow
