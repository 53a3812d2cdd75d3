// Your own bodies and your own integrator: in each step you hand over velocities and contacts, and
// get the impulses of all contacts at once. A crate slides on the floor on its four corners and is
// braked by friction; three of the four contacts are independent, which is no trouble.
#include <signorini/core/response/contact_solver.h>

#include <iostream>

using signorini::Vec3;

int main() {
  const double h = 0.01;  // s
  signorini::Bodies bodies = {
      {.mass = 10.0, .inertia = 1.0 * signorini::Mat3::Identity(), .name = "crate"},
      {.kind = signorini::BodyKind::kFixed, .name = "floor"}};
  signorini::State state(2);
  state[0].x = Vec3(0.0, 0.0, 0.5);
  set_velocity(bodies[0], {.linear = Vec3(1.0, 0.0, 0.0)}, state[0]);

  signorini::ContactSolver solver;  // Coulomb's cones, solver "auto", warm start
  signorini::ContactSolution solution;
  for (int step = 0; step < 10; ++step) {
    state[0].p += h * bodies[0].mass * Vec3(0.0, 0.0, -9.81);  // your forces

    signorini::ContactSet contacts;  // your collision detection
    for (int corner = 0; corner < 4; ++corner) {
      signorini::Contact contact;
      contact.body_a = 0;
      contact.body_b = 1;
      contact.point_a =
          state[0].x + Vec3(corner % 2 == 0 ? -0.5 : 0.5, corner < 2 ? -0.5 : 0.5, -0.5);
      contact.point_b = contact.point_a;
      contact.normal = Vec3::UnitZ();
      contact.gap = 0.0;
      contact.feature_id = corner;
      contact.material = {.friction = 0.5, .restitution = 0.0};
      contacts.push_back(contact);
    }
    solver.solve(bodies, contacts, allowances(bodies, state, contacts, h, 1e-6, 0.2), state,
                 solution);
    state[0].x += h * velocity(bodies[0], state[0]).linear;  // your integrator
  }
  const Vec3 v = velocity(bodies[0], state[0]).linear;  // 1 - 0.5 * 9.81 * 0.1 m/s
  std::cout << to_string(solution.status) << ": v = " << v.x() << " m/s, weight "
            << solution.normal_impulses.sum() / h << " N\n";
  return is_solved(solution.status) ? 0 : 1;
}
