#include "pair_properties.h"

#include <signorini/collision/hull.h>
#include <signorini/collision/pair_query.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <stdexcept>

namespace signorini::collision::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How far a point is outside a shape, to first order (<= 0: on or in it).
struct Outside {
  const Vec3& p;

  double operator()(const Sphere& sphere) const { return p.norm() - sphere.radius; }
  double operator()(const Box& box) const { return (p.cwiseAbs() - box.half_extents).maxCoeff(); }
  double operator()(const Capsule& capsule) const {
    const double z = std::clamp(p.z(), -capsule.half_length, capsule.half_length);
    return (p - Vec3(0.0, 0.0, z)).norm() - capsule.radius;
  }
  double operator()(const Cylinder& cylinder) const {
    return std::max(p.head<2>().norm() - cylinder.radius, std::abs(p.z()) - cylinder.half_length);
  }
  double operator()(const Cone& cone) const {
    const double height = 2.0 * cone.half_height;
    const double across = p.head<2>().norm() * height + (p.z() - cone.half_height) * cone.radius;
    return std::max(across / std::hypot(height, cone.radius), -cone.half_height - p.z());
  }
  double operator()(const Ellipsoid& ellipsoid) const {
    const Vec3 scaled = p.cwiseQuotient(ellipsoid.radii);
    const double level = scaled.norm();
    const double slope = scaled.cwiseQuotient(ellipsoid.radii).norm() / level;
    return level == 0.0 ? -ellipsoid.radii.minCoeff() : (level - 1.0) / slope;
  }
  double operator()(const ConvexHull& hull) const {
    double most = -kInfinity;
    for (std::size_t f = 0; f < hull.data->faces.size(); ++f) {
      most = std::max(most, hull.data->normals[f].dot(p) - hull.data->offsets[f]);
    }
    return most;
  }
  double operator()(const HalfSpace&) const { return p.z(); }
  double operator()(const auto&) const { return 0.0; }  // meshes, compounds: not here
};

double outside(const Shape& shape, const Pose& pose, const Vec3& point) {
  const Vec3 local = pose.orientation.conjugate() * (point - pose.position);
  return std::visit(Outside{local}, shape);
}

double distance(const PlacedPair& pair) {
  return signed_distance(pair.a, pair.pose_a, pair.b, pair.pose_b);
}

double separation_along(const PlacedPair& pair, const Vec3& n) {
  const Pose near{pair.pose_a.position - pair.pose_b.position, pair.pose_a.orientation};
  return -support(pair.a, near, -n) - support(pair.b, {Vec3::Zero(), pair.pose_b.orientation}, n);
}

std::vector<Contact> find(const PlacedPair& pair, double margin) {
  std::vector<Contact> contacts;
  find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b, margin, contacts);
  return contacts;
}

const Contact& deepest(const std::vector<Contact>& contacts) {
  return *std::min_element(contacts.begin(), contacts.end(),
                           [](const Contact& p, const Contact& q) { return p.gap < q.gap; });
}

bool is_curved(const Shape& shape) {
  return std::holds_alternative<Sphere>(shape) || std::holds_alternative<HalfSpace>(shape);
}

struct Tolerances {
  double rounding;  ///< of derived numbers: some tens of roundings of the data, 1e-8 of the size
  double gap;       ///< the preference for faces besides

  explicit Tolerances(const PlacedPair& pair)
      : rounding(64.0 * pair.rounding + 1e-8 * pair.size),
        gap(rounding + (is_curved(pair.a) && is_curved(pair.b) ? 0.0 : 2e-5 * pair.size)) {}
};

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string broken_contact(const PlacedPair& pair, const Contact& contact, const Vec3& N,
                           double margin, const Tolerances& tolerance) {
  try {
    validate(ContactSet{contact}, 2);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  if (std::abs(contact.normal.norm() - 1.0) > 1e-14) return "|N| is not 1";
  if (contact.normal != N) return "two normals";
  if (!(contact.gap <= margin + tolerance.gap)) return "gap over the margin";
  const Vec3 error = contact.point_a - contact.point_b - contact.gap * contact.normal;
  if (!(error.norm() <= tolerance.rounding))
    return "P_A - P_B is not gap N: " + number(error.norm());
  const double out_a = outside(pair.a, pair.pose_a, contact.point_a);
  if (!(out_a <= tolerance.gap)) return "P_A is outside A by " + number(out_a);
  const double out_b = outside(pair.b, pair.pose_b, contact.point_b);
  if (!(out_b <= tolerance.gap)) return "P_B is outside B by " + number(out_b);
  return {};
}

/// The largest separation over a sample of directions about N and everywhere.
double sampled_separation(Random& random, const PlacedPair& pair, const Vec3& N) {
  double most = -kInfinity;
  for (int k = 0; k < 30; ++k) {
    const double spread = k < 15 ? log_uniform(random, -8.0, 0.0) : 1e3;
    most = std::max(most,
                    separation_along(pair, (N + spread * random_direction(random)).normalized()));
  }
  return most;
}

}  // namespace

std::string broken_property(Random& random, const PlacedPair& pair, double margin,
                            PairCounts& counts) {
  const Tolerances tolerance(pair);
  const double d = distance(pair);
  ++counts.poses;
  counts.apart += d > 0.0;
  if (!std::isfinite(d)) return "distance " + number(d);
  if (test_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b) != (d <= 0.0)) {
    return "test disagrees with the distance " + number(d);
  }
  const double mirrored = distance(exchanged(pair));
  if (!(std::abs(mirrored - d) <= tolerance.rounding)) {
    return "exchange: distance " + number(d) + " becomes " + number(mirrored);
  }
  PlacedPair there =
      carried(pair, {pair.size * random_direction(random), random_orientation(random)});
  const double moved_rounding =
      64.0 * std::numeric_limits<double>::epsilon() * there.pose_b.position.norm();
  const double carried_distance = distance(there);
  if (!(std::abs(carried_distance - d) <= tolerance.rounding + moved_rounding)) {
    return "rigid motion: distance " + number(d) + " becomes " + number(carried_distance);
  }

  const std::vector<Contact> contacts = find(pair, margin);
  if (contacts.empty() != (d > margin)) {
    return std::to_string(contacts.size()) + " contacts at distance " + number(d);
  }
  const std::vector<Contact> all = contacts.empty() ? find(pair, kInfinity) : contacts;
  if (all.empty()) return "no contact within an infinite margin";
  counts.contacts += static_cast<long>(contacts.size());
  std::set<std::uint64_t> ids;
  for (const Contact& contact : all) {
    std::string broken = broken_contact(pair, contact, all.front().normal,
                                        contacts.empty() ? kInfinity : margin, tolerance);
    if (!broken.empty()) return broken;
    if (!ids.insert(contact.feature_id).second) return "feature id twice";
  }
  const Contact& first = deepest(all);
  if (!(std::abs(first.gap - d) <= tolerance.gap)) {
    return "least gap " + number(first.gap) + " at distance " + number(d);
  }
  const double along = separation_along(pair, first.normal);
  if (!(std::abs(along - d) <= tolerance.gap)) {
    return "apart along N by " + number(along) + " at distance " + number(d);
  }
  const bool has_half_space =
      std::holds_alternative<HalfSpace>(pair.a) || std::holds_alternative<HalfSpace>(pair.b);
  if (!has_half_space) {
    const double sampled = sampled_separation(random, pair, first.normal);
    if (!(sampled <= d + tolerance.rounding)) {
      return "a direction parts by " + number(sampled) + ", distance " + number(d);
    }
  }
  const double touch = distance(moved(pair, -first.gap * first.normal));
  if (!(std::abs(touch) <= 2.0 * tolerance.gap))
    return "after -gap N the distance is " + number(touch);
  return {};
}

PlacedPair kissing(Random& random, const PlacedPair& pair) {
  const std::vector<Contact> contacts = find(pair, kInfinity);
  if (contacts.empty()) {
    return pair;
  }
  const Contact& contact = deepest(contacts);
  const double tiny =
      uniform(random, 0.0, 1.0) < 0.3
          ? 0.0
          : log_uniform(random, -16.0, -9.0) * (uniform(random, 0.0, 1.0) < 0.5 ? -1.0 : 1.0);
  return moved(pair, (tiny * pair.size - contact.gap) * contact.normal);
}

double random_margin(Random& random, const PlacedPair& pair) {
  const double kind = uniform(random, 0.0, 1.0);
  return kind < 0.3 ? 0.0 : (kind < 0.9 ? 0.1 * pair.size : 10.0 * pair.size);
}

std::string check_poses(ShapeKind a, ShapeKind b, long poses, unsigned seed, PairCounts& counts) {
  Random random(seed);
  constexpr Placement kPlacements[] = {Placement::kAnywhere, Placement::kAligned,
                                       Placement::kAnywhere, Placement::kNearlyAligned};
  for (long k = 0; k < poses; ++k) {
    PlacedPair pair = random_pair(random, a, b, kPlacements[k % 4]);
    if (k % 3 == 2) {
      pair = kissing(random, pair);
    }
    const double margin = random_margin(random, pair);
    const std::string broken = broken_property(random, pair, margin, counts);
    if (!broken.empty()) {
      return broken + "\n" + describe(pair) + "margin " + number(margin) + ", pose " +
             std::to_string(k) + " of seed " + std::to_string(seed);
    }
  }
  return {};
}

}  // namespace signorini::collision::testing
