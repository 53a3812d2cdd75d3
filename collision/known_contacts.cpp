#include <signorini/collision/known_contacts.h>

#include <algorithm>
#include <bit>

namespace signorini::collision {
namespace {

/// A zero of the other sign is another pose: its contacts may differ in the signs of zeros.
template <class Numbers>
bool is_same(const Numbers& p, const Numbers& q) {
  return std::equal(p.data(), p.data() + p.size(), q.data(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

bool is_same(const Pose& p, const Pose& q) {
  return is_same(p.position, q.position) && is_same(p.orientation.coeffs(), q.orientation.coeffs());
}

}  // namespace

void KnownContacts::begin(const std::vector<Pose>& poses, double margin) {
  stands_still_.assign(poses.size(), 0);
  if (margin == margin_ && poses.size() == poses_.size()) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      stands_still_[i] = is_same(poses[i], poses_[i]) ? 1 : 0;
    }
  }
  margin_ = margin;
  poses_ = poses;
  std::swap(pairs_, pairs_before_);
  std::swap(contacts_, contacts_before_);
  pairs_.clear();
  contacts_.clear();
  next_ = 0;
}

const KnownContacts::Pair* KnownContacts::look_up(std::pair<int, int> colliders) {
  while (next_ < pairs_before_.size() && pairs_before_[next_].colliders < colliders) {
    ++next_;
  }
  const bool is_known = next_ < pairs_before_.size() &&
                        pairs_before_[next_].colliders == colliders &&
                        stands_still_[colliders.first] != 0 && stands_still_[colliders.second] != 0;
  return is_known ? &pairs_before_[next_] : nullptr;
}

void KnownContacts::keep(std::pair<int, int> colliders, const ReductionLoss& loss,
                         std::span<const Contact> contacts) {
  pairs_.push_back({colliders, loss, contacts_.size(), contacts.size()});
  contacts_.insert(contacts_.end(), contacts.begin(), contacts.end());
  // Both have room for what one of them held: the next find() swaps them.
  pairs_before_.reserve(pairs_.capacity());
  contacts_before_.reserve(contacts_.capacity());
}

}  // namespace signorini::collision
