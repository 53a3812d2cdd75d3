#pragma once

#include <signorini/collision/convex.h>

#include <vector>

namespace signorini::collision {

/// A point at which two facets lie over each other.
struct FacetPoint {
  Vec3 on_incident = Vec3::Zero();
  Vec3 on_reference = Vec3::Zero();  ///< on_incident = on_reference + height * reference normal
  double height = 0.0;               ///< m
  Feature incident = 0;
  Feature reference = 0;
  LocalSurface surface;  ///< of the incident shape
};

/// Is the point over the facet, up to `slack` (m) beside it? @pre a polygon or disc
[[nodiscard]] bool is_over(const Facet& reference, const Vec3& point, double slack);

/// The incident facet clipped against the prism (or round column) over the reference facet: the
/// corners of the incident facet over the reference facet, the crossings of their boundaries, and
/// the reference facet's corners over the incident one. A disc's corners are 8 points of its rim;
/// its boundary is the whole circle, so that a polygon's crossings with it are exact. Polygon and
/// polygon: Sutherland and Hodgman 1974. Allocates nothing once no facet has more corners than an
/// earlier one of this thread.
/// @param reference a polygon or disc
/// @param slack m, >= 0: corners that lie this far beside count as over, so that rounding does not
/// move the corners of faces that are flush; crossings lie on the boundaries themselves
/// @param points replaced
void clip_facet(const Facet& incident, const Facet& reference, double slack,
                std::vector<FacetPoint>& points);

}  // namespace signorini::collision
