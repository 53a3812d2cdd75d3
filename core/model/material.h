#pragma once

namespace signorini {

/// A surface.
struct Material {
  double friction = 0.0;     ///< Coulomb mu >= 0, dimensionless
  double restitution = 0.0;  ///< e in [0, 1], dimensionless
};

/// How the value of a pair follows from the values of its two surfaces. Bullet multiplies; others
/// take the minimum, the maximum or the mean.
enum class PairingRule : unsigned char { kMultiply, kMinimum, kMaximum, kMean };

/// @throws std::invalid_argument naming field, value and bound: friction finite and >= 0,
/// restitution in [0, 1].
void validate(const Material& material);

/// The pair's material: the rule applied to each value.
[[nodiscard]] Material pair(const Material& a, const Material& b, PairingRule rule);

}  // namespace signorini
