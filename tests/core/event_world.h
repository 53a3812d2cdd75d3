#pragma once

#include <signorini/collision/collision_world.h>
#include <signorini/core/response/event_stepper.h>

#include "response_scenes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

namespace signorini::scenes {

inline constexpr double kG = 9.81;

inline collision::Collider collider(int body, const collision::Shape& shape, double e,
                                    double mu = 0.0) {
  collision::Collider made;
  made.body = body;
  made.shape = shape;
  made.material.restitution = e;
  made.material.friction = mu;
  return made;
}

/// A scene with shapes: body 0 is the ground, z <= 0. Materials of a pair are multiplied; the
/// ground has e = 1 and mu = 1.
struct World {
  Scene scene;
  std::vector<collision::Collider> colliders;
  World() {
    scene.add(fixed_body(), Vec3::Zero());
    colliders.push_back(collider(0, collision::HalfSpace{}, 1.0, 1.0));
  }
  int add(const Body& body, const collision::Shape& shape, const Vec3& x, double e,
          const Velocity& motion = {}, double mu = 0.0) {
    const int index = scene.add(body, x, motion);
    colliders.push_back(collider(index, shape, e, mu));
    return index;
  }
  EventReport run(double duration, const EventSettings& settings = {}) {
    collision::CollisionWorld finder(scene.bodies, colliders, PairingRule::kMultiply);
    EventStepper stepper(scene.bodies, finder, settings);
    EventReport report;
    stepper.advance(scene.state, duration, report);
    EXPECT_TRUE(lcp::is_solved(report.status)) << report.detail;
    return report;
  }
  [[nodiscard]] double energy(const Vec3& gravity) const {
    return kinetic_energy(scene.bodies, scene.state) +
           potential_energy(scene.bodies, scene.state, gravity);
  }
};

inline int count(const EventReport& report, EventKind kind) {
  return static_cast<int>(std::count_if(report.events.begin(), report.events.end(),
                                        [kind](const Event& event) { return event.kind == kind; }));
}

}  // namespace signorini::scenes
