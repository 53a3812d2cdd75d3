#include <signorini/core/response/assembly.h>
#include <signorini/core/response/contact_islands.h>

#include <algorithm>

namespace signorini {
namespace {

/// Fills all but the members and the joints, which it renumbers. @param local of every body of the
/// scene: scratch
void fill(const Bodies& bodies, const State& state, const ContactSet& contacts,
          const lcp::VectorRef& allowance, std::vector<int>& local, ContactIsland& island) {
  for (const int i : island.members) {
    island.body.push_back(contacts[i].body_a);
    island.body.push_back(contacts[i].body_b);
  }
  for (const JointRow& row : island.joints) {
    island.body.push_back(row.body_a);
    island.body.push_back(row.body_b);
  }
  std::sort(island.body.begin(), island.body.end());
  island.body.erase(std::unique(island.body.begin(), island.body.end()), island.body.end());
  for (std::size_t k = 0; k < island.body.size(); ++k) {
    const int body = island.body[k];
    local[body] = static_cast<int>(k);
    island.bodies.push_back(bodies[body]);
    island.state.push_back(state[body]);
  }
  island.allowance.resize(static_cast<lcp::Index>(island.members.size()));
  for (std::size_t j = 0; j < island.members.size(); ++j) {
    Contact contact = contacts[island.members[j]];
    contact.body_a = local[contact.body_a];
    contact.body_b = local[contact.body_b];
    island.contacts.push_back(contact);
    island.allowance[static_cast<lcp::Index>(j)] = allowance[island.members[j]];
  }
  for (JointRow& row : island.joints) {
    row.body_a = local[row.body_a];
    row.body_b = local[row.body_b];
  }
}

}  // namespace

std::vector<ContactIsland> contact_islands(const Bodies& bodies, const State& state,
                                           const ContactSet& contacts,
                                           const lcp::VectorRef& allowance,
                                           const std::vector<JointRow>& joints, bool merged) {
  BodyPairs links = body_pairs(contacts);
  const BodyPairs joined = body_pairs(joints);
  links.insert(links.end(), joined.begin(), joined.end());
  const std::vector<int> set_of_link =
      merged ? std::vector<int>(links.size(), 0) : linked_sets(bodies, links);
  std::vector<ContactIsland> islands;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (set_of_link[i] == static_cast<int>(islands.size())) {
      islands.emplace_back();
    }
    ContactIsland& island = islands[set_of_link[i]];
    if (i < contacts.size()) {
      island.members.push_back(static_cast<int>(i));
    } else {
      island.joints.push_back(joints[i - contacts.size()]);
    }
  }
  std::vector<int> local(bodies.size(), -1);
  for (ContactIsland& island : islands) {
    fill(bodies, state, contacts, allowance, local, island);
  }
  return islands;
}

}  // namespace signorini
