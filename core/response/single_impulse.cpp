#include <signorini/core/response/assembly.h>
#include <signorini/core/response/single_impulse.h>

#include <stdexcept>
#include <string>

namespace signorini {
namespace {

/// 1/m + (r x N)^T J^-1 (r x N); zero unless dynamic.
double inverse_effective_mass(const Body& body, const BodyState& state, const Vec3& point,
                              const Vec3& normal) {
  const Vec3 arm = (point - state.x).cross(normal);
  return inverse_mass(body) + arm.dot(inverse_inertia_world(body, state) * arm);
}

void push(const Body& body, const Vec3& point, const Vec3& impulse, BodyState& state) {
  if (body.is_dynamic()) {
    state.p += impulse;
    state.L += (point - state.x).cross(impulse);
  }
}

}  // namespace

SingleImpulse single_impulse(const Bodies& bodies, const State& state, const Contact& contact) {
  const int a = contact.body_a;
  const int b = contact.body_b;
  if (!bodies[a].is_dynamic() && !bodies[b].is_dynamic()) {
    throw std::invalid_argument("contact: body_a " + std::to_string(a) + " and body_b " +
                                std::to_string(b) + ": at least one must be dynamic");
  }
  SingleImpulse impulse;
  impulse.denominator =
      inverse_effective_mass(bodies[a], state[a], contact.point_a, contact.normal) +
      inverse_effective_mass(bodies[b], state[b], contact.point_b, contact.normal);
  impulse.d_dot = gap_velocity(bodies, state, contact);
  if (impulse.d_dot < 0.0) {
    impulse.f_min = -impulse.d_dot / impulse.denominator;
    impulse.f_max = 2.0 * impulse.f_min;
  }
  return impulse;
}

void apply_impulse(const Bodies& bodies, const Contact& contact, double f, State& state) {
  const int a = contact.body_a;
  const int b = contact.body_b;
  push(bodies[a], contact.point_a, f * contact.normal, state[a]);
  push(bodies[b], contact.point_b, -f * contact.normal, state[b]);
}

}  // namespace signorini
