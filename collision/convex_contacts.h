#pragma once

#include <signorini/collision/convex.h>
#include <signorini/collision/separation.h>

#include <vector>

namespace signorini::collision {

/// The contact set of two convex shapes, every contact with gap <= margin, by separate():
/// - a face of A or B (the larger one of several): the other shape's facet that faces it, clipped
///   against it; owner: the face. The other shape's corners count as points of its body, a
///   capsule's ends as balls, a rim's lowest point as a point of the rim. Where the clipped facet
///   misses the deepest point by more than preference_tolerance() (a tilted rim) that point is
///   added;
/// - two parallel lines (edges, generators, axes of capsules): the ends of their overlap, kCurved;
/// - two crossing edges: one point, kEdgeEdge;
/// - else the one pair of nearest (or deepest) points, kCurved with the curvature of both surfaces.
/// @param contacts are added to
void find_contacts(const Convex& a, const Convex& b, double margin, std::vector<Contact>& contacts);

/// The same from what separate() said. @param found by separate(a, b)
void find_contacts(const Convex& a, const Convex& b, const Separation& found, double margin,
                   std::vector<Contact>& contacts);

/// The contacts of a given face of A or B alone, as above.
void find_contacts_on_face(const Convex& a, const Convex& b, const FacingFace& face, double margin,
                           std::vector<Contact>& contacts);

/// The same against a plane through `on_plane` with the outward normal n, which is B.
void find_contacts(const Convex& a, const Vec3& n, const Vec3& on_plane, double margin,
                   std::vector<Contact>& contacts);

}  // namespace signorini::collision
