#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/response/time_stepper.h>

#include "bench/stack_scenes.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace signorini::bench {

/// An engine that plays a scene.
class ScenePlayer {
 public:
  virtual ~ScenePlayer() = default;
  /// One step of the scene's length, collision detection included.
  virtual void step() = 0;
  /// Positions and orientations now, one a body; momenta are left out.
  [[nodiscard]] virtual State poses() const = 0;
  /// Velocities now, one a body.
  [[nodiscard]] virtual std::vector<Velocity> velocities() const = 0;
  /// The worst unit-free residual of the contact problems so far, or NaN where the engine knows
  /// none.
  [[nodiscard]] virtual double worst_residual() const = 0;
  /// Steps of which a contact problem was not solved (engines that do not say: 0).
  [[nodiscard]] virtual int unsolved_steps() const = 0;
  /// Of the steps so far the first that is not solved, else solved to rounding if one is (engines
  /// that do not say: not run).
  [[nodiscard]] virtual lcp::Status status() const = 0;
};

struct Contestant {
  std::string name;
  std::function<std::unique_ptr<ScenePlayer>(const SteppedScene& scene)> start;
  bool is_ours = true;
  bool is_event_driven = false;  ///< for scenes of few contacts: those that name an error
};

/// Our time stepper with these settings but for the step.
[[nodiscard]] Contestant our_stepper(const std::string& name, const TimeStepSettings& settings);
/// Our event-driven stepper with its defaults: generalized reflections, energy-safe. It has no
/// step: a step is as much time, whatever happens in it.
[[nodiscard]] Contestant our_event_stepper();
/// Bullet in double precision: its defaults, sleeping off, with this many iterations of its
/// sequential impulses.
[[nodiscard]] Contestant bullet_stepper(int iterations);

}  // namespace signorini::bench
