#include "random_throws.h"

#include <signorini/collision/pair_query.h>

#include <algorithm>
#include <limits>

namespace signorini::collision::testing {

double Throw::gap(double t) const {
  return signed_distance(pair.a, a.pose(t), pair.b, b.pose(t));
}

Throw random_throw(Random& random, ShapeKind a, ShapeKind b, double apart) {
  PlacedPair pair = random_pair(random, a, b, Placement::kAnywhere);
  std::vector<Contact> contacts;
  find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b,
                    std::numeric_limits<double>::infinity(), contacts);
  const Contact& nearest =
      *std::min_element(contacts.begin(), contacts.end(),
                        [](const Contact& p, const Contact& q) { return p.gap < q.gap; });
  const double size = pair.size;
  pair.pose_a.position += (apart * size - nearest.gap) * nearest.normal;
  const auto vector = [&](double most) {
    return Vec3(uniform(random, 0.0, most) * random_direction(random));
  };
  const bool on_plane = b == ShapeKind::kHalfSpace;
  const Vec3 velocity = vector(3.0 * size) - 2.0 * size * nearest.normal;
  const Vec3 velocity_b = on_plane ? Vec3(Vec3::Zero()) : vector(size);
  return {pair,
          {pair.pose_a, velocity, vector(10.0)},
          {pair.pose_b, velocity_b, on_plane ? Vec3(Vec3::Zero()) : vector(10.0)}};
}

}  // namespace signorini::collision::testing
