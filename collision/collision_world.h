#pragma once

#include <signorini/collision/broad_phase.h>
#include <signorini/collision/contact_reduction.h>
#include <signorini/collision/known_contacts.h>
#include <signorini/collision/pair_filter.h>
#include <signorini/collision/shape.h>
#include <signorini/core/model/contact_finder.h>

#include <utility>
#include <vector>

namespace signorini::collision {

/// Wall time of a find(), s.
struct FindSeconds {
  double broad = 0.0;   ///< poses, bounds, and the pairs whose bounds overlap
  double narrow = 0.0;  ///< these pairs' contacts
};

/// The colliders of a scene: makes contact sets and contact times for a stepper. Skipped are pairs
/// of which no body is dynamic (fixed and kinematic bodies do not push each other), pairs of one
/// body, and what the filters leave out (pair_filter.h). In each contact A is the body of the
/// collider that comes first. Contacts come in the order of the collider pairs, whatever their
/// poses and whatever was found before. A feature_id depends on the two colliders' numbers and the
/// features alone.
///
/// Cost: the broad phase finds the pairs whose bounds overlap (broad_phase.h); each costs one pair
/// query, but where neither collider has moved since the last find() (to the bit, as bodies asleep)
/// its contacts are known. Colliders without bounds (half-spaces) meet every other one. find()
/// allocates nothing of
/// its own once no count exceeds an earlier one.
class CollisionWorld final : public ContactFinder {
 public:
  /// @throws std::invalid_argument naming the collider and the field: see validate(Collider), and a
  /// half-space must not belong to a dynamic body.
  /// Ignored pairs: see IgnoredPairs.
  CollisionWorld(const Bodies& bodies, std::vector<Collider> colliders, PairingRule rule,
                 IgnoredPairs ignored = {});

  /// @throws std::invalid_argument naming the body and the field: state as long as the bodies,
  /// poses finite, unit quaternions to 1e-6, margin >= 0 and finite.
  void find(const State& state, double margin, ContactSet& contacts) override;

  /// The earliest contact_time() of all pairs; of equal ones the first pair.
  /// @throws std::invalid_argument: motions one a body, none null; duration finite and >= 0.
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const> motions,
                                                          double duration,
                                                          RestingPairs resting) override;
  using ContactFinder::first_contact;

  /// From now on find() keeps at most this many contacts of a patch, by reduce_contacts(); 0 (the
  /// default): all, which the solvers do not mind.
  /// @throws std::invalid_argument naming the value: 0 or >= 3
  void keep_at_most(int contacts_of_a_patch);
  /// What the last find() left out; all 0 while every contact is kept.
  [[nodiscard]] const ReductionLoss& reduction_loss() const { return loss_; }
  /// Pair queries of the last find().
  [[nodiscard]] int pairs_asked() const { return pairs_asked_; }
  /// Of the last find().
  [[nodiscard]] const FindSeconds& find_seconds() const { return find_seconds_; }

  [[nodiscard]] const std::vector<Collider>& colliders() const { return colliders_; }

 private:
  [[nodiscard]] bool may_touch(int collider_a, int collider_b) const;
  [[nodiscard]] Vec3 friction_direction(int collider_a, int collider_b) const;
  ReductionLoss ask(const std::pair<int, int>& colliders, double margin);

  std::vector<Collider> colliders_;
  std::vector<bool> is_dynamic_;  ///< by body
  PairingRule rule_;
  IgnoredPairs ignored_;
  std::vector<std::uint8_t> is_immovable_;  ///< by collider
  int most_of_a_patch_ = 0;                 ///< 0: all
  ReductionLoss loss_;
  int pairs_asked_ = 0;
  FindSeconds find_seconds_;

  BroadPhase broad_phase_;  // from here on workspace
  std::vector<Pose> poses_;
  std::vector<Bounds> bounds_;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<Contact> found_;
  KnownContacts known_;
};

}  // namespace signorini::collision
