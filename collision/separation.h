#pragma once

#include <signorini/collision/convex.h>

#include <optional>
#include <vector>

namespace signorini::collision {

/// A face along whose normal two shapes are apart as far as along any direction, to
/// preference_tolerance().
struct FacingFace {
  bool of_a = false;
  Vec3 normal = Vec3::UnitZ();  ///< from B to A
  double separation = 0.0;      ///< of the rounded shapes along it, m
};

/// A direction, and a piece of each surface that carries it.
struct Meeting {
  Vec3 normal = Vec3::UnitZ();  ///< N, unit, from B to A
  Stratum a;                    ///< carries -N on A
  Stratum b;                    ///< carries N on B
};

/// The direction along which two shapes are furthest apart, and the pieces of surface that meet.
struct Separation {
  double distance = 0.0;  ///< of the rounded shapes, m; < 0: overlap
  /// Those along which they are apart by the distance, to 1e-9 of the smaller size; of pairs of
  /// pieces that determine their normal more sharply first. Not all of them do meet: two lines may
  /// cross beyond their ends. Not empty.
  std::vector<Meeting> meetings;
  std::optional<FacingFace> face;  ///< of several the largest face
};

/// 1e-6 of the smaller size: below it separations count as equal when the direction of a contact
/// set is chosen, faces first, so that rounding and the jitter of resting stacks do not choose.
/// Shapes that are apart must besides lie no further than this beside each other, as the face sees
/// them.
[[nodiscard]] double preference_tolerance(const Convex& a, const Convex& b);

/// A face along which two shapes are apart by `separation` counts as one along which they are as
/// far apart as they are (`largest`): to preference_tolerance(), and to rounding.
[[nodiscard]] bool is_as_far(const Convex& a, const Convex& b, double largest, double separation);

/// Of two faces with equal separation the larger; of equal ones that of the shape which lies lower
/// along a direction that no scene is aligned with. The rule gives the same shape when A and B are
/// exchanged.
/// @param area_p, area_q of the faces, m^2
[[nodiscard]] bool prefers(const FacingFace& p, double area_p, const FacingFace& q, double area_q);

/// The signed distance d = max s(n), over unit n, of s(n) = -h_A(-n) - h_B(n): apart, the distance;
/// overlapping, minus the least translation that parts them.
///
/// GJK (apart) or an expanding polytope (nearly touching, overlapping) comes near the maximum; then
/// every pair of pieces of surface near it is tried, s being smooth on each:
/// - a face: n is its normal; two lines: n.axis_A = -slope_A and n.axis_B = slope_B;
/// - a line and a free piece: Newton on the circle n.axis = slope, s'' = W.n'' - n'.rho n';
/// - two free pieces: Newton on the sphere, (rho_A + rho_B + n.W) dn = W_T,
/// with W the difference of the two pieces' points and rho their radii of curvature; the n with the
/// largest s wins. Every s(n) is a lower bound of d whatever n was found, so that none of it can
/// make the distance too large; d is within some tens of roundings of the sizes, except that of
/// translations whose lengths differ by less than 1e-8 of the smaller size either may be returned.
/// Besides, where one start would miss the best of many directions that are nearly as good:
/// - shapes of which one is more than 30 times as large, and whose cores all but touch, are looked
///   at along the normals of all pieces within 1.6 rad (the polytope's rounding hides the best);
/// - so is, from 26 directions, a shape that lies deep in another one, if the polytope's points ran
///   out before it was certain;
/// - rims of shapes apart, where GJK stopped short of 1e-9 of the smaller size: rims.h.
/// Allocates nothing once no shape has more pieces near a direction than an earlier one of this
/// thread.
/// Two polyhedra come here only where separate_polyhedra() leaves them.
/// @param separation replaced
/// @pre not both cores are points or segments
void separate(const Convex& a, const Convex& b, Separation& separation);

/// The signed distance alone.
[[nodiscard]] double distance(const Convex& a, const Convex& b);

/// distance(a, b) <= 0, with an early end where GJK decides.
[[nodiscard]] bool overlap(const Convex& a, const Convex& b);

/// s(n): how far apart the rounded shapes are along n.
[[nodiscard]] double separation_along(const Convex& a, const Convex& b, const Vec3& n);

}  // namespace signorini::collision
