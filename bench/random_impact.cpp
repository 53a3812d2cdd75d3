#include "bench/random_impact.h"

#include <signorini/core/response/assembly.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace signorini::bench {
namespace {

constexpr double kSeparating = 0.45;  // probability that a group of contacts separates

class Generator {
 public:
  Generator(std::seed_seq& seed, const RandomImpactOptions& options)
      : options_(options), random_(seed) {}

  RandomImpact draw() {
    const int bodies = static_cast<int>(std::exp(uniform(std::log(2.0), std::log(21.0))));
    for (int i = 0; i < bodies; ++i) {
      add_body(i == 0);
    }
    for (int i = 1; i < bodies; ++i) {
      if (i == 1 || !chance(0.15)) {
        add_group(pick(i), i);
      }
    }
    for (int extra = pick(bodies / 2 + 1); extra > 0; --extra) {
      add_group(pick(bodies), pick(bodies));
    }
    return std::move(impact_);
  }

 private:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  Vec3 vector() {
    std::normal_distribution<double> normal;
    const double x = normal(random_);
    const double y = normal(random_);
    return {x, y, normal(random_)};
  }
  Quat orientation() {
    const Vec3 v = vector();
    return Quat(std::normal_distribution<double>()(random_), v.x(), v.y(), v.z()).normalized();
  }

  BodyKind kind() {
    const double draw = uniform(0.0, 1.0);
    return draw < 0.125 ? BodyKind::kFixed
                        : (draw < 0.1875 ? BodyKind::kKinematic : BodyKind::kDynamic);
  }

  void add_body(bool must_be_dynamic) {
    Body body;
    body.kind = must_be_dynamic ? BodyKind::kDynamic : kind();
    const double decades = 0.5 * std::log10(options_.mass_ratio);
    body.mass = std::pow(10.0, uniform(-decades, decades));
    const double size = uniform(0.3, 1.5);
    const double xx = uniform(0.02, 1.0);
    const double yy = uniform(0.02, 1.0);
    const double zz = uniform(0.02, 1.0);
    const Mat3 axes = orientation().toRotationMatrix();
    body.inertia = body.mass * size * size * axes * Vec3(yy + zz, zz + xx, xx + yy).asDiagonal() *
                   axes.transpose();
    body.inertia = 0.5 * (body.inertia + body.inertia.transpose()).eval();
    BodyState state;
    state.x = 1.5 * vector();
    state.q = orientation();
    const Velocity motion{vector(), vector()};
    if (!chance(0.2)) {
      set_velocity(body, motion, state);
    }
    impact_.bodies.push_back(body);
    impact_.state.push_back(state);
  }

  /// A group of contacts between two bodies, of which one must be able to move.
  void add_group(int a, int b) {
    if (!impact_.bodies[a].is_dynamic() && !impact_.bodies[b].is_dynamic()) {
      a = 0;
    }
    if (a == b) {
      return;
    }
    Contact contact;
    contact.body_a = a;
    contact.body_b = b;
    contact.gap = 0.0;
    const Vec3 point = 0.5 * (impact_.state[a].x + impact_.state[b].x) + 0.5 * vector();
    contact.point_a = contact.point_b = point;
    contact.normal = vector().normalized();
    const double d_dot = gap_velocity(impact_.bodies, impact_.state, contact);
    if ((d_dot > 0.0) != chance(kSeparating)) {
      contact.normal = -contact.normal;
    }
    const double draw = uniform(0.0, 1.0);
    if (draw < 0.5) {
      add_contact(contact);
    } else if (draw < 0.65) {
      add_repeated(contact);
    } else if (draw < 0.8) {
      add_nearly_parallel(contact);
    } else if (draw < 0.85) {
      add_clamp(contact);
    } else {
      add_face(contact);
    }
  }

  void add_repeated(const Contact& contact) {
    for (int copies = 2 + pick(2); copies > 0; --copies) {
      add_contact(contact);
    }
  }

  void add_nearly_parallel(const Contact& contact) {
    add_contact(contact);
    const double angle = std::pow(10.0, uniform(-9.0, -1.0));
    for (int more = 1 + pick(2); more > 0; --more) {
      Contact turned = contact;
      turned.normal = (contact.normal + angle * vector()).normalized();
      add_contact(turned);
    }
  }

  void add_clamp(const Contact& contact) {
    add_contact(contact);
    Contact opposite = contact;
    opposite.normal = -contact.normal;
    const double distance = uniform(0.1, 1.0);
    opposite.point_a += distance * contact.normal;
    opposite.point_b = opposite.point_a;
    add_contact(opposite);
  }

  void add_face(const Contact& contact) {
    const Vec3 u = contact.normal.unitOrthogonal();
    const Vec3 v = contact.normal.cross(u);
    const double width = uniform(0.1, 1.0);
    const double depth = uniform(0.1, 1.0);
    for (const auto& [i, j] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      Contact corner = contact;
      corner.point_a += 0.5 * (i * width * u + j * depth * v);
      corner.point_b = corner.point_a;
      add_contact(corner);
    }
  }

  void add_contact(Contact contact) {
    const double draw = uniform(0.0, 1.0);
    contact.material.restitution = draw < 0.2 ? 0.0 : (draw < 0.4 ? 1.0 : uniform(0.0, 1.0));
    if (options_.most_friction > 0.0) {
      contact.material.friction = chance(0.2) ? 0.0 : uniform(0.0, options_.most_friction);
    }
    impact_.contacts.push_back(contact);
  }

  RandomImpactOptions options_;
  std::mt19937_64 random_;
  RandomImpact impact_;
};

}  // namespace

RandomImpact draw_random_impact(std::uint64_t seed, int index, const RandomImpactOptions& options) {
  std::seed_seq mixed{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                      static_cast<std::uint32_t>(index)};
  return Generator(mixed, options).draw();
}

}  // namespace signorini::bench
