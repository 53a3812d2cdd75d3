#pragma once

#include <signorini/collision/contact_time.h>
#include <signorini/collision/shape.h>
#include <signorini/core/model/contact.h>

#include <vector>

namespace signorini::collision {

/// Test-intersection query: do the two closed shapes share a point? Two half-spaces intersect
/// unless they face each other across a gap.
[[nodiscard]] bool test_intersection(const Shape& a, const Pose& pose_a, const Shape& b,
                                     const Pose& pose_b);

/// Find-intersection query: the reduced contact set, every contact with gap <= margin. Geometry
/// only: body_a = 0, body_b = 1 and no material; feature_id is of the pair of features alone.
///
/// Face-face: the incident face clipped against the reference face (its vertices inside, and the
/// crossings of the edges). Edge-face: the end points (or clipped ends) of the edge. Edge-edge, not
/// parallel: the one point pair of closest approach. Exchange of A and B gives the same points with
/// N reversed. Two half-spaces: none are reported (both are immovable).
/// @param margin m, >= 0
void find_intersection(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                       double margin, std::vector<Contact>& contacts);

/// Signed distance: > 0 apart (the distance), < 0 overlapping (minus the least translation that
/// ends the overlap).
[[nodiscard]] double signed_distance(const Shape& a, const Pose& pose_a, const Shape& b,
                                     const Pose& pose_b);

}  // namespace signorini::collision
