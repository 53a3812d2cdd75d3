#include "bench/mesh_checks.h"

#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/collision/pair_query.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace signorini::bench {
namespace {

using namespace collision;           // NOLINT: the whole file is about them
using namespace collision::testing;  // NOLINT

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPointRadius = 1e-9;  // a point as a sphere, of the smaller size

ConvexHull prism(const std::array<Vec3, 3>& corners, double thickness) {
  const Vec3 n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  std::vector<Vec3> points;
  for (const double side : {-1.0, 1.0}) {
    for (const Vec3& corner : corners) {
      points.push_back(corner + side * thickness * n);
    }
  }
  return make_hull(std::move(points),
                   {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
}

class MeshJudge {
 public:
  MeshJudge(const PlacedPair& pair, const Terrain& terrain, double margin, Random& random)
      : pair_(pair), terrain_(terrain), margin_(margin), random_(random) {
    exact_ = kOfSearch * pair.size + 200.0 * pair.rounding;
    of_reference_ = exact_ + 2.0 * terrain.thickness;
    preference_ = kPreference * pair.size;
  }

  JudgedPair run() {
    try {
      judge_distance();
      judge_contacts();
    } catch (const std::invalid_argument&) {
      book_.require(PairProperty::kNoNaN, false);  // every pose of the study is a good one
    }
    return {book_.verdict(), d_};
  }

 private:
  /// The least distance of a shape from a prism; of those further than `at_most` it says nothing.
  [[nodiscard]] double to_prisms(const Shape& shape, const Pose& pose, double at_most) const {
    const double radius = bounding_radius(shape, Pose{});
    const Vec3 centre = pair_.pose_b.inverse() * pose.position;
    double least = kInfinity;
    for (std::size_t t = 0; t < terrain_.prisms.size(); ++t) {
      if ((terrain_.centres[t] - centre).norm() <= radius + terrain_.radii[t] + at_most) {
        least = std::min(least, signed_distance(shape, pose, terrain_.prisms[t], pair_.pose_b));
      }
    }
    return least;
  }

  void judge_distance() {
    const auto& [a, pose_a, b, pose_b, size, rounding] = pair_;
    d_ = signed_distance(a, pose_a, b, pose_b);
    book_.require(PairProperty::kNoNaN, std::isfinite(d_));
    reference_ = to_prisms(a, pose_a, std::max(d_, 0.0) + of_reference_);
    const bool touch = test_intersection(a, pose_a, b, pose_b);
    if (touch != (d_ <= 0.0)) {
      book_.off_by(PairProperty::kTest, std::abs(d_), exact_);
    }
    if (touch != (reference_ <= 0.0)) {
      book_.off_by(PairProperty::kTest, std::abs(reference_), of_reference_);
    }
    if (reference_ > 0.0 && d_ > 0.0) {
      book_.off_by(PairProperty::kCertified, std::abs(d_ - reference_), of_reference_);
    }
    const Pose motion{size * random_direction(random_), random_orientation(random_)};
    PlacedPair near = pair_;
    near.pose_a.position -= pose_b.position;
    near.pose_b.position.setZero();
    const PlacedPair elsewhere = carried(near, motion);
    compare(PairProperty::kExchange, signed_distance(b, pose_b, a, pose_a));
    compare(PairProperty::kRigidMotion,
            signed_distance(elsewhere.a, elsewhere.pose_a, b, elsewhere.pose_b));
  }

  /// The distance seen otherwise. Overlapping, which triangles count may depend on rounding: then
  /// the sign alone.
  void compare(PairProperty property, double otherwise) {
    const bool is_apart = d_ > exact_ + preference_;
    book_.off_by(property,
                 is_apart ? std::abs(otherwise - d_) : std::max(otherwise - std::max(d_, 0.0), 0.0),
                 is_apart ? exact_ : exact_ + preference_);
  }

  void judge_contacts() {
    std::vector<Contact> contacts;
    find_intersection(pair_.a, pair_.pose_a, pair_.b, pair_.pose_b, margin_, contacts);
    if (contacts.empty()) {
      if (d_ <= margin_) {
        book_.off_by(PairProperty::kNothingMissed, std::max(margin_ - d_, 2.0 * exact_), exact_);
      }
      book_.off_by(PairProperty::kNothingMissed, std::max(margin_ - reference_, 0.0),
                   of_reference_);
      return;
    }
    book_.off_by(PairProperty::kNothingBeyond, std::max(reference_ - margin_, 0.0),
                 of_reference_ + preference_);
    double least = kInfinity;
    for (const Contact& contact : contacts) {
      least = std::min(least, contact.gap);
      judge_contact(contact);
    }
    book_.off_by(PairProperty::kCertified, std::abs(least - d_), exact_ + preference_);
  }

  void judge_contact(const Contact& contact) {
    book_.require(PairProperty::kNoNaN, std::isfinite(contact.gap) && contact.point_a.allFinite() &&
                                            contact.point_b.allFinite() &&
                                            contact.normal.allFinite());
    book_.require(PairProperty::kUnitNormal, std::abs(contact.normal.norm() - 1.0) <= 1e-12);
    book_.off_by(PairProperty::kNothingBeyond, contact.gap - margin_, exact_ + preference_);
    const double allowed = of_reference_ + 2.0 * preference_;
    book_.off_by(PairProperty::kPoints,
                 (contact.point_a - contact.point_b - contact.gap * contact.normal).norm(),
                 allowed);
    const Pose turned{Vec3::Zero(), pair_.pose_a.orientation};
    for (const Vec3& n : {contact.normal, Vec3(-contact.normal), random_direction(random_)}) {
      book_.off_by(PairProperty::kPoints,
                   n.dot(contact.point_a - pair_.pose_a.position) - support(pair_.a, turned, n),
                   allowed);
    }
    const Sphere point{kPointRadius * pair_.size};
    const double beside = to_prisms(point, {contact.point_b, Quat::Identity()}, allowed);
    book_.off_by(PairProperty::kPoints, std::max(beside, 0.0), allowed);
  }

  const PlacedPair& pair_;
  const Terrain& terrain_;
  double margin_;
  Random& random_;
  double exact_;         ///< allowed between two of our distances, m
  double of_reference_;  ///< against the prisms, m
  double preference_;    ///< m
  double d_ = 0.0;
  double reference_ = 0.0;
  VerdictBook book_;
};

}  // namespace

Terrain random_terrain(Random& random, double scale) {
  constexpr int kSide = 4;
  const bool is_flat = uniform(random, 0.0, 1.0) < 0.5;
  std::vector<double> heights(kSide * kSide, 0.0);
  if (!is_flat) {
    const double rough = scale * log_uniform(random, -3.0, 0.0);
    std::generate(heights.begin(), heights.end(),
                  [&] { return rough * uniform(random, -1.0, 1.0); });
  }
  Terrain terrain;
  const TriangleMesh mesh =
      make_height_field(heights, kSide, kSide, scale, scale * uniform(random, 0.5, 2.0));
  terrain.mesh = mesh;
  terrain.thickness = 1e-7 * scale;
  for (const MeshData::Triangle& triangle : mesh.data->triangles) {
    std::array<Vec3, 3> corners;
    std::transform(triangle.vertices.begin(), triangle.vertices.end(), corners.begin(),
                   [&](int v) { return mesh.data->vertices[v]; });
    terrain.prisms.push_back(prism(corners, terrain.thickness));
    terrain.centres.emplace_back((corners[0] + corners[1] + corners[2]) / 3.0);
    double radius = 0.0;
    for (const Vec3& corner : corners) {
      radius = std::max(radius, (corner - terrain.centres.back()).norm());
    }
    terrain.radii.push_back(radius + 2.0 * terrain.thickness);
  }
  return terrain;
}

JudgedPair judge_on_terrain(const PlacedPair& pair, const Terrain& terrain, double margin,
                            Random& random) {
  return MeshJudge(pair, terrain, margin, random).run();
}

}  // namespace signorini::bench
