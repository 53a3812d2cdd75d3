#pragma once

#include <signorini/collision/narrow.h>

#include <vector>

namespace signorini::collision::narrow {

// Sphere and X: one contact, between the sphere's point and the point of X nearest to its centre.

/// Centres that coincide: N = +z of the world.
[[nodiscard]] double distance(const Sphere& a, const Pose& pose_a, const Sphere& b,
                              const Pose& pose_b);
[[nodiscard]] bool test(const Sphere& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b);
void find(const Sphere& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts);

/// A centre in the box (its surface included) leaves through the nearest face; of equally near ones
/// through the one of the lowest axis, high side first.
[[nodiscard]] double distance(const Sphere& a, const Pose& pose_a, const Box& b,
                              const Pose& pose_b);
[[nodiscard]] bool test(const Sphere& a, const Pose& pose_a, const Box& b, const Pose& pose_b);
void find(const Sphere& a, const Pose& pose_a, const Box& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts);

[[nodiscard]] double distance(const Sphere& a, const Pose& pose_a, const HalfSpace& b,
                              const Pose& pose_b);
[[nodiscard]] bool test(const Sphere& a, const Pose& pose_a, const HalfSpace& b,
                        const Pose& pose_b);
void find(const Sphere& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b,
          double margin, std::vector<Contact>& contacts);

}  // namespace signorini::collision::narrow
