#pragma once

#include <signorini/collision/collision_world.h>
#include <signorini/validation/scene.h>

namespace signorini::validation {

/// The contacts of a scene: its colliders, without the pairs that never collide.
class SceneContacts final : public ContactFinder {
 public:
  explicit SceneContacts(const Scene& scene);

  void find(const State& state, double margin, ContactSet& contacts) override;
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const> motions,
                                                          double duration,
                                                          RestingPairs resting) override;

 private:
  collision::CollisionWorld world_;
};

/// Overlap of a state, measured the same way for every engine.
struct OverlapMeasure {
  double deepest = 0.0;  ///< max(0, -gap), m
  int contacts = 0;      ///< with gap <= 0
};
[[nodiscard]] OverlapMeasure measure_overlap(SceneContacts& contacts, const State& state);

}  // namespace signorini::validation
