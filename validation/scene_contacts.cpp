#include <signorini/validation/scene_contacts.h>

#include <algorithm>

namespace signorini::validation {

SceneContacts::SceneContacts(const Scene& scene)
    : world_(scene.bodies, scene.colliders, scene.rule,
             collision::IgnoredPairs(scene.never_collide)) {}

void SceneContacts::find(const State& state, double margin, ContactSet& contacts) {
  world_.find(state, margin, contacts);
}

std::optional<FirstContact> SceneContacts::first_contact(std::span<const Motion* const> motions,
                                                         double duration, RestingPairs resting) {
  return world_.first_contact(motions, duration, resting);
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
