#pragma once

namespace signorini {

/// A surface.
struct Material {
  double friction = 0.0;     ///< Coulomb mu >= 0, dimensionless
  double restitution = 0.0;  ///< e in [0, 1], dimensionless
  /// mu across the friction direction over mu along it (Contact::friction_direction), > 0,
  /// dimensionless; 1: the same in every direction.
  double friction_ratio = 1.0;
  /// The torque against rolling is at most this times the normal force, >= 0, m.
  double rolling_friction = 0.0;
  double spinning_friction = 0.0;  ///< the same of the torque against spinning about the normal, m

  [[nodiscard]] bool resists_turning() const {
    return rolling_friction > 0.0 || spinning_friction > 0.0;
  }
};

/// How the value of a pair follows from the values of its two surfaces. Bullet multiplies; others
/// take the minimum, the maximum or the mean.
enum class PairingRule : unsigned char { kMultiply, kMinimum, kMaximum, kMean };

/// @throws std::invalid_argument naming field, value and bound: each friction finite and
/// >= 0, friction_ratio finite and > 0, restitution in [0, 1].
void validate(const Material& material);

/// The pair's material: the rule applied to friction along and across, and to restitution. Rolling
/// and spinning friction are lengths, which do not multiply: the larger one.
[[nodiscard]] Material pair(const Material& a, const Material& b, PairingRule rule);

}  // namespace signorini
