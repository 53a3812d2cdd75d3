#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/response/contact_acceleration.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <limits>
#include <string>
#include <vector>

namespace signorini {

/// How resting forces are solved for.
struct RestingSettings {
  /// The LCP solver, a name that lcp::make_solver() knows, and what it is told.
  std::string solver = "lemke";
  lcp::SolverSettings lcp = {.tolerance = 1e-12};
  /// Of coulomb_forces() where contacts may stick: a name that lcp::make_solver() knows, that takes
  /// cones over a nonsymmetric matrix.
  std::string friction_solver = "auto";
  lcp::SolverSettings friction_lcp = {.tolerance = 1e-10};  ///< of friction_solver
  /// Against drift of a run: b_i + 2 d_i'/T + d_i/T^2 in the place of b_i, T this time (Baumgarte,
  /// Computer Methods in Applied Mechanics and Engineering 1, 1972, critically damped); infinite:
  /// off. s, > 0.
  double stabilization_time = std::numeric_limits<double>::infinity();
  /// Of coulomb_forces(): u' + u_T/T in the place of u', T this time, so that what sticks loses the
  /// slip that rounding and the length of segments left it; infinite: off. s, > 0.
  double slip_time = std::numeric_limits<double>::infinity();

  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// Resting forces: 0 <= g ⊥ A g + b >= 0 with b = d'' at g = 0 (notes, section 5; design, 4.7).
struct RestingReport {
  lcp::Status status = lcp::Status::kNotRun;
  lcp::Vector forces;  ///< g, N, one a contact; not solved: the best iterate
  lcp::Vector b;       ///< d'' without contact forces, stabilization included, m/s^2
  lcp::Vector d_ddot;  ///< A g + b, m/s^2
  /// How many of the forces at contacts that stay closed are statically indeterminate: the
  /// dimension of the changes of g that change no force and no torque on any body.
  int redundancy = 0;
  /// Solved where redundancy > 0: g is then the solution of least norm, and does not depend on the
  /// order of the contacts. Where this is not solved g is one solution of many.
  lcp::Status least_norm_status = lcp::Status::kNotRun;
  /// z is the LCP's answer before the choice of least norm; the certificate is of `forces`.
  lcp::Result result;
  /// Contacts whose features do not determine how N turns (GapKinematics::degenerate): their b is
  /// what the features do say. Named in detail.
  std::vector<int> degenerate_contacts;
  std::string detail;  ///< one line: what was done beyond the LCP
};

/// The resting forces of the contacts given (the caller picks those that touch and rest).
///
/// b_i = N.(a_A - a_B) + the curvature terms of gap_kinematics(), with the material accelerations
/// a = v' + w' x r + w x (w x r), v' = F/m, w' = J^-1 (tau - w x J w).
///
/// d'' = A g + b is unique, g is not where supports are redundant (a box on four corners): then the
/// g of least norm |g| is given (least_norm.h).
/// @param loads one a body: everything but contact forces, gravity included; only those of dynamic
/// bodies count
/// @param driven_acceleration of kinematic bodies: v' in m/s^2 (force) and w' in rad/s^2 (torque)
/// in the same struct, one a body; empty: they move uniformly
/// @throws std::invalid_argument for bad bodies, states, contacts, loads or settings; report is
/// then unchanged.
void resting_forces(const Bodies& bodies, const State& state, const ContactSet& contacts,
                    const std::vector<Wrench>& loads,
                    const std::vector<Wrench>& driven_acceleration, const RestingSettings& settings,
                    RestingReport& report);

}  // namespace signorini
