#include <signorini/core/response/assembly.h>
#include <signorini/core/response/contact_islands.h>

#include <algorithm>

namespace signorini {
namespace {

/// Fills all but the members. @param local of every body of the scene: scratch
void fill(const Bodies& bodies, const State& state, const ContactSet& contacts,
          const lcp::VectorRef& allowance, std::vector<int>& local, ContactIsland& island) {
  for (const int i : island.members) {
    island.body.push_back(contacts[i].body_a);
    island.body.push_back(contacts[i].body_b);
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
}

}  // namespace

std::vector<ContactIsland> contact_islands(const Bodies& bodies, const State& state,
                                           const ContactSet& contacts,
                                           const lcp::VectorRef& allowance) {
  const std::vector<int> set_of_contact = connected_sets(bodies, contacts);
  std::vector<ContactIsland> islands;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (set_of_contact[i] == static_cast<int>(islands.size())) {
      islands.emplace_back();
    }
    islands[set_of_contact[i]].members.push_back(static_cast<int>(i));
  }
  std::vector<int> local(bodies.size(), -1);
  for (ContactIsland& island : islands) {
    fill(bodies, state, contacts, allowance, local, island);
  }
  return islands;
}

}  // namespace signorini
