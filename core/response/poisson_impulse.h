#pragma once

#include <signorini/core/model/contact.h>
#include <signorini/core/response/assembly.h>
#include <signorini/lcp/problem.h>

namespace signorini {

/// Poisson's restitution for all contacts at once: compression stops the approach, expansion gives
/// back e_i of what each contact took in (Glocker and Pfeiffer, Multiple impacts with friction in
/// rigid multibody systems, Nonlinear Dynamics 7, 1995, without friction):
///
///     compression  0 <= f_c ⊥ A f_c + d'- >= 0                       plastic_problem()
///     expansion    0 <= p ⊥ A p + A (f_c + E f_c) + d'- >= 0          expansion_problem()
///     f = f_c + E f_c + p,   E = diag(e_i)
///
/// p is what expansion needs beyond e_i f_c,i so that no contact closes: the rule f_x >= E f_c, f_x
/// - E f_c ⊥ d'+ of the source. Exists where compression does. For one common e it gains no kinetic
/// energy (T+ - T- <= -(1 - e^2)/2 f_c.A f_c); with different ones it can. d'+ is unique for a
/// common e; with different ones it depends on f_c, which redundant contacts leave open: the one of
/// least norm is taken.
///
/// The expansion LCP. @param compression f_c, N s
[[nodiscard]] lcp::Problem expansion_problem(const NormalRows& rows, const ContactSet& contacts,
                                             const lcp::VectorRef& compression);

/// f_c + E f_c + p, N s.
[[nodiscard]] lcp::Vector poisson_impulses(const ContactSet& contacts,
                                           const lcp::VectorRef& compression,
                                           const lcp::VectorRef& expansion);

}  // namespace signorini
