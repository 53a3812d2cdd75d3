#pragma once

#include <signorini/collision/contact_reduction.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace signorini::collision {

/// The contacts of the last find(), so that pairs that stand still, as those asleep do, are not
/// asked again: poses that are the same to the bit have the same contacts to the bit.
///
/// One find(): begin(), then for each pair in ascending order look_up() or, where that gives
/// nothing, a query; and keep() either way. Allocates nothing once no count exceeds an earlier one.
class KnownContacts {
 public:
  struct Pair {
    std::pair<int, int> colliders;
    ReductionLoss loss;
    std::size_t first = 0;  ///< of its contacts
    std::size_t count = 0;
  };

  /// @param poses of the colliders now
  /// @param margin of this find(), m; another one than the last asks every pair
  void begin(const std::vector<Pose>& poses, double margin);
  /// What the last find() kept of a pair of which neither collider has moved; else nullptr.
  [[nodiscard]] const Pair* look_up(std::pair<int, int> colliders);
  [[nodiscard]] std::span<const Contact> contacts(const Pair& pair) const {
    return {contacts_before_.data() + pair.first, pair.count};
  }
  /// Ends what look_up() and contacts() gave.
  void keep(std::pair<int, int> colliders, const ReductionLoss& loss,
            std::span<const Contact> contacts);
  /// Every pair is asked by the next find().
  void forget() { pairs_.clear(); }

 private:
  double margin_ = -1.0;
  std::vector<Pose> poses_;
  std::vector<std::uint8_t> stands_still_;  ///< by collider
  std::vector<Pair> pairs_, pairs_before_;
  std::vector<Contact> contacts_, contacts_before_;
  std::size_t next_ = 0;  ///< in pairs_before_
};

}  // namespace signorini::collision
