/* Contacts from C: in each step a host hands over bodies and contacts and gets impulses and new
 * velocities. A ball falls on a plank that lies on the floor: all contacts answer at once. */
#include <math.h>
#include <signorini/c/signorini.h>
#include <stdio.h>

static signorini_contact touch(int32_t a, int32_t b, double x, double y, double z, uint64_t id) {
  const signorini_contact contact = {.body_a = a,
                                     .body_b = b,
                                     .point_a = {x, y, z},
                                     .point_b = {x, y, z},
                                     .normal = {0.0, 0.0, 1.0}, /* from B to A */
                                     .gap = 0.0,
                                     .friction = 0.5,
                                     .restitution = 0.0,
                                     .allowance = NAN, /* from gap and restitution */
                                     .feature_id = id};
  return contact;
}

int main(void) {
  const double step = 0.01; /* s */
  const signorini_body bodies[3] = {
      {.kind = SIGNORINI_FIXED, .orientation = {1.0, 0.0, 0.0, 0.0}},
      {.kind = SIGNORINI_DYNAMIC, /* the plank, 2 m x 1 m x 0.1 m */
       .mass = 12.0,
       .inertia = {1.01, 0.0, 0.0, 0.0, 4.01, 0.0, 0.0, 0.0, 5.0},
       .position = {0.0, 0.0, 0.05},
       .orientation = {1.0, 0.0, 0.0, 0.0},
       .linear_velocity = {0.0, 0.0, -9.81 * 0.01}}, /* after the step's forces */
      {.kind = SIGNORINI_DYNAMIC, /* the ball, of radius 0.5 m */
       .mass = 5.0,
       .inertia = {0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5},
       .position = {0.5, 0.0, 0.6},
       .orientation = {1.0, 0.0, 0.0, 0.0},
       .linear_velocity = {0.0, 0.0, -2.0}}};
  const signorini_contact contacts[5] = {
      touch(1, 0, -1.0, -0.5, 0.0, 0), touch(1, 0, 1.0, -0.5, 0.0, 1),
      touch(1, 0, -1.0, 0.5, 0.0, 2), touch(1, 0, 1.0, 0.5, 0.0, 3), touch(2, 1, 0.5, 0.0, 0.1, 4)};
  signorini_contact_solver* solver = NULL;
  signorini_contact_result* result = NULL;
  int failed = signorini_contact_solver_create(&solver) ||
               signorini_contact_solver_set_number(solver, "restitution_threshold", 0.2) ||
               signorini_contact_result_create(&result) ||
               signorini_contact_solver_solve(solver, step, 3, bodies, 5, contacts, result);
  if (failed) {
    fprintf(stderr, "%s\n", signorini_last_error());
  } else {
    const signorini_status status = signorini_contact_result_status(result);
    const double* f = signorini_contact_result_normal_impulses(result);
    const double* v = signorini_contact_result_velocities(result);
    printf("%s: the floor takes %.4f N s, the plank %.4f N s, the ball stops at %.4f m/s\n",
           signorini_status_text(status), f[0] + f[1] + f[2] + f[3], f[4], fabs(v[6 * 2 + 2]));
    failed = !signorini_is_solved(status);
  }
  signorini_contact_result_destroy(result);
  signorini_contact_solver_destroy(solver);
  return failed;
}
