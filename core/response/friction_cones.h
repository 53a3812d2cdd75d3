#pragma once

#include <signorini/core/response/joint_rows.h>
#include <signorini/core/response/tangent_rows.h>
#include <signorini/lcp/problem.h>

#include <vector>

namespace signorini {

/// The velocity-level contact problem with Coulomb's friction exactly (De Saxce's form,
/// lcp/problem.h): contact i has the row N and, where mu_i > 0, the rows t1 and t2 after it,
///
///     z = [.., f_i, beta_i1, beta_i2, ..] N s, w = A z + q = [.., d_i'+ + allowance_i, u_T+, ..],
///     q = [.., d_i'* + allowance_i, u_T*, ..] m/s, A = J M^-1 J^T over all these rows,
///     0 <= f_i ⊥ w_N >= 0, |beta_i| <= mu_i f_i, beta_i = -mu_i f_i u_T+/|u_T+| where it slides
///
/// t1, t2: friction_frame(), scaled where friction is anisotropic; u* the velocities without
/// contact impulses; friction acts at friction_point(). Without friction it is an LCP. M is
/// left factored. Rows of joints (joint_rows.h) follow those of all contacts, with their bounds.
struct ConeProblem {
  lcp::Problem problem;
  std::vector<int> normal_row;       ///< of each contact
  std::vector<TangentFrame> frames;  ///< of each contact; used where mu > 0
  std::vector<double> friction;      ///< mu of each contact
  int columns = 0;                   ///< of J
  /// What assembling needs beside its outcome, kept from step to step.
  struct Memory {
    std::vector<Velocity> velocities;  // of the bodies
    BodyPairs joined;
    NormalRows rows;  // its A is in the problem
  } memory;

  [[nodiscard]] const lcp::FactoredMatrix& A() const {
    return std::get<lcp::FactoredMatrix>(problem.M);
  }
};

/// Assembles the problem. Cost: O(bodies + n).
/// @param free_state positions of the step's start, momenta without contact impulses; its slip
/// chooses the frames
/// @param allowance one a contact, m/s: how fast the gap may close, or, negative, must open
/// @param joints rows with these bodies' numbers
/// @param columns as start_rows()
/// @throws std::invalid_argument if neither body of a contact is dynamic or an allowance is
/// missing; out is then untouched.
void assemble_cones(const Bodies& bodies, const State& free_state, const ContactSet& contacts,
                    const lcp::VectorRef& allowance, ConeProblem& out,
                    std::span<const JointRow> joints = {}, BodyColumns columns = BodyColumns::kSix);

/// f of every contact, N s.
[[nodiscard]] lcp::Vector normal_impulses(const ConeProblem& cones, const lcp::VectorRef& z);
/// The impulse of every contact on its body A, world axes, N s: f N + beta_1 t1 + beta_2 t2.
void contact_impulses(const ConeProblem& cones, const ContactSet& contacts, const lcp::VectorRef& z,
                      std::vector<Vec3>& impulses);
[[nodiscard]] std::vector<Vec3> contact_impulses(const ConeProblem& cones,
                                                 const ContactSet& contacts,
                                                 const lcp::VectorRef& z);

}  // namespace signorini
