#include <signorini/collision/compound_pairs.h>
#include <signorini/collision/pair_query.h>

#include <algorithm>
#include <limits>

namespace signorini::collision::narrow {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Bounds of A in the compound's frame, widened by a distance and some roundings.
Bounds near_bounds(const Shape& a, const Pose& pose_a, const Compound& b, const Pose& pose_b,
                   double by) {
  Bounds near = bounds(a, pose_b.inverse() * pose_a);
  if (near.low.allFinite() && near.high.allFinite()) {
    const double far = near.low.cwiseAbs().maxCoeff() + near.high.cwiseAbs().maxCoeff();
    by += 64.0 * std::numeric_limits<double>::epsilon() * (far + b.data->radius);
  }
  near.low.array() -= by;
  near.high.array() += by;
  return near;
}

std::vector<int> parts_near(const Bounds& near, const Compound& b) {
  std::vector<int> result;
  b.data->tree.visit_overlaps(near, [&](int part) { result.push_back(part); });
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

double compound_distance(const Shape& a, const Pose& pose_a, const Compound& b,
                         const Pose& pose_b) {
  return b.data->tree.least(near_bounds(a, pose_a, b, pose_b, 0.0), kInfinity, [&](int i) {
    const CompoundPart& part = b.data->parts[i];
    return signed_distance(a, pose_a, part.shape, pose_b * part.local);
  });
}

bool compound_test(const Shape& a, const Pose& pose_a, const Compound& b, const Pose& pose_b) {
  const std::vector<int> near = parts_near(near_bounds(a, pose_a, b, pose_b, 0.0), b);
  return std::any_of(near.begin(), near.end(), [&](int i) {
    const CompoundPart& part = b.data->parts[i];
    return test_intersection(a, pose_a, part.shape, pose_b * part.local);
  });
}

void find_compound_contacts(const Shape& a, const Pose& pose_a, const Compound& b,
                            const Pose& pose_b, double margin, std::vector<Contact>& contacts) {
  std::vector<Contact> of_part;
  for (const int i : parts_near(near_bounds(a, pose_a, b, pose_b, margin), b)) {
    const CompoundPart& part = b.data->parts[i];
    find_intersection(a, pose_a, part.shape, pose_b * part.local, margin, of_part);
    for (Contact& contact : of_part) {
      contact.feature_id |= std::uint64_t{kPartFeatures} * static_cast<std::uint64_t>(i);
      contacts.push_back(contact);
    }
  }
}

}  // namespace signorini::collision::narrow
