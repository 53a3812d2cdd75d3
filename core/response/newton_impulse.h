#pragma once

#include <signorini/core/model/contact.h>
#include <signorini/core/response/assembly.h>
#include <signorini/lcp/problem.h>

namespace signorini {

/// Newton's restitution for all contacts at once (design, section 4.2):
///
///     0 <= f ⊥ A f + d'- + e_i d_i'- >= 0,   the e term only where d_i'- < -threshold.
///
/// A is symmetric positive semidefinite: Lemke solves it or shows that it is infeasible. A f, hence
/// d'+, is unique; f is not where contacts are redundant.
[[nodiscard]] lcp::Problem newton_problem(const NormalRows& rows, const ContactSet& contacts,
                                          double threshold);

/// The same with e = 0: 0 <= f_c ⊥ A f_c + d'- >= 0. Feasible when what touches is free or
/// immovable; T+ - T- = -1/2 f_c.A f_c <= 0.
[[nodiscard]] lcp::Problem plastic_problem(const NormalRows& rows);

}  // namespace signorini
