// d' and d'' of every kind of contact that find_intersection() produces, against finite differences
// of the gap that it produces at moved poses.

#include <signorini/collision/feature_id.h>
#include <signorini/collision/pair_query.h>
#include <signorini/core/model/contact_kinematics.h>

#include "random_pairs.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <string>

namespace signorini::collision {
namespace {

using testing::Random;
using testing::ShapeKind;

constexpr int kPoses = 20000;

/// A body whose frame is its shape's, with velocities and accelerations.
struct MovingBody {
  Pose start;
  Velocity velocity;
  Velocity acceleration;  ///< v' and w'

  /// To second order in t, the orientation by the rotation vector w t + w' t^2 / 2 (whose own
  /// second-order error, w x w', is of third order in t).
  [[nodiscard]] Pose at(double t) const {
    const Vec3 turn = t * velocity.angular + 0.5 * t * t * acceleration.angular;
    const double angle = turn.norm();
    const Quat rotation =
        angle == 0.0 ? Quat::Identity() : Quat(Eigen::AngleAxisd(angle, turn / angle));
    return {start.position + t * velocity.linear + 0.5 * t * t * acceleration.linear,
            (rotation * start.orientation).normalized()};
  }

  /// v' + w' x r + w x (w x r).
  [[nodiscard]] Vec3 acceleration_at(const Vec3& r) const {
    return acceleration.at(r) + velocity.angular.cross(velocity.angular.cross(r));
  }
};

MovingBody random_body(Random& random, const Pose& start, double size) {
  const auto vector = [&](double length) {
    return Vec3(length * testing::random_direction(random));
  };
  return {start, {vector(size), vector(1.0)}, {vector(size), vector(1.0)}};
}

/// The gap of the contact at time t; nothing if it is no longer there, or its edges cross on a
/// face.
std::optional<double> gap_at(const Shape& a, const MovingBody& body_a, const Shape& b,
                             const MovingBody& body_b, const Contact& wanted, double t) {
  std::vector<Contact> contacts;
  find_intersection(a, body_a.at(t), b, body_b.at(t), 1e9, contacts);
  for (const Contact& contact : contacts) {
    if (contact.feature_id == wanted.feature_id && contact.owner == wanted.owner) {
      return contact.gap;
    }
  }
  return std::nullopt;
}

/// A clipped point is a point of the incident body's material: its gap is its height over the
/// moving reference face, wherever the clipping would find the crossing next. A point of a
/// capsule's side: of its axis, with a ball of this radius about it.
double material_gap_at(const Contact& contact, const MovingBody& body_a, const MovingBody& body_b,
                       double t, double radius = 0.0) {
  const auto carried = [&](const MovingBody& body, const Vec3& point) {
    return body.at(t) * (body.start.inverse() * point);
  };
  const bool face_of_a = contact.owner == NormalOwner::kFaceA;
  const MovingBody& owner = face_of_a ? body_a : body_b;
  const Vec3 N = owner.at(t).orientation * (owner.start.orientation.conjugate() * contact.normal);
  const Vec3 core_a = contact.point_a + (face_of_a ? 0.0 : radius) * contact.normal;
  const Vec3 core_b = contact.point_b - (face_of_a ? radius : 0.0) * contact.normal;
  return N.dot(carried(body_a, core_a) - carried(body_b, core_b)) - radius;
}

struct Difference {
  double first;
  double second;
};

/// Fourth-order central differences; nothing if a gap is missing.
template <class Gap>
std::optional<Difference> differences(Gap&& gap, double h) {
  double g[5];
  for (int k = 0; k < 5; ++k) {
    const std::optional<double> value = gap((k - 2) * h);
    if (!value) {
      return std::nullopt;
    }
    g[k] = *value;
  }
  return Difference{(g[0] - 8.0 * g[1] + 8.0 * g[3] - g[4]) / (12.0 * h),
                    (-g[0] + 16.0 * g[1] - 30.0 * g[2] + 16.0 * g[3] - g[4]) / (12.0 * h * h)};
}

/// What kind of contact it is, for the counts.
std::string kind_of(const Contact& contact, bool is_vertex) {
  constexpr const char* kOwners[] = {"face of A", "face of B", "edge-edge", "curved"};
  const auto side = [](const LocalSurface& surface) -> std::string {
    if (surface.radius_along == 0.0) {
      return "vertex";
    }
    if (std::isinf(surface.radius_along)) {
      return surface.radius_across == 0.0        ? "edge"
             : std::isinf(surface.radius_across) ? "face"
                                                 : "generator";
    }
    return "round";
  };
  return std::string(kOwners[static_cast<int>(contact.owner)]) + ", " + side(contact.surface_a) +
         "/" + side(contact.surface_b) + (is_vertex ? "" : ", clipped");
}

/// Moves A along the normal until the least gap is this one, and finds the contacts there.
std::vector<Contact> contacts_at_gap(testing::PlacedPair& pair, double gap, double margin) {
  std::vector<Contact> contacts;
  find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b, 1e9, contacts);
  const auto& least = *std::min_element(contacts.begin(), contacts.end(),
                                        [](auto& p, auto& q) { return p.gap < q.gap; });
  pair.pose_a.position += (gap - least.gap) * least.normal;
  find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b, margin, contacts);
  return contacts;
}

struct Predicted {
  Difference gap;
  bool is_degenerate;
};

/// d' and d'' as the library says.
Predicted predicted(const Contact& contact, const MovingBody& body_a, const MovingBody& body_b) {
  const GapKinematics kinematics =
      gap_kinematics(contact, {body_a.start.position, body_a.start.orientation}, body_a.velocity,
                     {body_b.start.position, body_b.start.orientation}, body_b.velocity);
  const double second =
      contact.normal.dot(body_a.acceleration_at(contact.point_a - body_a.start.position) -
                         body_b.acceleration_at(contact.point_b - body_b.start.position)) +
      kinematics.curvature_acceleration;
  return {{kinematics.d_dot, second}, kinematics.degenerate};
}

/// What was compared, by kind of contact.
class Comparison {
 public:
  void leave_out() { ++left_out_; }
  void compare(const std::string& kind, const Difference& measured, const Difference& said,
               double tolerance, const testing::PlacedPair& pair) {
    ASSERT_NEAR(measured.first, said.first, tolerance) << kind << "\n" << describe(pair);
    ASSERT_NEAR(measured.second, said.second, tolerance) << kind << "\n" << describe(pair);
    ++compared_[kind];
    worst_[kind] = std::max(worst_[kind], std::abs(measured.second - said.second));
  }
  /// Prints the counts. Every one of these kinds must have come up.
  void finish(const std::vector<std::string>& kinds) {
    for (const auto& [kind, count] : compared_) {
      std::printf("    %-40s %6d contacts, d'' within %.1e\n", kind.c_str(), count, worst_[kind]);
    }
    std::printf("    left out: %d\n", left_out_);
    for (const std::string& kind : kinds) {
      EXPECT_GT(compared_[kind], 0) << kind;
    }
  }
  [[nodiscard]] int left_out() const { return left_out_; }

 private:
  std::map<std::string, int> compared_;
  std::map<std::string, double> worst_;
  int left_out_ = 0;
};

bool is_polyhedron_vertex(Feature feature) {
  return feature == 0 || feature == 2 || feature == 6 || feature == 8 || feature == 18 ||
         feature == 20 || feature == 24 || feature == 26;
}

TEST(GapDerivatives, OfEveryContactMatchFiniteDifferences) {
  Random random(20260120);
  constexpr ShapeKind kKinds[][2] = {
      {ShapeKind::kSphere, ShapeKind::kSphere}, {ShapeKind::kSphere, ShapeKind::kBox},
      {ShapeKind::kBox, ShapeKind::kSphere},    {ShapeKind::kSphere, ShapeKind::kHalfSpace},
      {ShapeKind::kBox, ShapeKind::kHalfSpace}, {ShapeKind::kHalfSpace, ShapeKind::kBox},
      {ShapeKind::kBox, ShapeKind::kBox},       {ShapeKind::kBox, ShapeKind::kBox},
      {ShapeKind::kBox, ShapeKind::kBox}};
  Comparison comparison;
  for (int k = 0; k < kPoses; ++k) {
    const Shape a = kKinds[k % 9][0] == ShapeKind::kSphere ? Shape(Sphere{0.7})
                    : kKinds[k % 9][0] == ShapeKind::kBox  ? Shape(Box{{0.5, 0.8, 0.6}})
                                                           : Shape(HalfSpace{});
    const Shape b = kKinds[k % 9][1] == ShapeKind::kSphere ? Shape(Sphere{0.4})
                    : kKinds[k % 9][1] == ShapeKind::kBox  ? Shape(Box{{0.9, 0.4, 0.7}})
                                                           : Shape(HalfSpace{});
    testing::PlacedPair pair{a,
                             {Vec3::Zero(), testing::random_orientation(random)},
                             b,
                             {Vec3::Zero(), testing::random_orientation(random)}};
    pair.pose_a.position = 0.5 * testing::random_direction(random);
    if (k % 18 >= 9) {
      pair.pose_a.position = 2.0 * testing::random_direction(random);
    }
    constexpr double kGaps[] = {-0.05, 0.0, 0.05, 0.3};
    const std::vector<Contact> contacts = contacts_at_gap(pair, kGaps[k / 18 % 4], 0.5);
    const MovingBody body_a = random_body(random, pair.pose_a, 1.0);
    const MovingBody body_b = random_body(random, pair.pose_b, 1.0);
    for (const Contact& contact : contacts) {
      const Predicted said = predicted(contact, body_a, body_b);
      const auto feature_a = static_cast<Feature>(contact.feature_id >> 32);
      const auto feature_b = static_cast<Feature>(contact.feature_id);
      const bool on_face =
          contact.owner == NormalOwner::kFaceA || contact.owner == NormalOwner::kFaceB;
      const bool both_boxes = std::holds_alternative<Box>(a) && std::holds_alternative<Box>(b);
      const Feature incident = contact.owner == NormalOwner::kFaceA ? feature_b : feature_a;
      const bool clipped = both_boxes && on_face && !is_polyhedron_vertex(incident);

      // The size of a step is a balance: truncation h^4, rounding eps / h^2.
      const double h = 1e-3;
      const auto measured =
          clipped
              ? differences(
                    [&](double t) {
                      return std::optional(material_gap_at(contact, body_a, body_b, t));
                    },
                    h)
              : differences([&](double t) { return gap_at(a, body_a, b, body_b, contact, t); }, h);
      if (!measured || said.is_degenerate) {
        comparison.leave_out();  // the features change within 2 ms
        continue;
      }
      // Truncation: h^4 times a fifth or sixth derivative of a gap function whose scale of length
      // is the distance of the curves' centres, or of the crossing lines (edges that cross at a
      // small angle turn their normal fast).
      double scale = 1.0;
      if (contact.owner == NormalOwner::kEdgeEdge) {
        scale = contact.surface_a.direction.cross(contact.surface_b.direction).norm();
      } else if (contact.owner == NormalOwner::kCurved) {
        const auto radius = [](double r) { return std::isfinite(r) ? r : 0.0; };
        scale = std::min(1.0, std::abs(contact.gap + radius(contact.surface_a.radius_across) +
                                       radius(contact.surface_b.radius_across)));
      }
      const double tolerance = 1e-7 / std::pow(scale, 5);
      if (scale < 0.2) {
        comparison.leave_out();
        continue;
      }
      const std::string kind = kind_of(contact, !clipped);
      comparison.compare(kind, *measured, said.gap, tolerance, pair);
      if (HasFatalFailure()) {
        return;
      }
    }
  }
  EXPECT_LT(comparison.left_out(), kPoses / 20);
  comparison.finish({"face of A, face/vertex", "face of B, vertex/face", "face of B, round/face",
                     "face of A, face/round", "edge-edge, edge/edge", "curved, round/round",
                     "curved, round/edge", "curved, round/vertex", "curved, edge/round",
                     "curved, vertex/round", "curved, vertex/vertex", "curved, vertex/edge",
                     "curved, edge/vertex", "face of A, face/vertex, clipped",
                     "face of B, vertex/face, clipped"});
}

/// The least radius of curvature that the gap of a contact bends with.
double bending_scale(const Contact& contact) {
  double least = 1.0;
  if (contact.owner == NormalOwner::kEdgeEdge) {
    return contact.surface_a.direction.cross(contact.surface_b.direction).norm();
  }
  const auto& [a, b] = std::pair(contact.surface_a, contact.surface_b);
  const auto finite = [](double r) { return std::isfinite(r) ? r : 0.0; };
  const double along = std::min(finite(a.radius_along), finite(a.radius_across)) +
                       std::min(finite(b.radius_along), finite(b.radius_across));
  if (contact.owner == NormalOwner::kCurved) {
    least = std::min(least, std::abs(contact.gap + along));
  }
  return least;
}

// Cylinder, cone, ellipsoid and capsule against plane, ball, box and each other: rims, generators,
// apexes and ellipsoids carry their curvature.
TEST(GapDerivatives, OfRoundShapesMatchFiniteDifferences) {
  Random random(20261125);
  const Shape round[] = {Cylinder{0.5, 0.7}, Cone{0.6, 0.5}, Ellipsoid{{0.5, 0.7, 0.9}},
                         Capsule{0.4, 0.6}};
  const Shape others[] = {
      HalfSpace{},        Sphere{0.6},    Box{{0.9, 0.4, 0.7}},      Capsule{0.3, 0.8},
      Cylinder{0.6, 0.5}, Cone{0.7, 0.6}, Ellipsoid{{0.8, 0.6, 0.5}}};
  Comparison comparison;
  for (int k = 0; k < 6000; ++k) {
    const Shape& a = round[k % 4];
    const Shape& b = others[k / 4 % 7];
    testing::PlacedPair pair{
        a,
        {2.5 * testing::random_direction(random), testing::random_orientation(random)},
        b,
        {Vec3::Zero(), testing::random_orientation(random)}};
    constexpr double kGaps[] = {-0.02, 0.0, 0.05, 0.3};
    const std::vector<Contact> contacts = contacts_at_gap(pair, kGaps[k / 28 % 4], 0.31);
    const MovingBody body_a = random_body(random, pair.pose_a, 1.0);
    const MovingBody body_b = random_body(random, pair.pose_b, 1.0);
    for (const Contact& contact : contacts) {
      const Predicted said = predicted(contact, body_a, body_b);
      const bool on_face =
          contact.owner == NormalOwner::kFaceA || contact.owner == NormalOwner::kFaceB;
      const LocalSurface& incident =
          contact.owner == NormalOwner::kFaceA ? contact.surface_b : contact.surface_a;
      const bool is_of_a = contact.owner == NormalOwner::kFaceB;  // the incident shape
      const bool is_ball = std::holds_alternative<Capsule>(is_of_a ? a : b);
      const bool is_material =
          on_face && (is_ball || (incident.radius_along == 0.0 && incident.radius_across == 0.0));
      const double h = 1e-3;
      const auto measured =
          is_material
              ? differences(
                    [&](double t) {
                      return std::optional(material_gap_at(contact, body_a, body_b, t,
                                                           is_ball ? incident.radius_along : 0.0));
                    },
                    h)
              : differences([&](double t) { return gap_at(a, body_a, b, body_b, contact, t); }, h);
      const double scale = bending_scale(contact);
      if (!measured || said.is_degenerate || scale < 0.2) {
        comparison.leave_out();
        continue;
      }
      const std::string kind = kind_of(contact, !is_material);
      const double tolerance = 1e-6 / std::pow(scale, 5);
      comparison.compare(kind, *measured, said.gap, tolerance, pair);
      if (HasFatalFailure()) {
        return;
      }
    }
  }
  comparison.finish(
      {"face of A, face/round", "face of B, round/face", "face of B, vertex/face, clipped",
       "curved, round/round", "curved, round/vertex", "curved, vertex/round", "curved, round/edge",
       "curved, generator/round", "curved, round/generator", "curved, generator/vertex",
       "curved, generator/edge", "curved, generator/generator"});
}

TEST(GapDerivatives, BallRollingOnAPlaneAcceleratesAsItsCentre) {
  std::vector<Contact> contacts;
  find_intersection(Sphere{0.5}, {{0, 0, 0.5}, Quat::Identity()}, HalfSpace{}, {}, 0.0, contacts);
  ASSERT_EQ(contacts.size(), 1u);
  const MovingBody ball{{{0, 0, 0.5}, Quat::Identity()},
                        {{50.0, 0, 0}, {0, 100.0, 0}},
                        {{0, 0, -9.81}, Vec3::Zero()}};
  const Difference said = predicted(contacts[0], ball, MovingBody{}).gap;
  EXPECT_NEAR(said.first, 0.0, 1e-15);
  EXPECT_NEAR(said.second, -9.81, 1e-11);  // 5000 m/s^2 of centripetal acceleration cancel
}

}  // namespace
}  // namespace signorini::collision
