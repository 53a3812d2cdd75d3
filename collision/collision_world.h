#pragma once

#include <signorini/collision/shape.h>
#include <signorini/core/model/contact_finder.h>

#include <utility>
#include <vector>

namespace signorini::collision {

/// The colliders of a scene: makes contact sets and contact times for a stepper. Pairs of which no
/// body is dynamic, and pairs of one body, are skipped. In each contact A is the body of the
/// collider that comes first. Contacts come in the order of the collider pairs, whatever their
/// poses. A feature_id depends on the two colliders' numbers and the features alone.
///
/// Cost: one pass over the colliders sorted along an axis finds the pairs whose bounds overlap;
/// each costs one pair query. Colliders without bounds (half-spaces) meet every other one.
class CollisionWorld final : public ContactFinder {
 public:
  /// @throws std::invalid_argument naming the collider and the field: see validate(Collider), and a
  /// half-space must not belong to a dynamic body.
  CollisionWorld(const Bodies& bodies, std::vector<Collider> colliders, PairingRule rule);

  /// @throws std::invalid_argument naming the body and the field: state as long as the bodies,
  /// poses finite, unit quaternions to 1e-6, margin >= 0 and finite.
  void find(const State& state, double margin, ContactSet& contacts) override;

  /// The earliest contact_time() of all pairs; of equal ones the first pair.
  /// @throws std::invalid_argument: motions one a body, none null; duration finite and >= 0.
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const> motions,
                                                          double duration) override;

  [[nodiscard]] const std::vector<Collider>& colliders() const { return colliders_; }

 private:
  [[nodiscard]] bool may_touch(int collider_a, int collider_b) const;

  std::vector<Collider> colliders_;
  std::vector<bool> is_dynamic_;  ///< by body
  PairingRule rule_;
  std::vector<std::pair<int, int>> pairs_;  ///< workspace
  std::vector<Contact> found_;              ///< workspace
};

}  // namespace signorini::collision
