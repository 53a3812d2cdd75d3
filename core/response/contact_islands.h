#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/response/joint_rows.h>
#include <signorini/lcp/types.h>

#include <span>
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

/// Finds the islands of a contact set. Keeps its memory: allocates nothing once no count exceeds an
/// earlier one of the same island number.
class ContactIslands {
 public:
  /// The islands in the order of their first contact, then those with joints alone in the order of
  /// their first joint: depends on the input alone. Valid until the next call. Cost: O(bodies +
  /// contacts + joints) for all of them.
  /// @param contacts each with a dynamic body. @param allowance one a contact
  /// @param merged all as one island, to check the others against
  std::span<const ContactIsland> find(const Bodies& bodies, const State& state,
                                      const ContactSet& contacts, std::span<const double> allowance,
                                      std::span<const JointRow> joints = {}, bool merged = false);

 private:
  void fill(const Bodies& bodies, const State& state, const ContactSet& contacts,
            std::span<const double> allowance, ContactIsland& island);

  LinkedSets sets_;
  BodyPairs links_;
  std::vector<int> local_;              // of every body of the scene, in the island at hand
  std::vector<ContactIsland> islands_;  // more than the last call found: their memory
};

}  // namespace signorini
