#pragma once

#include <signorini/core/response/resting.h>

#include <cstdint>
#include <string_view>

namespace signorini {

/// What a resting contact with friction does under its force.
enum class ContactMode : std::uint8_t {
  kOpens,   ///< d'' > 0: it is about to separate
  kCloses,  ///< d'' = 0, no friction
  kSticks,  ///< d'' = 0, and the bodies do not slip
  kSlides,  ///< d'' = 0, and they slip, or begin to
};
[[nodiscard]] std::string_view to_string(ContactMode mode);

/// Forces of resting contacts with Coulomb's friction, at the level of accelerations.
struct CoulombReport {
  /// Not solved: kInfeasible and kNoSolutionBelow are proofs that no such forces exist (below Z),
  /// an inconsistent state (Painleve, Comptes Rendus 121, 1895).
  lcp::Status status = lcp::Status::kNotRun;
  std::vector<Vec3> forces;        ///< on A, world axes, N, one a contact
  lcp::Vector normal_forces;       ///< f, N
  lcp::Vector b;                   ///< d'' without contact forces, stabilization included, m/s^2
  lcp::Vector d_ddot;              ///< d'' with them
  std::vector<ContactMode> modes;  ///< where solved; to 100 tolerances of the accelerations
  /// Where it slides the unit direction of the slip of A over B, or of the slip that begins; else
  /// zero.
  std::vector<Vec3> directions;
  lcp::Result result;
  std::vector<int> degenerate_contacts;  ///< as in RestingReport
};

/// Contacts that slide (slip u_T not zero) feel F = f (N - mu e), e along u_T; those that do not
/// may stick, or begin to slide against the slip acceleration:
///
///     0 <= f_i ⊥ d_i'' >= 0                           all contacts
///     |beta_i| <= mu_i f_i, beta_i = -mu_i f_i u_Ti'/|u_Ti'| where u_Ti' != 0     those that do
///     not
///
/// over d'', u' = A z + b with b as contact_acceleration() has it: one cone problem
/// (friction_cones.h has its rows), whose matrix is nonsymmetric as soon as a contact slides. An
/// anisotropic contact has its ellipse (friction_frame()). With u_T = 0 everywhere forces exist if
/// they do without friction; with sliding they need not, and need not be unique. Where supports are
/// redundant the forces are one solution of many.
/// @param slides one a contact: whether it slides; u_T is that of the state
/// @param loads, driven_acceleration see free_accelerations()
/// @param settings stabilization_time acts on d'', slip_time on u' of contacts that do not slide.
/// Without contacts that may stick the problem is an LCP, for settings.solver; else
/// it is for settings.friction_solver
/// @throws std::invalid_argument for bad bodies, states, contacts, loads or settings, and for
/// contacts that resist turning; report is then unchanged.
void coulomb_forces(const Bodies& bodies, const State& state, const ContactSet& contacts,
                    const std::vector<bool>& slides, const std::vector<Wrench>& loads,
                    const std::vector<Wrench>& driven_acceleration, const RestingSettings& settings,
                    CoulombReport& report);

}  // namespace signorini
