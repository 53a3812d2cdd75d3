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
/// only: body_a = 0, body_b = 1 and no material; feature_id is of the pair of features alone
/// (feature_id.h). Not empty exactly where signed_distance() <= margin; the least gap is that
/// distance (box and box: to 1e-6 of the smaller box's half diagonal, box_separation.h says why).
///
/// Face-face: the incident face clipped against the reference face (its vertices inside, the
/// crossings of the edges, and the reference face's vertices inside it). Edge-face: the end points
/// (or clipped ends) of the edge. Edge-edge, not parallel: the one point pair of closest approach.
/// Apart, and nearest at vertices or at a vertex and an edge: these points, with the direction
/// between them as N. Exchange of A and B gives the same points with N reversed. All contacts of a
/// pair share one N. Two half-spaces: none are reported (both are immovable).
/// @param margin m, >= 0, may be +infinity
/// @param contacts are replaced
/// @throws std::invalid_argument naming the field, its value and the bound, before anything is
/// changed; so do the other two queries
/// Cost on one core: 30 ns (sphere and half-space) to 0.8 us (overlapping boxes).
void find_intersection(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                       double margin, std::vector<Contact>& contacts);

/// Signed distance: > 0 apart (the distance), < 0 overlapping (minus the least translation that
/// ends the overlap).
[[nodiscard]] double signed_distance(const Shape& a, const Pose& pose_a, const Shape& b,
                                     const Pose& pose_b);

}  // namespace signorini::collision
