#include "bench/scene_player.h"

#include <signorini/collision/collision_world.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/event_stepper.h>
#include <signorini/core/response/set_impact.h>

#include <algorithm>
#include <limits>

namespace signorini::bench {
namespace {

class OurPlayer final : public ScenePlayer {
 public:
  OurPlayer(const SteppedScene& scene, const TimeStepSettings& settings)
      : world_(scene.bodies, scene.colliders, PairingRule::kMinimum),
        stepper_(scene.bodies, world_, of_scene(settings, scene)),
        state_(scene.state) {}

  void step() override {
    stepper_.step(state_, report_);
    unsolved_ += lcp::is_solved(report_.status) ? 0 : 1;
    status_ = worse(status_, report_.status);
    for (const IslandReport& island : report_.islands) {
      worst_ = std::max(worst_, island.unit_free_residual);
    }
  }
  [[nodiscard]] State poses() const override { return state_; }
  [[nodiscard]] double worst_residual() const override { return worst_; }
  [[nodiscard]] std::vector<Velocity> velocities() const override {
    return velocities_of(stepper_.bodies(), state_);
  }
  [[nodiscard]] int unsolved_steps() const override { return unsolved_; }
  [[nodiscard]] lcp::Status status() const override { return status_; }

 private:
  static TimeStepSettings of_scene(TimeStepSettings settings, const SteppedScene& scene) {
    settings.step = scene.step;
    settings.gravity = scene.gravity;
    settings.margin = scene.margin;
    settings.touching_tolerance = 1e-4 * scene.margin;
    return settings;
  }

  collision::CollisionWorld world_;
  TimeStepper stepper_;
  State state_;
  StepReport report_;
  double worst_ = 0.0;
  int unsolved_ = 0;
  lcp::Status status_ = lcp::Status::kSolved;
};

class EventPlayer final : public ScenePlayer {
 public:
  explicit EventPlayer(const SteppedScene& scene)
      : bodies_(scene.bodies),
        world_(scene.bodies, scene.colliders, PairingRule::kMinimum),
        stepper_(scene.bodies, world_, {.gravity = scene.gravity}),
        state_(scene.state),
        step_(scene.step) {}

  void step() override {
    stepper_.advance(state_, step_, report_);
    unsolved_ += lcp::is_solved(report_.status) ? 0 : 1;
    status_ = worse(status_, report_.status);
  }
  [[nodiscard]] State poses() const override { return state_; }
  [[nodiscard]] std::vector<Velocity> velocities() const override {
    return velocities_of(bodies_, state_);
  }
  [[nodiscard]] double worst_residual() const override {
    return std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] int unsolved_steps() const override { return unsolved_; }
  [[nodiscard]] lcp::Status status() const override { return status_; }

 private:
  Bodies bodies_;
  collision::CollisionWorld world_;
  EventStepper stepper_;
  State state_;
  EventReport report_;
  double step_;
  int unsolved_ = 0;
  lcp::Status status_ = lcp::Status::kSolved;
};

}  // namespace

Contestant our_event_stepper() {
  return {.name = "signorini, event-driven",
          .start = [](const SteppedScene& scene) { return std::make_unique<EventPlayer>(scene); },
          .is_event_driven = true};
}

Contestant our_stepper(const std::string& name, const TimeStepSettings& settings) {
  return {name, [settings](const SteppedScene& scene) {
            return std::make_unique<OurPlayer>(scene, settings);
          }};
}

}  // namespace signorini::bench
