#include <signorini/core/response/newton_impulse.h>
#include <signorini/core/response/poisson_impulse.h>

namespace signorini {
namespace {

/// f_c + E f_c.
lcp::Vector given_back(const ContactSet& contacts, const lcp::VectorRef& compression) {
  lcp::Vector f = compression;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    f[static_cast<lcp::Index>(i)] *= 1.0 + contacts[i].material.restitution;
  }
  return f;
}

}  // namespace

lcp::Problem expansion_problem(const NormalRows& rows, const ContactSet& contacts,
                               const lcp::VectorRef& compression) {
  lcp::Problem problem = plastic_problem(rows);
  problem.q = gap_velocities_after(rows, given_back(contacts, compression));
  return problem;
}

lcp::Vector poisson_impulses(const ContactSet& contacts, const lcp::VectorRef& compression,
                             const lcp::VectorRef& expansion) {
  return given_back(contacts, compression) + expansion;
}

}  // namespace signorini
