#pragma once

#include <signorini/collision/shape.h>
#include <signorini/core/model/contact_finder.h>

#include <vector>

namespace signorini::collision {

/// The colliders of a scene: makes contact sets and contact times for a stepper. Pairs of which no
/// body is dynamic, and pairs of one body, are skipped. Contacts come in an order that depends on
/// the colliders' order alone.
class CollisionWorld final : public ContactFinder {
 public:
  /// @throws std::invalid_argument naming the collider and the field.
  CollisionWorld(const Bodies& bodies, std::vector<Collider> colliders, PairingRule rule);

  void find(const State& state, double margin, ContactSet& contacts) override;
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const> motions,
                                                          double duration) override;

  [[nodiscard]] const std::vector<Collider>& colliders() const { return colliders_; }

 private:
  std::vector<Collider> colliders_;
  std::vector<std::pair<int, int>> pairs_;
  PairingRule rule_;
};

}  // namespace signorini::collision
