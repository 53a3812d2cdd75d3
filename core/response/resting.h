#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <string>
#include <vector>

namespace signorini {

/// Force and torque on a body, world axes: N, N m about the centre of mass.
struct Wrench {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
};

struct RestingSettings {
  std::string solver = "lemke";
  lcp::SolverSettings lcp = {.tolerance = 1e-12};
};

/// Resting forces: 0 <= g ⊥ A g + b >= 0 with b = d'' at g = 0 (notes, section 5; design, 4.7).
struct RestingReport {
  lcp::Status status = lcp::Status::kNotRun;
  lcp::Vector forces;  ///< g, N, one a contact
  lcp::Vector b;       ///< d'' without contact forces, m/s^2
  lcp::Vector d_ddot;  ///< A g + b, m/s^2
  lcp::Result result;
};

/// The resting forces of the contacts given (the caller picks those that touch and rest).
///
/// b_i = N.(a_A - a_B) + the curvature terms of gap_kinematics(), with the material accelerations
/// a = v' + w' x r + w x (w x r), v' = F/m, w' = J^-1 (tau - w x J w).
/// @param loads one a body: everything but contact forces, gravity included
/// @param driven_acceleration of kinematic bodies: v' (force) and w' (torque) in the same struct;
/// empty: they move uniformly
void resting_forces(const Bodies& bodies, const State& state, const ContactSet& contacts,
                    const std::vector<Wrench>& loads,
                    const std::vector<Wrench>& driven_acceleration, const RestingSettings& settings,
                    RestingReport& report);

/// F = m gravity_scale g for every dynamic body, no torque.
[[nodiscard]] std::vector<Wrench> gravity_loads(const Bodies& bodies, const Vec3& gravity);

}  // namespace signorini
