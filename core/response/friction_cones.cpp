#include <signorini/core/response/friction_cones.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace signorini {

void assemble_cones(const Bodies& bodies, const State& free_state, const ContactSet& contacts,
                    const lcp::VectorRef& allowance, ConeProblem& out,
                    std::span<const JointRow> joints, BodyColumns columns) {
  if (allowance.size() != static_cast<lcp::Index>(contacts.size())) {
    throw std::invalid_argument("allowance: must have one number a contact (" +
                                std::to_string(contacts.size()) + "), got " +
                                std::to_string(allowance.size()));
  }
  check_dynamic(bodies, contacts);
  ConeProblem fresh = std::move(out);  // its memory
  const std::vector<Velocity>& velocities = fresh.memory.velocities;
  velocities_of(bodies, free_state, fresh.memory.velocities);
  fresh.normal_row.clear();
  fresh.frames.clear();
  fresh.friction.clear();
  fresh.problem.cones.clear();
  fresh.problem.limits.clear();
  NormalRows& rows = fresh.memory.rows;
  if (auto* used = std::get_if<lcp::FactoredMatrix>(&fresh.problem.M)) {
    rows.A = std::move(*used);
  }
  fresh.memory.joined.clear();
  add_body_pairs(joints, fresh.memory.joined);
  start_rows(bodies, free_state, contacts, rows, fresh.memory.joined, columns);
  fresh.columns = rows.A.degrees_of_freedom();
  lcp::Index size = static_cast<lcp::Index>(contacts.size() + joints.size());
  for (const Contact& contact : contacts) {
    size += contact.material.friction > 0.0 ? 2 : 0;
  }
  lcp::Vector& q = fresh.problem.q;
  q.resize(size);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    fresh.normal_row.push_back(rows.A.rows());
    fresh.frames.emplace_back();
    fresh.friction.push_back(contact.material.friction);
    add_row(free_state, contact, contact.normal, contact.point_a, contact.point_b, rows);
    q[fresh.normal_row.back()] =
        gap_velocity(velocities, free_state, contact) + allowance[static_cast<lcp::Index>(i)];
    if (contact.material.friction > 0.0) {
      const Vec3 slip = slip_velocity(velocities, free_state, contact);
      const TangentFrame frame = friction_frame(contact, slip);
      for (const Vec3& tangent : {frame.t1, frame.t2}) {
        add_tangent_row(free_state, contact, tangent, rows);
        q[rows.A.rows() - 1] = tangent.dot(slip);
      }
      fresh.frames.back() = frame;
      fresh.problem.cones.push_back({.normal_row = fresh.normal_row.back(),
                                     .dimension = 3,
                                     .coefficient = contact.material.friction});
    }
  }
  add_joint_rows(joints, rows);
  set_joint_bounds(velocities, joints, fresh.problem);
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

void contact_impulses(const ConeProblem& cones, const ContactSet& contacts, const lcp::VectorRef& z,
                      std::vector<Vec3>& impulses) {
  impulses.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const int row = cones.normal_row[i];
    impulses.emplace_back(z[row] * contacts[i].normal);
    if (cones.friction[i] > 0.0) {
      impulses.back() += z[row + 1] * cones.frames[i].t1 + z[row + 2] * cones.frames[i].t2;
    }
  }
}

std::vector<Vec3> contact_impulses(const ConeProblem& cones, const ContactSet& contacts,
                                   const lcp::VectorRef& z) {
  std::vector<Vec3> impulses;
  contact_impulses(cones, contacts, z, impulses);
  return impulses;
}

}  // namespace signorini
