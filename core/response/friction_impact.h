#pragma once

#include <signorini/core/response/set_impact.h>

namespace signorini {

/// The impact of one connected set with Coulomb's friction (design, section 4.4). With rows N, t1,
/// t2 a contact (friction_cones.h) and u+ = A z + u-,
///
///     z_c: Coulomb's problem for q = u- (plastic),           z_c.u_c <= 0
///     z_e: the law's wish: kNewton, Coulomb's problem for q_N = (1 + e_i) d_i'- at colliding
///          contacts; kReflections, reflections.h for e = 1, then z_c + e (z_1 - z_c)
///     z = z_c + theta (z_e - z_c), the largest theta in [0, 1] that gains no energy.
///
/// The cones and u_N+ >= 0 are convex, so z meets both; Coulomb's direction of friction holds where
/// theta = 1 (kNewton) or theta = 0 alone. T+ - T- = 1/2 z.(u+ + u-), and for z_c it is
/// z_c.u_c - 1/2 z_c.A z_c <= 0. Existence of z_c is not proved in general: where its solver fails
/// the status says so.
/// @param contacts one connected set, valid. @param solver takes cones
/// @param after receives the new momenta of the set's bodies if the outcome is solved
[[nodiscard]] SetOutcome resolve_set_with_friction(const Bodies& bodies, const ContactSet& contacts,
                                                   const ImpactSettings& settings,
                                                   lcp::Solver& solver, const State& before,
                                                   State& after);

}  // namespace signorini
