#include <signorini/core/response/newton_impulse.h>

namespace signorini {

lcp::Problem newton_problem(const NormalRows& rows, const ContactSet& contacts, double threshold) {
  lcp::Problem problem = plastic_problem(rows);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (rows.d_dot[i] < -threshold) {
      problem.q[i] += contacts[i].material.restitution * rows.d_dot[i];
    }
  }
  return problem;
}

lcp::Problem plastic_problem(const NormalRows& rows) {
  lcp::Problem problem;
  problem.M = rows.A;
  problem.q = rows.d_dot;
  return problem;
}

}  // namespace signorini
