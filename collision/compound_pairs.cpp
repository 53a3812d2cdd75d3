#include <signorini/collision/compound_pairs.h>
#include <signorini/collision/pair_query.h>

#include <algorithm>
#include <array>
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

/// What a query works on: kept from query to query of a thread. Against a compound A each part of B
/// asks again, within the first query: parts are convex, so that two are enough.
struct CompoundMemory {
  struct Level {
    std::vector<int> near;
    std::vector<Contact> of_part;
  };
  std::array<Level, 2> levels;
  std::size_t depth = 0;
};

class Lease {
 public:
  Lease() : level_(memory().levels.at(memory().depth)) { ++memory().depth; }
  ~Lease() { --memory().depth; }
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;

  CompoundMemory::Level* operator->() { return &level_; }

 private:
  static CompoundMemory& memory() {
    thread_local CompoundMemory of_this_thread;
    return of_this_thread;
  }

  CompoundMemory::Level& level_;
};

/// In ascending order.
void find_parts_near(const Bounds& near, const Compound& b, std::vector<int>& parts) {
  parts.clear();
  b.data->tree.visit_overlaps(near, [&](int part) { parts.push_back(part); });
  std::sort(parts.begin(), parts.end());
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
  Lease memory;
  find_parts_near(near_bounds(a, pose_a, b, pose_b, 0.0), b, memory->near);
  return std::any_of(memory->near.begin(), memory->near.end(), [&](int i) {
    const CompoundPart& part = b.data->parts[i];
    return test_intersection(a, pose_a, part.shape, pose_b * part.local);
  });
}

void find_compound_contacts(const Shape& a, const Pose& pose_a, const Compound& b,
                            const Pose& pose_b, double margin, std::vector<Contact>& contacts) {
  Lease memory;
  find_parts_near(near_bounds(a, pose_a, b, pose_b, margin), b, memory->near);
  for (const int i : memory->near) {
    const CompoundPart& part = b.data->parts[i];
    find_intersection(a, pose_a, part.shape, pose_b * part.local, margin, memory->of_part);
    for (Contact& contact : memory->of_part) {
      contact.feature_id |= std::uint64_t{kPartFeatures} * static_cast<std::uint64_t>(i);
      contacts.push_back(contact);
    }
  }
}

}  // namespace signorini::collision::narrow
