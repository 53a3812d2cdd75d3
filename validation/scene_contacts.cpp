#include <signorini/validation/scene_contacts.h>

#include <algorithm>
#include <stdexcept>

namespace signorini::validation {

SceneContacts::SceneContacts(const Scene& scene)
    : world_(scene.bodies, scene.colliders, scene.rule), never_collide_(scene.never_collide) {}

void SceneContacts::find(const State& state, double margin, ContactSet& contacts) {
  world_.find(state, margin, contacts);
  if (never_collide_.empty()) return;
  std::erase_if(contacts, [this](const Contact& contact) {
    return std::binary_search(never_collide_.begin(), never_collide_.end(),
                              std::minmax({contact.body_a, contact.body_b}));
  });
}

std::optional<FirstContact> SceneContacts::first_contact(std::span<const Motion* const> motions,
                                                         double duration) {
  if (!never_collide_.empty()) {
    throw std::logic_error("contact times of a scene whose links do not all collide");
  }
  return world_.first_contact(motions, duration);
}

OverlapMeasure measure_overlap(SceneContacts& contacts, const State& state) {
  ContactSet found;
  contacts.find(state, 0.0, found);
  OverlapMeasure measure;
  measure.contacts = static_cast<int>(found.size());
  for (const Contact& contact : found) measure.deepest = std::max(measure.deepest, -contact.gap);
  return measure;
}

}  // namespace signorini::validation
