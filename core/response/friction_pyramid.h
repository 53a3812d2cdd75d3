#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/lcp/problem.h>

#include <vector>

namespace signorini {

/// Two unit tangents of a contact: t1, t2, N are perpendicular to each other, t2 = N x t1.
struct TangentFrame {
  Vec3 t1 = Vec3::UnitX();
  Vec3 t2 = Vec3::UnitY();
};

/// Slower slip than this does not align the frame, m/s.
inline constexpr double kAligningSlip = 1e-9;

/// The frame of a contact's friction pyramid. t1 points along the slip where the slip is at least
/// kAligningSlip, so that a sliding point is braked by exactly mu f_n against its slip, and a point
/// about to slip is held by all of mu f_n, whatever the number of sides; elsewhere t1 is fixed by N
/// alone (Eigen's unitOrthogonal).
/// @param normal N, unit. @param slip any vector; its tangential part counts, m/s
[[nodiscard]] TangentFrame tangent_frame(const Vec3& normal, const Vec3& slip);

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
/// D u_t the slip along it; u* the velocities without contact impulses. A is over normals and
/// directions. f and beta are in N s, lambda (the slip speed) and all of w in m/s: to that end the
/// last rows carry S = diag(A_nn) (Stewart and Trinkle: 1), so that the certificate's unit-free
/// residual judges every row, whatever the masses are. With S = 1 M is copositive, z^T M z =
/// |J^T (f, beta)|^2_W + lambda^T mu f; S scales rows and changes no solution. Without friction z =
/// f and M is left factored, symmetric positive semidefinite.
struct PyramidProblem {
  lcp::Problem problem;
  std::vector<int> frictional;       ///< the m contacts with mu > 0, ascending
  std::vector<TangentFrame> frames;  ///< of those
  int sides = 0;                     ///< k
};

/// Assembles the problem. Cost: O(n + the sum over the bodies of (k m on the body)^2).
/// @param free_state positions of the step's start, momenta without contact impulses
/// @param allowance one a contact, m/s: how fast the gap may close (gap/h), or, negative, how fast
/// it must open
/// @param sides k, even, >= 4
/// @throws std::invalid_argument if neither body of a contact is dynamic, an allowance is missing,
/// or `sides` is odd or less than 4; out is then untouched.
void assemble_pyramid(const Bodies& bodies, const State& free_state, const ContactSet& contacts,
                      const lcp::VectorRef& allowance, int sides, PyramidProblem& out);

/// The impulse of every contact on its body A, world axes, N s: f N + sum_j beta_j t_j.
[[nodiscard]] std::vector<Vec3> contact_impulses(const PyramidProblem& pyramid,
                                                 const ContactSet& contacts,
                                                 const lcp::VectorRef& z);

/// The point at which friction acts on both bodies, so that it has no moment on the pair:
/// (P_A + P_B)/2.
[[nodiscard]] Vec3 friction_point(const Contact& contact);

/// Gives every contact's impulse to its dynamic bodies, at friction_point().
void apply_contact_impulses(const Bodies& bodies, const ContactSet& contacts,
                            const std::vector<Vec3>& impulses, State& state);

}  // namespace signorini
