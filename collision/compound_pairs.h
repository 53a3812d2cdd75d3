#pragma once

#include <signorini/collision/compound.h>
#include <signorini/collision/feature_id.h>
#include <signorini/collision/narrow.h>

#include <vector>

namespace signorini::collision::narrow {

/// A part's features; the compound's number of one is (part << 20) | feature.
inline constexpr Feature kPartFeatures = Feature{1} << 20;

// Any shape against a compound: against the parts whose bounds come near.
[[nodiscard]] double compound_distance(const Shape& a, const Pose& pose_a, const Compound& b,
                                       const Pose& pose_b);
[[nodiscard]] bool compound_test(const Shape& a, const Pose& pose_a, const Compound& b,
                                 const Pose& pose_b);
void find_compound_contacts(const Shape& a, const Pose& pose_a, const Compound& b,
                            const Pose& pose_b, double margin, std::vector<Contact>& contacts);

template <class A>
[[nodiscard]] double distance(const A& a, const Pose& pose_a, const Compound& b,
                              const Pose& pose_b) {
  return compound_distance(a, pose_a, b, pose_b);
}
template <class A>
[[nodiscard]] bool test(const A& a, const Pose& pose_a, const Compound& b, const Pose& pose_b) {
  return compound_test(a, pose_a, b, pose_b);
}
template <class A>
void find(const A& a, const Pose& pose_a, const Compound& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts) {
  find_compound_contacts(a, pose_a, b, pose_b, margin, contacts);
}

}  // namespace signorini::collision::narrow
