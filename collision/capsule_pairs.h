#pragma once

#include <signorini/collision/narrow.h>

#include <vector>

namespace signorini::collision::narrow {

/// Sphere and capsule: from the nearest point of the segment; one contact, owner kCurved. A centre
/// on the segment: the normal is any across it.
[[nodiscard]] double distance(const Sphere& a, const Pose& pose_a, const Capsule& b,
                              const Pose& pose_b);
[[nodiscard]] bool test(const Sphere& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b);
void find(const Sphere& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts);

/// Two capsules: from the nearest points of the segments, one contact; the two ends of the overlap
/// where the segments are parallel to 1e-7 rad and face each other. Segments that meet: the normal
/// is across both, or any across them where they are parallel.
[[nodiscard]] double distance(const Capsule& a, const Pose& pose_a, const Capsule& b,
                              const Pose& pose_b);
[[nodiscard]] bool test(const Capsule& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b);
void find(const Capsule& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts);

}  // namespace signorini::collision::narrow
