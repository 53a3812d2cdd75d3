#include <signorini/core/response/assembly.h>
#include <signorini/core/response/contact_islands.h>

#include <algorithm>

namespace signorini {

/// Fills all but the members and the joints, which it renumbers.
void ContactIslands::fill(const Bodies& bodies, const State& state, const ContactSet& contacts,
                          std::span<const double> allowance, ContactIsland& island) {
  island.body.clear();
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
  island.bodies.resize(island.body.size());
  island.state.clear();
  for (std::size_t k = 0; k < island.body.size(); ++k) {
    const int body = island.body[k];
    local_[body] = static_cast<int>(k);
    island.bodies[k] = bodies[body];
    island.state.push_back(state[body]);
  }
  island.contacts.clear();
  island.allowance.resize(static_cast<lcp::Index>(island.members.size()));
  for (std::size_t j = 0; j < island.members.size(); ++j) {
    Contact contact = contacts[island.members[j]];
    contact.body_a = local_[contact.body_a];
    contact.body_b = local_[contact.body_b];
    island.contacts.push_back(contact);
    island.allowance[static_cast<lcp::Index>(j)] = allowance[island.members[j]];
  }
  for (JointRow& row : island.joints) {
    row.body_a = local_[row.body_a];
    row.body_b = local_[row.body_b];
  }
}

std::span<const ContactIsland> ContactIslands::find(const Bodies& bodies, const State& state,
                                                    const ContactSet& contacts,
                                                    std::span<const double> allowance,
                                                    std::span<const JointRow> joints, bool merged) {
  links_.clear();
  add_body_pairs(contacts, links_);
  add_body_pairs(joints, links_);
  const std::vector<int>& set_of_link = sets_.find(bodies, links_);
  std::size_t count = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const std::size_t set = merged ? 0 : static_cast<std::size_t>(set_of_link[i]);
    if (set == count) {
      if (count == islands_.size()) {
        islands_.emplace_back();
      }
      islands_[count].members.clear();
      islands_[count].joints.clear();
      ++count;
    }
    if (i < contacts.size()) {
      islands_[set].members.push_back(static_cast<int>(i));
    } else {
      islands_[set].joints.push_back(joints[i - contacts.size()]);
    }
  }
  local_.resize(bodies.size());
  for (std::size_t k = 0; k < count; ++k) {
    fill(bodies, state, contacts, allowance, islands_[k]);
  }
  return {islands_.data(), count};
}

}  // namespace signorini
