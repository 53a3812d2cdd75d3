#include "bench/scene_trade.h"

#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>

#include "bench/stack_scenes.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace signorini::bench {
namespace {

using validation::Scene;

constexpr const char* kMotion = "greatest motion of a body";
constexpr double kShort = 0.05;  // s; shorter runs are repeated
constexpr int kMostRuns = 3;

/// Nothing moves.
void check_rest(const Scene& scene, const validation::RunOptions& options,
                validation::SceneReport& report) {
  const validation::Runs runs = validation::run_engines(scene, options, report);
  runs.for_each([&](const validation::Track& track) {
    double most = 0.0;
    for (const auto& sample : track.bodies) {
      for (std::size_t body = 0; body < sample.size(); ++body) {
        const Vec3 moved = sample[body].pose.position - track.bodies[0][body].pose.position;
        most = std::max(most, moved.norm());
      }
    }
    report.checks.push_back(validation::shown(
        {.name = kMotion, .engine = track.engine, .unit = "m", .reason = "it rests"}, most, 0.0));
  });
}

std::vector<SteppedScene> larger_scenes() {
  constexpr double kStep = 1.0 / 60.0;
  return {stack_scene(20, kStep, 1.0),   stack_scene(100, kStep, 1.0),
          pyramid_scene(10, kStep, 1.0), pyramid_scene(20, kStep, 1.0),
          pyramid_scene(44, kStep, 1.0), heavy_scene(1e6, kStep, 1.0),
          heavy_scene(1e9, kStep, 1.0)};
}

TradeScene resting(const SteppedScene& stepped) {
  Scene scene;
  scene.name = stepped.name;
  scene.bodies = stepped.bodies;
  scene.state = stepped.state;
  scene.colliders = stepped.colliders;
  scene.gravity = stepped.gravity;
  scene.step = stepped.step;
  scene.duration = stepped.seconds;
  scene.kind = "stands";
  scene.error = kMotion;
  return {std::move(scene), check_rest};
}

validation::TradeWay way_of(const Scene& scene, const SceneSetting& setting, int divisor) {
  validation::TradeWay way;
  way.solver = setting.name;
  way.step = scene.step / divisor;
  way.options.studies = false;
  way.options.signorini = !setting.position.empty();
  way.options.bullet = setting.position.empty();
  way.engine = way.options.signorini ? "signorini" : "bullet";
  if (way.options.signorini) {
    way.options.accuracy = Accuracy::named(setting.position);
  } else {
    way.options.profile = validation::BulletProfile::named(setting.profile);
    way.options.profile.iterations = setting.iterations;
  }
  return way;
}

}  // namespace

std::vector<TradeScene> trade_scenes(const std::string& part) {
  std::vector<TradeScene> all;
  for (const validation::BuiltinScene& builtin : validation::builtin_scenes()) {
    if (builtin.name.find(part) == std::string_view::npos) {
      continue;
    }
    Scene scene = validation::load_builtin_scene(builtin);
    if (!scene.error.empty() && !scene.kind.empty()) {
      all.push_back({std::move(scene), builtin.check});
    }
  }
  for (const SteppedScene& stepped : larger_scenes()) {
    if (stepped.name.find(part) != std::string::npos) {
      all.push_back(resting(stepped));
    }
  }
  return all;
}

TradeScene trade_scene(const std::string& name) {
  if (const validation::BuiltinScene* builtin = validation::find_builtin_scene(name)) {
    return {validation::load_builtin_scene(*builtin), builtin->check};
  }
  for (const SteppedScene& stepped : larger_scenes()) {
    if (stepped.name == name) {
      return resting(stepped);
    }
  }
  throw std::invalid_argument("trade: no scene is called " + name);
}

std::vector<SceneSetting> scene_settings() {
  std::vector<SceneSetting> all;
  for (const char* position : {"preview", "game", "engineering", "reference"}) {
    all.push_back({.name = position, .library = "Signorini", .position = position, .profile = {}});
  }
  for (const char* library : {"Bullet", "Bullet float"}) {
    const auto add = [&](const std::string& name, const char* profile, int iterations) {
      all.push_back({.name = fmt::format("{} {}", library, name),
                     .library = library,
                     .position = {},
                     .profile = profile,
                     .iterations = iterations});
    };
    add("defaults", "default", validation::BulletProfile::bullet_default().iterations);
    for (const int iterations : {10, 50, 200, 1000}) {
      add(fmt::format("SI{}", iterations), "neutral", iterations);
    }
  }
  return all;
}

SceneOutcome run_trade_scene(const TradeScene& trade, const SceneSetting& setting, int divisor) {
  const Scene& scene = trade.scene;
  const validation::TradeWay way = way_of(scene, setting, divisor);
  validation::Trade judged;
  judged.error = scene.error;
  validation::TradePoint first;
  first.error = std::numeric_limits<double>::quiet_NaN();
  const validation::RunFacts facts = validation::run_way(scene, way, trade.check, first, judged);
  SceneOutcome outcome;
  outcome.error = first.error / scene.error_scale;
  outcome.unsolved_steps = facts.unsolved_steps;
  if (facts.broke_down) {
    outcome.said = "a number was no longer finite";
    return outcome;
  }
  double whole = first.whole_seconds;
  double solver = first.solver_seconds;
  for (int runs = 1; runs < kMostRuns && outcome.error < 1.0 && whole < kShort; ++runs) {
    validation::TradePoint again;
    (void)validation::run_way(scene, way, trade.check, again, judged);
    if (again.error != first.error) {
      throw std::runtime_error(
          fmt::format("errs by {:.17g}, run again by {:.17g}", first.error, again.error));
    }
    whole = std::min(whole, again.whole_seconds);
    solver = std::min(solver, again.solver_seconds);
  }
  outcome.whole_seconds = whole / scene.duration;
  outcome.solver_seconds = solver < 0.0 ? solver : solver / scene.duration;
  return outcome;
}

}  // namespace signorini::bench
