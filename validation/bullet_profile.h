#pragma once

#include <string>
#include <vector>

namespace signorini::validation {

/// How Bullet integrates the gyroscopic torque w x J w.
enum class BulletGyroscopic : unsigned char { kNone, kExplicit, kImplicitBody, kImplicitWorld };

/// Every setting of Bullet that a run here chooses; printed whole in the report. What is not here
/// is Bullet's own default. The two profiles are the ones to name in a comparison.
struct BulletProfile {
  std::string name;
  int iterations = 50;  ///< of the sequential impulse solver, each step
  /// Contacts further apart than this take no part in the solve, m. Bullet's default, +infinity,
  /// solves contacts that are still apart and takes gap/step from their restitution.
  double contact_processing_threshold = 0.0;
  /// Overlap below this (m, negative: deeper) is pushed out apart from the velocity. Bullet's
  /// default, -0.04, pushes shallower overlap out through the velocity, which adds energy.
  double split_impulse_penetration_threshold = 0.0;
  double restitution_velocity_threshold = 0.0;  ///< m/s, slower contacts do not bounce
  double warm_starting_factor = 0.85;           ///< Bullet's default
  bool sleeping = false;
  BulletGyroscopic gyroscopic = BulletGyroscopic::kImplicitBody;
  /// A half-space is a box of this half edge with a face in the plane: Bullet's own plane shape
  /// gives a box on it one contact only. m
  double ground_half_edge = 1000.0;

  /// Settings under which Bullet's restitution is exact and no overlap adds energy.
  [[nodiscard]] static BulletProfile neutral();
  /// Bullet's defaults (10 iterations), sleeping off.
  [[nodiscard]] static BulletProfile bullet_default();
  /// "neutral" or "default". @throws std::invalid_argument listing them.
  [[nodiscard]] static BulletProfile named(const std::string& name);

  /// One line a group of settings.
  [[nodiscard]] std::vector<std::string> describe() const;
};

}  // namespace signorini::validation
