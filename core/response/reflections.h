#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/response/friction_cones.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <string>

namespace signorini {

/// How a sequence of reflections ended.
struct ReflectionOutcome {
  /// kSolved: no contact approaches. kIterationLimit: `most` reflections were not enough.
  /// kInfeasible, kNoSolutionBelow: the contacts leave no room, the sequence need not end.
  /// Otherwise the ending of the reflection's problem that was not solved.
  lcp::Status status = lcp::Status::kNotRun;
  lcp::Vector z;        ///< the sum of the reflections, in the rows of ConeProblem, N s
  int reflections = 0;  ///< how many
  int reduced = 0;      ///< of them by theta < 1 (friction alone)
  lcp::Result worst;    ///< the reflection's problem that ended worst
};

/// A sequence that is longer than this is asked whether it can end.
inline constexpr int kReflectionsAtEase = 100;

/// Generalized reflections (Smith, Kaufman, Vouga, Tamstorf, Grinspun, Reflections on Simultaneous
/// Impact, ACM Transactions on Graphics 31(4), 2012): while contacts approach, let V be those and
/// reflect the velocity in them all at once,
///
///     0 <= l ⊥ A_VV l + d'_V >= 0,    f_V += 2 l,    d' += 2 A l.
///
/// A reflection changes the kinetic energy by 2 l.(A_VV l + d'_V) = 0, respects every symmetry of
/// the scene and pushes only. Contacts outside V are free to leave: a touching row of balls breaks
/// up. V is always feasible where what touches is free or at rest and cannot move: turning all
/// velocities round opens it.
///
/// Without friction the sequence ends after finitely many reflections unless the contacts leave no
/// room: some pushes y >= 0 cancel, J^T y = 0, as between two opposite walls (Vouga, Smith,
/// Kaufman, Tamstorf, Grinspun, All's Well That Ends Well: Guaranteed Resolution of Simultaneous
/// Rigid Body Impact, ACM Transactions on Graphics 36(4), 2017). That is asked once, after
/// kReflectionsAtEase reflections, of the LCP 0 <= f ⊥ A f - 1 >= 0, which is infeasible exactly
/// then; the outcome's status says so. Their number has no bound in the number of contacts alone: a
/// light ball between a wall and a heavy one needs about pi/2 sqrt(mass ratio). Hence the cap.
///
/// With friction (not in the source) the reflection's wish is 0 <= f ⊥ A f + 2 d'_V >= 0 with
/// Coulomb's cones, which plain sticking friction does not reflect; where it would gain energy it
/// is drawn towards the plastic Coulomb solution on V, f_c + theta (f - f_c) with the largest theta
/// that gains none. Each reflection stays in the cones, hence the sum does. That the sequence ends
/// is then not proved.
///
/// @param contacts one connected set, valid. Their restitution plays no part: e = 1
/// @param cones of these contacts with zero allowance; its q is u-
/// @param tolerance a contact approaches where d' < -velocity_allowed()
/// @param solver takes factored LCPs, or cones where there is friction
[[nodiscard]] ReflectionOutcome generalized_reflections(const Bodies& bodies, const State& before,
                                                        const ContactSet& contacts,
                                                        const ConeProblem& cones, double tolerance,
                                                        int most, lcp::Solver& solver);

/// The one restitution of a connected set, for laws that have no other: sum w_i e_i / sum w_i, w_i
/// = f_i |d_i'-| over the colliding contacts (d_i'- < -threshold) with f >= 0 the impulses of the
/// elastic law. 0 if no contact collides. A common e is that e exactly.
[[nodiscard]] double common_restitution(const ContactSet& contacts, const lcp::VectorRef& d_dot,
                                        const lcp::VectorRef& f, double threshold);

/// How far z and A z + q may miss their bounds, m/s: max(tolerance, 4 floors) |q|_inf, tangents
/// included, the floor that of lcp::Certificate.
[[nodiscard]] double velocity_allowed(const ConeProblem& cones, const lcp::VectorRef& z,
                                      double tolerance);

}  // namespace signorini
