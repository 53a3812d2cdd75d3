#pragma once

#include <signorini/c/signorini.h>

#include "plain_problem.h"

#include <cstdint>
#include <limits>
#include <span>

namespace signorini::testing {

/// What signorini_contact_solver_solve() was told, and how its settings stand.
struct StatedContacts {
  std::span<const signorini_body> bodies;
  std::span<const signorini_contact> contacts;
  double step = 0.0;
  double tolerance = 1e-8;
  double touching_tolerance = 1e-6;
  double restitution_threshold = 0.0;
  signorini_friction_model friction_model = SIGNORINI_CONE;
  /// Of the dial, m/s; NaN: it is off.
  double residual = std::numeric_limits<double>::quiet_NaN();

  /// Aborts where the velocities do not follow from the impulses, a friction force is larger than
  /// its law allows, or what is called solved is not (an island at a time; of the pyramid and the
  /// box the normal rows alone). Looks at nothing that holds a number beyond 1e50 or, but for 0,
  /// below 1e-50.
  void judge(const signorini_contact_result* result) const;
};

}  // namespace signorini::testing
