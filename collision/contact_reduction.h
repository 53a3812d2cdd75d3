#pragma once

#include <signorini/core/model/contact.h>

#include <vector>

namespace signorini::collision {

/// What a reduction left out.
struct ReductionLoss {
  int points = 0;            ///< contacts left out
  double area_before = 0.0;  ///< of the patches, each seen along its normal, m^2
  double area_after = 0.0;
};

/// Fewer contacts, at a measured loss. The contacts of one pair of bodies whose normals agree to
/// 1e-6 are a patch, and its area is that of their convex hull, seen along the normal. Of each
/// patch these stay, in their order:
///
/// 1. the corners of that hull. Without friction nothing is lost by the others: the row [N, r x N]
///    of a contact is linear in where the normal's line of action passes, so that of a point inside
///    is a convex combination of those of the corners, and the forces' resultants are the same
///    cone;
/// 2. the deepest point, wherever it lies; any corner that is as deep to 1e-6 of the patch's
/// diameter
///    serves as well, so that rounding adds and removes nothing;
/// 3. if these are more than `most`: corners leave one after another, each time the one that costs
///    the least area (the triangle with its neighbours; of equal ones to 1e-6 of the patch's area
///    the one with the largest feature id), the last one that is so deep never.
///
/// Step 3 loses what the area says: torques beyond the smaller patch are no longer carried. Cost:
/// (contacts)^2. Allocates nothing once no set is larger than an earlier one of this thread.
///
/// @param most of a patch, >= 3
/// @throws std::invalid_argument naming `most` and the bound, before anything is changed
ReductionLoss reduce_contacts(std::vector<Contact>& contacts, int most);

}  // namespace signorini::collision
