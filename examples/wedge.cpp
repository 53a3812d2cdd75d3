// Your own bodies and contacts: a ball falls into a wedge and touches both sides at once. Each
// contact alone would push it into the other side; together they send it straight back up.
#include <signorini/core/response/impact.h>

#include <cmath>
#include <iostream>

using signorini::Vec3;

namespace {

signorini::Contact touch(const Vec3& ball_centre, double radius, const Vec3& normal) {
  signorini::Contact contact;
  contact.body_a = 0;                    // the ball
  contact.body_b = 1;                    // the wedge
  contact.normal = normal.normalized();  // from B to A
  contact.point_a = ball_centre - radius * contact.normal;
  contact.point_b = contact.point_a;
  contact.gap = 0.0;
  contact.surface_a = signorini::LocalSurface::sphere(radius);
  contact.surface_b = signorini::LocalSurface::face();
  contact.material = {.friction = 0.0, .restitution = 1.0};
  return contact;
}

double without_noise(double x) {
  return std::abs(x) < 1e-12 ? 0.0 : x;
}

}  // namespace

int main() {
  const double radius = 0.5;
  signorini::Bodies bodies(2);
  bodies[0] = {.mass = 1.0, .inertia = 0.1 * signorini::Mat3::Identity(), .name = "ball"};
  bodies[1] = {.kind = signorini::BodyKind::kFixed, .name = "wedge"};
  signorini::State state(2);
  state[0].p = Vec3(0.0, -1.0, 0.0);  // kg m/s

  const signorini::ContactSet contacts = {touch(state[0].x, radius, Vec3(1.0, 1.0, 0.0)),
                                          touch(state[0].x, radius, Vec3(-2.0, 1.0, 0.0))};
  signorini::ImpactReport report;
  signorini::resolve_impact(bodies, contacts, {}, state, report);

  const Vec3 v = velocity(bodies[0], state[0]).linear;
  std::cout << to_string(report.status) << ": v = (" << without_noise(v.x()) << ", " << v.y()
            << "), energy " << report.energy_before << " J -> " << report.energy_after << " J\n";
  return is_solved(report.status) ? 0 : 1;
}
