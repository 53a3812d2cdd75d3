#pragma once

#include <signorini/core/model/unconstrained_motion.h>

#include <vector>

namespace signorini {

/// How a torque-free run is made.
struct DriftSettings {
  OrientationScheme scheme = OrientationScheme::kQuaternion;
  Integrator integrator = Integrator::kSemiImplicit;
  double step = 1.0 / 240.0;  ///< h, s, finite and > 0
  int steps = 240;            ///< >= 0
  /// kRotationMatrix: Gram-Schmidt after every so many steps, >= 1; 0: never, which shows the drift
  /// that it removes. kQuaternion normalises after every step and does not look at this.
  int gram_schmidt_period = 0;

  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// The state of a torque-free run after a step.
struct DriftSample {
  double time = 0.0;                 ///< s
  double orthogonality_error = 0.0;  ///< max |R^T R - I|, dimensionless
  double energy_error = 0.0;         ///< (T - T_0) / T_0, dimensionless; 0 for a body at rest
  double momentum_error = 0.0;       ///< |L - L_0|, kg m^2/s
};

/// The drift of an orientation scheme: torque-free motion from `start`, sampled at t = 0 and after
/// every step (steps + 1 samples, all from the one run). Angular momentum is kept to the bit by
/// both integrators; energy and orthogonality are not.
/// @throws std::invalid_argument for a bad body, start or settings.
[[nodiscard]] std::vector<DriftSample> orientation_drift(const Body& body, const BodyState& start,
                                                         const DriftSettings& settings);

}  // namespace signorini
