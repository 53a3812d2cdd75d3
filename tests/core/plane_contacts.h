#pragma once

#include <signorini/core/model/contact_finder.h>

#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

namespace signorini::testing_tools {

/// A ball or a box about the centre of mass, body axes.
struct TestBall {
  double radius;
};
struct TestBox {
  Vec3 half_extents;
};
struct TestBody {
  std::variant<TestBall, TestBox> shape;
  Material material;
};

inline Mat3 box_inertia(double mass, const Vec3& half) {
  const Vec3 squares = half.cwiseAbs2();
  return (mass / 3.0 * (Vec3::Constant(squares.sum()) - squares)).asDiagonal();
}

inline Mat3 ball_inertia(double mass, double radius) {
  return 0.4 * mass * radius * radius * Mat3::Identity();
}

inline Body dynamic_body(double mass, const Mat3& inertia) {
  Body body;
  body.mass = mass;
  body.inertia = inertia;
  return body;
}

inline Body box_body(double mass, const Vec3& half) {
  return dynamic_body(mass, box_inertia(mass, half));
}

inline Body ball_body(double mass, double radius) {
  return dynamic_body(mass, ball_inertia(mass, radius));
}

inline BodyState at(const Vec3& x) {
  BodyState state;
  state.x = x;
  return state;
}

/// Contacts of balls and box corners with a plane (through a point of body 0, which is fixed or
/// driven; the normal is given), of balls with each other, and of boxes stacked along z: the
/// corners of each box with the top face of the box before it. Contact time is not offered.
class PlaneContacts final : public ContactFinder {
 public:
  /// @param shapes of the bodies 1, 2, ...; body 0 is the plane's
  PlaneContacts(const Vec3& plane_normal, std::vector<TestBody> shapes)
      : normal_(plane_normal.normalized()), shapes_(std::move(shapes)) {}

  /// Adds: the corners of box `upper` on the top face (+z) of box `lower`.
  void stack(int upper, int lower) { stacked_.emplace_back(upper, lower); }
  /// Adds: ball a against ball b.
  void pair_balls(int a, int b) { balls_.emplace_back(a, b); }
  /// Drops the plane: only stacked and paired bodies meet.
  void without_plane() { plane_ = false; }

  void find(const State& state, double margin, ContactSet& contacts) override {
    contacts.clear();
    if (plane_) {
      const Face plane{state[0].x, state[0].q * normal_};
      for (int k = 1; k < static_cast<int>(state.size()); ++k) {
        meet(state, k, 0, plane, margin, contacts);
      }
    }
    for (const auto& [upper, lower] : stacked_) {
      const double height = std::get<TestBox>(shape(lower).shape).half_extents.z();
      const Vec3 up = state[lower].q * Vec3::UnitZ();
      meet(state, upper, lower, {state[lower].x + height * up, up}, margin, contacts);
    }
    for (const auto& [a, b] : balls_) {
      meet_balls(state, a, b, margin, contacts);
    }
  }

  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const>, double,
                                                          RestingPairs) override {
    throw std::logic_error("PlaneContacts has no contact times");
  }

 private:
  struct Face {
    Vec3 point;
    Vec3 normal;
  };

  [[nodiscard]] const TestBody& shape(int body) const { return shapes_[body - 1]; }

  void meet(const State& state, int body, int other, const Face& face, double margin,
            ContactSet& contacts) const {
    const BodyState& pose = state[body];
    if (const auto* ball = std::get_if<TestBall>(&shape(body).shape)) {
      add(pose.x - ball->radius * face.normal, LocalSurface::sphere(ball->radius), body, other,
          face, margin, 0, contacts);
      return;
    }
    const Vec3 half = std::get<TestBox>(shape(body).shape).half_extents;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 signs((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
      const Vec3 arm = pose.q * half.cwiseProduct(signs);
      // Only the corners below the centre: the far side of a box lies deep in nothing.
      if (arm.dot(face.normal) < 0.0) {
        add(pose.x + arm, LocalSurface::vertex(), body, other, face, margin, corner, contacts);
      }
    }
  }

  void add(const Vec3& point, const LocalSurface& surface, int body, int other, const Face& face,
           double margin, int feature, ContactSet& contacts) const {
    Contact contact;
    contact.gap = face.normal.dot(point - face.point);
    if (contact.gap > margin) {
      return;
    }
    contact.body_a = body;
    contact.body_b = other;
    contact.normal = face.normal;
    contact.point_a = point;
    contact.point_b = point - contact.gap * face.normal;
    contact.feature_id = static_cast<std::uint64_t>(body) * 64 + other * 8 + feature;
    contact.owner = NormalOwner::kFaceB;
    contact.surface_a = surface;
    contact.surface_b = LocalSurface::face();
    contact.material = shape(body).material;
    contacts.push_back(contact);
  }

  void meet_balls(const State& state, int a, int b, double margin, ContactSet& contacts) const {
    const double radius_a = std::get<TestBall>(shape(a).shape).radius;
    const double radius_b = std::get<TestBall>(shape(b).shape).radius;
    const Vec3 between = state[a].x - state[b].x;
    Contact contact;
    contact.gap = between.norm() - radius_a - radius_b;
    if (contact.gap > margin) {
      return;
    }
    contact.body_a = a;
    contact.body_b = b;
    contact.normal = between.normalized();
    contact.point_a = state[a].x - radius_a * contact.normal;
    contact.point_b = state[b].x + radius_b * contact.normal;
    contact.owner = NormalOwner::kCurved;
    contact.surface_a = LocalSurface::sphere(radius_a);
    contact.surface_b = LocalSurface::sphere(radius_b);
    contact.material = shape(a).material;
    contacts.push_back(contact);
  }

  Vec3 normal_;
  std::vector<TestBody> shapes_;
  std::vector<std::pair<int, int>> stacked_;
  std::vector<std::pair<int, int>> balls_;
  bool plane_ = true;
};

/// Body 0 of a PlaneContacts scene.
inline Body fixed_body() {
  Body body;
  body.kind = BodyKind::kFixed;
  return body;
}

}  // namespace signorini::testing_tools
