#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/response/joint_rows.h>
#include <signorini/lcp/types.h>

#include <vector>

namespace signorini {

/// A connected set of contacts and joints with the bodies that they touch, numbered anew from 0: a
/// problem of its own. Fixed and driven bodies connect nothing and are in every island that touches
/// them.
struct ContactIsland {
  std::vector<int> members;  ///< the contacts, by their number in the whole set, ascending
  std::vector<int> body;     ///< number in the whole scene of each body here, ascending
  Bodies bodies;
  State state;
  ContactSet contacts;    ///< with the island's body numbers
  lcp::Vector allowance;  ///< one a contact, m/s
  /// Rows of joints with the island's body numbers; JointRow::joint stays the scene's.
  std::vector<JointRow> joints;
};

/// The islands in the order of their first contact, then those with joints alone in the order of
/// their first joint: depends on the input alone. Cost: O(bodies +
/// contacts + joints) for all of them.
/// @param contacts each with a dynamic body. @param allowance one a contact
/// @param merged all as one island, to check the others against
[[nodiscard]] std::vector<ContactIsland> contact_islands(const Bodies& bodies, const State& state,
                                                         const ContactSet& contacts,
                                                         const lcp::VectorRef& allowance,
                                                         const std::vector<JointRow>& joints = {},
                                                         bool merged = false);

}  // namespace signorini
