#pragma once

#include <signorini/core/response/resting.h>

#include <string>
#include <vector>

namespace signorini {

/// How an impact without collision came out.
struct ShockReport {
  /// Solved: the impulses were applied. kStalled: the impulses vanish with the time in which they
  /// act, so that there is no impact (detail says so). Else the problem was not solved, or the
  /// impulses would have gained energy (kNumericalBreakdown).
  lcp::Status status = lcp::Status::kNotRun;
  std::vector<Vec3> contact_impulses;  ///< on A, world axes, N s, one a contact
  double energy_change = 0.0;          ///< T+ - T- - the work of driven bodies, J
  lcp::Result result;
  std::string detail;
};

/// The end of an inconsistent state: contacts that rest (d' = 0) while some slide, where no finite
/// forces exist (coulomb_forces.h). Then the impulses jump though nothing approaches (Painleve
/// 1905; Lecornu's "dynamic jamming"; Genot and Brogliato, "New results on Painleve paradoxes",
/// European Journal of Mechanics A 18, 1999): plastic Coulomb impulses z that do not vanish with
/// the time h,
///
///     Coulomb's problem for u+ = A z + u- + h b,   b = d'' without contact forces,  h -> 0,
///
/// which for a single contact end the slip: z = -A^-1 u-. h b here is 1e-8 of the fastest slip; it
/// tells them from z = 0, which also solves the problem for h = 0, and is not added to the
/// velocities. Of u- the d' are taken as 0, as the forces' problem does, whatever small opening
/// they were held with. A time step of length h does the same.
/// @param b one a contact, m/s^2
/// @param settings friction_solver and friction_lcp
/// @param state receives the new momenta where status is solved
/// @throws std::invalid_argument as assemble_cones(), and for b that is not finite or not one a
/// contact
[[nodiscard]] ShockReport impact_without_collision(const Bodies& bodies, const ContactSet& contacts,
                                                   const lcp::VectorRef& b,
                                                   const RestingSettings& settings, State& state);

}  // namespace signorini
