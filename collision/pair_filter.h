#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace signorini::collision {

/// Which colliders meet: those whose category is in the other's mask, both ways. SDFormat's
/// `collide_bitmask` m, by which two collide if m_A & m_B is not 0, is category = mask = m.
struct CollisionFilter {
  std::uint32_t category = 1;        ///< what it is: any set of bits
  std::uint32_t mask = 0xffffffffU;  ///< what it meets; 0: nothing

  bool operator==(const CollisionFilter&) const = default;
};

[[nodiscard]] constexpr bool may_collide(const CollisionFilter& a, const CollisionFilter& b) {
  return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

/// Pairs of bodies whose colliders never meet: links of one model, bodies held by a joint.
class IgnoredPairs {
 public:
  IgnoredPairs() = default;
  /// @param pairs of bodies, in any order, either way round; doubles are allowed
  explicit IgnoredPairs(std::vector<std::pair<int, int>> pairs) : pairs_(std::move(pairs)) {
    for (auto& pair : pairs_) {
      pair = std::minmax({pair.first, pair.second});
    }
    std::sort(pairs_.begin(), pairs_.end());
  }

  [[nodiscard]] bool contains(int body_a, int body_b) const {
    return !pairs_.empty() && std::binary_search(pairs_.begin(), pairs_.end(),
                                                 std::pair(std::minmax({body_a, body_b})));
  }
  /// @throws std::invalid_argument naming the first pair with a body outside [0, body_count).
  void validate(int body_count) const {
    for (const auto& [a, b] : pairs_) {
      if (a < 0 || b >= body_count) {
        throw std::invalid_argument("ignored pair of bodies: must be in [0, " +
                                    std::to_string(body_count) + "), got " + std::to_string(a) +
                                    " and " + std::to_string(b));
      }
    }
  }

 private:
  std::vector<std::pair<int, int>> pairs_;  ///< first <= second, sorted
};

}  // namespace signorini::collision
