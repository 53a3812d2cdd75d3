#include <signorini/core/response/assembly.h>
#include <signorini/core/response/position_projection.h>

#include <algorithm>

namespace signorini {
namespace {

bool any_overlap(const ContactSet& contacts) {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const Contact& contact) { return contact.gap < -kToleratedOverlap; });
}

// x += dx, q <- exp(dtheta) q.
void displace(const Vec3& dx, const Vec3& dtheta, BodyState& state) {
  state.x += dx;
  const double angle = dtheta.norm();
  if (angle > 0.0) {
    state.q = (Quat(Eigen::AngleAxisd(angle, dtheta / angle)) * state.q).normalized();
  }
}

}  // namespace

void project_positions(const Bodies& bodies, const ContactSet& contacts, const Vec3& gravity,
                       lcp::Solver& solver, State& state, ProjectionReport& report) {
  report = {};
  if (!any_overlap(contacts)) {
    return;
  }
  NormalRows rows;
  assemble_normals(bodies, state, contacts, rows);
  lcp::Problem problem;
  problem.q.resize(static_cast<lcp::Index>(contacts.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    problem.q[i] = contacts[i].gap;
  }
  problem.M = rows.A;
  lcp::Result result;
  solver.solve(problem, result);
  report.status = result.status;
  if (!lcp::is_solved(result.status)) {
    report.detail = "position projection: " + std::string(lcp::to_string(result.status)) +
                    (result.detail.empty() ? "" : " (" + result.detail + ")") +
                    ", overlaps left as they are";
    return;
  }

  lcp::Vector push(rows.A.degrees_of_freedom());
  lcp::Vector displacement(rows.A.degrees_of_freedom());
  rows.A.transpose_times(result.z.data(), push.data());
  rows.A.apply_inverse_mass(push.data(), displacement.data());
  const double kinetic_before = kinetic_energy(bodies, state);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (rows.block_of_body[k] >= 0) {
      const int offset = rows.A.mass.offset(rows.block_of_body[k]);
      const Vec3 dx = displacement.segment<3>(offset);
      displace(dx, displacement.segment<3>(offset + 3), state[k]);
      report.energy_change -= bodies[k].mass * bodies[k].gravity_scale * gravity.dot(dx);
      report.largest_displacement = std::max(report.largest_displacement, dx.norm());
    }
  }
  report.energy_change += kinetic_energy(bodies, state) - kinetic_before;
}

}  // namespace signorini
