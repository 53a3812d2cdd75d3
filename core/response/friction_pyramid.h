#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/response/joint_rows.h>
#include <signorini/core/response/tangent_rows.h>
#include <signorini/lcp/problem.h>

#include <vector>

namespace signorini {

/// The velocity-level contact LCP with friction as a k-sided pyramid (Stewart and Trinkle, An
/// implicit time-stepping scheme for rigid body dynamics with inelastic collisions and Coulomb
/// friction, 1996; Anitescu and Potra, Formulating dynamic multi-rigid-body contact problems with
/// friction as solvable linear complementarity problems, 1997). For n contacts, m of which have
/// mu > 0:
///
///     z = [f (n), beta (k m), lambda (m)]
///
///         | A_nn   A_nt   0 |        | d'* + allowance |    d'+ + allowance
///     M = | A_tn   A_tt   E |    q = | D u_t*          |    D u_t+ + E lambda
///         | S mu  -S E^T  0 |        | 0               |    S (mu f - E^T beta)
///
/// beta_ij is the impulse along direction j of contact i, t1 cos(2 pi j/k) + t2 sin(2 pi j/k),
/// D u_t the slip along it (friction_frame()); u* the velocities without contact impulses. A is
/// over normals and directions. f and beta are in N s, lambda (the slip speed) and all of w in m/s:
/// for that the last rows carry S = diag(A_nn) (Stewart and Trinkle: 1), so that the certificate's
/// unit-free residual judges every row, whatever the masses are. With S = 1 M is copositive, z^T M
/// z = |J^T (f, beta)|^2_W + lambda^T mu f; S scales rows and changes no solution. Frictionless z =
/// f, and M is left factored, symmetric, semidefinite. Rows of joints (joint_rows.h) follow after
/// all these, in A beside the normals: a mixed problem with their bounds.
struct PyramidProblem {
  lcp::Problem problem;
  std::vector<int> frictional;       ///< the m contacts with mu > 0, ascending
  std::vector<TangentFrame> frames;  ///< of those
  int sides = 0;                     ///< k
  int columns = 0;                   ///< of J
};

/// Assembles the problem. Cost: O(n + the sum over the bodies of (k m on the body)^2).
/// @param free_state positions of the step's start, momenta without contact impulses
/// @param allowance one a contact, m/s: how fast the gap may close (gap/h), or, negative, how fast
/// it must open
/// @param sides k, even, >= 4
/// @param joints rows with these bodies' numbers
/// @param columns as start_rows()
/// @throws std::invalid_argument if neither body of a contact is dynamic, an allowance is missing,
/// or `sides` is odd or less than 4; out is then untouched.
void assemble_pyramid(const Bodies& bodies, const State& free_state, const ContactSet& contacts,
                      const lcp::VectorRef& allowance, int sides, PyramidProblem& out,
                      std::span<const JointRow> joints = {},
                      BodyColumns columns = BodyColumns::kSix);

/// The impulse of every contact on its body A, world axes, N s: f N + sum_j beta_j t_j.
void contact_impulses(const PyramidProblem& pyramid, const ContactSet& contacts,
                      const lcp::VectorRef& z, std::vector<Vec3>& impulses);
[[nodiscard]] std::vector<Vec3> contact_impulses(const PyramidProblem& pyramid,
                                                 const ContactSet& contacts,
                                                 const lcp::VectorRef& z);

}  // namespace signorini
