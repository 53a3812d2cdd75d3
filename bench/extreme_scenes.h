#pragma once

#include "bench/stack_scenes.h"

#include <functional>
#include <string>
#include <vector>

namespace signorini::bench {

/// A scene in which every dynamic body moves in the same way, without turning, by a closed form.
struct ExtremeScene {
  /// How far each dynamic body is from its start, and how fast it is.
  struct Motion {
    Vec3 shift = Vec3::Zero();     ///< m
    Vec3 velocity = Vec3::Zero();  ///< m/s
  };

  SteppedScene scene;
  int steps = 10;
  /// After k steps, k >= 1; of the scheme (velocity, then position) where that is not exact.
  std::function<Motion(int k)> motion;
  double length = 1.0;   ///< what errors of position count against: the bodies' size, m
  double speed = 1.0;    ///< and of velocity: sqrt(g length), or that of the impact if larger, m/s
  double impulse = 1.0;  ///< and of force: what gravity, or the impact, gives 1 kg a step, N s/kg
};

/// The worst of what a body, or the bodies from one up, are off by at step k: |x - x*| / length,
/// the angle from the start (rad), |v - v*| / speed, |w| length / speed, and, of the forces that
/// the contacts under it carry (in a stack: the weights above), |sum m (v - v*)| / (sum m impulse),
/// the sum over the bodies from it up.
[[nodiscard]] double scene_error(const ExtremeScene& extreme, int k, const State& poses,
                                 const std::vector<Velocity>& velocities);

/// One value of one axis, for one mass ratio.
struct ExtremeCell {
  std::string axis;
  double value = 0.0;
  double mass_ratio = 1.0;  ///< heaviest over lightest dynamic body
  /// Whether it says something about a model without friction; if so it is played with mu = 0.
  bool takes_no_friction = true;
  std::function<ExtremeScene(bool friction)> make;
};

/// The whole map, axis by axis, each by value and then by mass ratio (1, 1e4, 1e9, the heavy body
/// on top, but for the axes of the mass ratio itself).
[[nodiscard]] std::vector<ExtremeCell> extreme_cells();

}  // namespace signorini::bench
