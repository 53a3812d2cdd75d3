#include <signorini/core/model/contact_kinematics.h>
#include <signorini/core/model/number_text.h>
#include <signorini/core/response/contact_acceleration.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace signorini {
namespace {

void validate_wrenches(const char* field, const std::vector<Wrench>& wrenches,
                       std::size_t body_count) {
  if (wrenches.size() != body_count) {
    throw std::invalid_argument(std::string(field) + ": must have one entry a body (" +
                                std::to_string(body_count) + "), got " +
                                std::to_string(wrenches.size()));
  }
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    for (const auto& [part, value] :
         {std::pair{"force", &wrenches[i].force}, std::pair{"torque", &wrenches[i].torque}}) {
      if (!value->allFinite()) {
        throw std::invalid_argument(std::string(field) + ": body " + std::to_string(i) + ": " +
                                    part + ": must be finite, got " + number_text(*value));
      }
    }
  }
}

BodyAcceleration free_acceleration(const Body& body, const BodyState& state, const Wrench& load,
                                   const Wrench& driven) {
  const Vec3 w = velocity(body, state).angular;
  switch (body.kind) {
    case BodyKind::kDynamic: {
      const Vec3 torque = load.torque - w.cross(state.L);
      return {load.force / body.mass, inverse_inertia_world(body, state) * torque, w};
    }
    case BodyKind::kKinematic: return {driven.force, driven.torque, w};
    case BodyKind::kFixed: break;
  }
  return {};
}

}  // namespace

std::vector<Wrench> gravity_loads(const Bodies& bodies, const Vec3& gravity) {
  std::vector<Wrench> loads(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies[k].is_dynamic()) {
      loads[k].force = bodies[k].mass * bodies[k].gravity_scale * gravity;
    }
  }
  return loads;
}

std::vector<BodyAcceleration> free_accelerations(const Bodies& bodies, const State& state,
                                                 const std::vector<Wrench>& loads,
                                                 const std::vector<Wrench>& driven) {
  validate_wrenches("loads", loads, bodies.size());
  if (!driven.empty()) {
    validate_wrenches("driven_acceleration", driven, bodies.size());
  }
  std::vector<BodyAcceleration> accelerations;
  accelerations.reserve(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Wrench of_driver = driven.empty() ? Wrench{} : driven[k];
    accelerations.push_back(free_acceleration(bodies[k], state[k], loads[k], of_driver));
  }
  return accelerations;
}

ContactAcceleration contact_acceleration(const Bodies& bodies, const State& state,
                                         const Contact& contact,
                                         const std::vector<BodyAcceleration>& accelerations) {
  const int a = contact.body_a;
  const int b = contact.body_b;
  const GapKinematics gap = gap_kinematics(contact, state[a], velocity(bodies[a], state[a]),
                                           state[b], velocity(bodies[b], state[b]));
  const Vec3 a_a = accelerations[a].at(contact.point_a - state[a].x);
  const Vec3 a_b = accelerations[b].at(contact.point_b - state[b].x);
  return {.normal = contact.normal.dot(a_a - a_b) + gap.curvature_acceleration,
          .slip = a_a + accelerations[a].spin.cross(gap.wander_a) - a_b -
                  accelerations[b].spin.cross(gap.wander_b),
          .degenerate = gap.degenerate};
}

}  // namespace signorini
