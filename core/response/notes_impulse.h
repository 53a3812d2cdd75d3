#pragma once

#include <signorini/core/model/contact.h>
#include <signorini/core/response/assembly.h>
#include <signorini/lcp/problem.h>

#include <vector>

namespace signorini {

/// The notes' simultaneous impulse (notes, section 4; design, section 4.3): over f and y = d'+
///
///     minimise 1/2 |y - t|^2   s.t.  y = A f + d'-,  f >= 0,  y >= 0,  y_i <= |d_i'-| for i in C,
///
/// t_i = -e_i d_i'- where d_i'- < -threshold (colliding), else d_i'-; C the colliding contacts (or
/// all of them). y is unique (the projection of t on a convex set), f is not where contacts are
/// redundant.
///
/// Its KKT conditions, with mu free for the equality, gamma >= 0 for the upper bounds and E the
/// columns of I that belong to C:
///
///     0 <= f     ⊥  A mu                      >= 0
///     0 <= y     ⊥  y - t - mu + E gamma      >= 0
///     0 <= gamma ⊥  |d'-|_C - E^T y           >= 0
///     mu free,      y - A f - d'-             =  0
///
/// Eliminating mu and y would leave A^2, whose condition is that of A squared. Here A stands alone,
/// and the one thing that a pure LCP lacks, the free mu, is written mu = sigma - tau/n (1, .., 1)
/// with sigma >= 0, tau >= 0: the rows of sigma say y - A f - d'- >= 0, the row of tau says that
/// their mean is <= 0, so together they are zero. With phi_i = A_ii f_i, B = A diag(A)^-1 every
/// unknown and every row is in m/s and the LCP over z = (phi, y, gamma, sigma, tau) is
///
///         | 0     0    0    B^T   -B^T 1/n |        |    0     |
///         | 0     I    E    -I       1/n   |        |   -t     |
///     M = | 0    -E^T  0     0        0    |    q = | |d'-|_C  |
///         | -B    I    0     0        0    |        |  -d'-    |
///         | 1^TB/n -1^T/n 0  0        0    |        | mean d'- |
///
/// M + M^T is 2 I on y and zero elsewhere: M is positive semidefinite, so Lemke ends in a solution
/// or in a proof that the constraints contradict each other. They can: a contact that approaches
/// slowly beside one that approaches fast may have to open faster than |d'-|; and with C = all
/// contacts, a rod on two supports that is hit beyond one of them.
struct NotesProblem {
  lcp::Problem problem;  ///< 3n + |C| + 1 rows, sparse
  lcp::Vector diagonal;  ///< A_ii, 1/kg
  lcp::Vector upper;     ///< |d_i'-| in C, +infinity elsewhere, m/s
};

/// @param threshold m/s, >= 0. @param bound_every_contact C: every contact, not the colliding
/// alone.
[[nodiscard]] NotesProblem notes_problem(const NormalRows& rows, const ContactSet& contacts,
                                         double threshold, bool bound_every_contact);

/// f of a solution z of the LCP, N s.
[[nodiscard]] lcp::Vector notes_impulses(const NotesProblem& notes, const lcp::VectorRef& z);

/// The largest violation of the notes' own conditions by f, recomputed without the LCP's unknowns:
/// max over the contacts of -A_ii f_i, -d_i'+ and d_i'+ - |d_i'-| (in C), m/s; <= 0 is none.
[[nodiscard]] double notes_violation(const NotesProblem& notes, const NormalRows& rows,
                                     const lcp::VectorRef& f);

}  // namespace signorini
