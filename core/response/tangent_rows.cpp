#include <signorini/core/response/tangent_rows.h>

#include <utility>

namespace signorini {
namespace {

constexpr double kLeastAlong = 1e-9;  // of a unit direction's part across N

/// The part of v across N; again, as cancellation leaves a part along N of v all but along it.
Vec3 part_across(const Vec3& normal, const Vec3& v) {
  const Vec3 once = v - v.dot(normal) * normal;
  return once - once.dot(normal) * normal;
}

}  // namespace

TangentFrame tangent_frame(const Vec3& normal, const Vec3& slip) {
  const Vec3 tangential = part_across(normal, slip);
  const double speed = tangential.norm();
  const Vec3 t1 = speed >= kAligningSlip ? Vec3(tangential / speed) : normal.unitOrthogonal();
  return {t1, normal.cross(t1)};
}

TangentFrame friction_frame(const Contact& contact, const Vec3& slip) {
  const double ratio = contact.material.friction_ratio;
  if (ratio == 1.0) {
    return tangent_frame(contact.normal, slip);
  }
  const Vec3& normal = contact.normal;
  const Vec3 direction = contact.friction_direction.normalized();  // zero stays
  const Vec3 along = part_across(normal, direction);
  const Vec3 t1 = along.norm() > kLeastAlong ? along.normalized() : normal.unitOrthogonal();
  return {t1, ratio * normal.cross(t1)};
}

Vec3 friction_point(const Contact& contact) {
  return 0.5 * (contact.point_a + contact.point_b);
}

Vec3 slip_velocity(const std::vector<Velocity>& velocities, const State& state,
                   const Contact& contact) {
  const int a = contact.body_a;
  const int b = contact.body_b;
  const Vec3 point = friction_point(contact);
  return velocities[a].at(point - state[a].x) - velocities[b].at(point - state[b].x);
}

Vec3 slip_velocity(const Bodies& bodies, const State& state, const Contact& contact) {
  const int a = contact.body_a;
  const int b = contact.body_b;
  const Vec3 point = friction_point(contact);
  return velocity(bodies[a], state[a]).at(point - state[a].x) -
         velocity(bodies[b], state[b]).at(point - state[b].x);
}

void add_tangent_row(const State& state, const Contact& contact, const Vec3& tangent,
                     NormalRows& rows) {
  const Vec3 point = friction_point(contact);
  add_row(state, contact, tangent, point, point, rows);
}

void apply_contact_impulses(const Bodies& bodies, const ContactSet& contacts,
                            const std::vector<Vec3>& impulses, State& state) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 point = friction_point(contacts[i]);
    for (const auto& [body, sign] :
         {std::pair{contacts[i].body_a, 1.0}, {contacts[i].body_b, -1.0}}) {
      if (bodies[body].is_dynamic()) {
        state[body].p += sign * impulses[i];
        state[body].L += (point - state[body].x).cross(sign * impulses[i]);
      }
    }
  }
}

}  // namespace signorini
