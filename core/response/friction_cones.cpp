#include <signorini/core/response/friction_cones.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace signorini {

void assemble_cones(const Bodies& bodies, const State& free_state, const ContactSet& contacts,
                    const lcp::VectorRef& allowance, ConeProblem& out,
                    std::span<const JointRow> joints) {
  if (allowance.size() != static_cast<lcp::Index>(contacts.size())) {
    throw std::invalid_argument("allowance: must have one number a contact (" +
                                std::to_string(contacts.size()) + "), got " +
                                std::to_string(allowance.size()));
  }
  check_dynamic(bodies, contacts);
  std::vector<Velocity> velocities;
  if (!contacts.empty()) {
    velocities = velocities_of(bodies, free_state);
  }
  ConeProblem fresh = std::move(out);  // its memory
  fresh.normal_row.clear();
  fresh.frames.clear();
  fresh.friction.clear();
  fresh.problem.cones.clear();
  fresh.problem.limits.clear();
  fresh.problem.lower.resize(0);
  fresh.problem.upper.resize(0);
  NormalRows rows;
  if (auto* used = std::get_if<lcp::FactoredMatrix>(&fresh.problem.M)) {
    rows.A = std::move(*used);
  }
  start_rows(bodies, free_state, contacts, rows, body_pairs(joints));
  std::vector<double> q;
  q.reserve(3 * contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    fresh.normal_row.push_back(rows.A.rows());
    fresh.frames.emplace_back();
    fresh.friction.push_back(contact.material.friction);
    add_row(free_state, contact, contact.normal, contact.point_a, contact.point_b, rows);
    q.push_back(gap_velocity(velocities, free_state, contact) +
                allowance[static_cast<lcp::Index>(i)]);
    if (contact.material.friction > 0.0) {
      const Vec3 slip = slip_velocity(velocities, free_state, contact);
      const TangentFrame frame = friction_frame(contact, slip);
      for (const Vec3& tangent : {frame.t1, frame.t2}) {
        add_tangent_row(free_state, contact, tangent, rows);
        q.push_back(tangent.dot(slip));
      }
      fresh.frames.back() = frame;
      fresh.problem.cones.push_back({.normal_row = fresh.normal_row.back(),
                                     .dimension = 3,
                                     .coefficient = contact.material.friction});
    }
  }
  add_joint_rows(joints, rows);
  q.resize(q.size() + joints.size());
  fresh.problem.q = Eigen::Map<const lcp::Vector>(q.data(), static_cast<lcp::Index>(q.size()));
  set_joint_bounds(joint_velocities(bodies, free_state, joints), joints, fresh.problem);
  fresh.problem.M = std::move(rows.A);
  out = std::move(fresh);
}

lcp::Vector normal_impulses(const ConeProblem& cones, const lcp::VectorRef& z) {
  lcp::Vector f(static_cast<lcp::Index>(cones.normal_row.size()));
  for (lcp::Index i = 0; i < f.size(); ++i) {
    f[i] = z[cones.normal_row[i]];
  }
  return f;
}

std::vector<Vec3> contact_impulses(const ConeProblem& cones, const ContactSet& contacts,
                                   const lcp::VectorRef& z) {
  std::vector<Vec3> impulses;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const int row = cones.normal_row[i];
    impulses.emplace_back(z[row] * contacts[i].normal);
    if (cones.friction[i] > 0.0) {
      impulses.back() += z[row + 1] * cones.frames[i].t1 + z[row + 2] * cones.frames[i].t2;
    }
  }
  return impulses;
}

}  // namespace signorini
