#include "bench/scene_player.h"

#include <signorini/collision/collision_world.h>

#include <algorithm>

namespace signorini::bench {
namespace {

class OurPlayer final : public ScenePlayer {
 public:
  OurPlayer(const SteppedScene& scene, const TimeStepSettings& settings)
      : world_(scene.bodies, scene.colliders, PairingRule::kMinimum),
        stepper_(scene.bodies, world_, with_step(settings, scene.step)),
        state_(scene.state) {}

  void step() override {
    stepper_.step(state_, report_);
    unsolved_ += lcp::is_solved(report_.status) ? 0 : 1;
    for (const IslandReport& island : report_.islands) {
      worst_ = std::max(worst_, island.unit_free_residual);
    }
  }
  [[nodiscard]] State poses() const override { return state_; }
  [[nodiscard]] double worst_residual() const override { return worst_; }
  [[nodiscard]] int unsolved_steps() const override { return unsolved_; }

 private:
  static TimeStepSettings with_step(TimeStepSettings settings, double step) {
    settings.step = step;
    return settings;
  }

  collision::CollisionWorld world_;
  TimeStepper stepper_;
  State state_;
  StepReport report_;
  double worst_ = 0.0;
  int unsolved_ = 0;
};

}  // namespace

Contestant our_stepper(const std::string& name, const TimeStepSettings& settings) {
  return {name, [settings](const SteppedScene& scene) {
            return std::make_unique<OurPlayer>(scene, settings);
          }};
}

}  // namespace signorini::bench
