#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/embedded_scenes.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/sdf_reader.h>
#include <signorini/validation/trade_runs.h>

#include <algorithm>
#include <stdexcept>

namespace signorini::validation {
namespace {

constexpr BuiltinScene kScenes[] = {
    {"free-flight", check_free_flight},
    {"torque-free-spin", check_torque_free_spin},
    {"ball-drop-e0", check_ball_drop},
    {"ball-drop-e0.5", check_ball_drop},
    {"ball-drop-e0.9", check_ball_drop},
    {"ball-drop-e1", check_ball_drop},
    {"wedge", check_wedge},
    {"box-landing-flat", check_flat_landing},
    {"triangle-landing-flat", check_flat_landing},
    {"slope-stick", check_slope},
    {"slope-slide", check_slope},
    {"slope-stick-by-a-hair", check_slope},
    {"slope-slide-by-a-hair", check_slope},
    {"stack-of-5", check_stack},
    {"stack-of-100", check_stack},
    {"pyramid-of-20-rows", check_resting_shapes},
    {"pendulum", check_pendulum},
    {"load-on-a-chain", check_load_on_a_chain},
    {"newtons-cradle", check_newtons_cradle},
    {"ball-between-walls", check_ball_between_walls},
    {"ball-between-tilted-walls", check_ball_between_walls},
    {"rod-on-two-supports", check_rod_on_supports},
    {"mass-ratio-1000", check_mass_ratio},
    {"mass-ratio-million", check_mass_ratio},
    {"rolling-sphere", check_rolling},
    {"rolling-cylinder", check_rolling},
    {"rolling-capsule", check_rolling},
    {"slipping-capsule", check_rolling},
    {"thrown-cylinder", check_rolling},
    {"sliding-headings", check_headings},
    {"resting-shapes", check_resting_shapes},
    {"landing-shapes", check_landing_shapes},
    {"box-on-an-edge", check_tipping},
    {"dominoes", check_dominoes},
    {"dzhanibekov", check_dzhanibekov},
    {"elastic-666", check_elastic_grid},
    {"balls-666", check_ball_columns},
    {"card-house", check_resting_shapes},
    {"three-bricks", check_resting_shapes},
    {"arch", check_resting_shapes},
    {"card-house-of-5-floors", check_masonry_stands},
    {"card-house-falls", check_masonry_falls},
    {"arch-of-15-stones", check_masonry_stands},
    {"arch-falls", check_masonry_falls},
    {"wrecking-ball", check_wrecking_ball},
    {"gears-of-friction", check_gears},
    {"painleve-rod", check_painleve_rod},
    {"bullet-wall", check_resting_shapes},
    {"bullet-vehicle", check_vehicle},
    {"bullet-ragdoll", check_generic},
};

SceneReport start_report(const Scene& scene) {
  SceneReport report;
  report.name = scene.name;
  report.title = scene.title;
  report.description = scene.description;
  report.source = scene.source;
  report.text = scene.text;
  report.notices = scene.notices;
  return report;
}

/// Error against cost, if it is asked for. A stop leaves the scene as it is, without it.
void add_trade(const Scene& scene, const RunOptions& options, const SceneCheck& check,
               SceneReport& report) {
  if (!options.trade || scene.error.empty()) return;
  try {
    if (options.stop != nullptr && options.stop->load()) throw RunInterrupted{};
    measure_trade(scene, options, check, report);
  } catch (const RunInterrupted&) {
    report.notices.emplace_back("error against cost is not shown: the run was stopped");
  }
}

}  // namespace

std::span<const BuiltinScene> builtin_scenes() {
  return kScenes;
}

const BuiltinScene* find_builtin_scene(std::string_view name) {
  const auto found = std::find_if(std::begin(kScenes), std::end(kScenes),
                                  [name](const BuiltinScene& scene) { return scene.name == name; });
  return found == std::end(kScenes) ? nullptr : &*found;
}

Scene load_builtin_scene(const BuiltinScene& builtin) {
  for (const EmbeddedScene& embedded : embedded_scenes()) {
    if (embedded.name != builtin.name) continue;
    const std::string name(builtin.name);
    Scene scene = read_scene_text(std::string(embedded.text), "validation/scenes/" + name + ".sdf");
    scene.name = name;
    return scene;
  }
  throw std::logic_error("no scene file for " + std::string(builtin.name));
}

SceneReport validate_builtin(const BuiltinScene& builtin, const RunOptions& options) {
  return validate_builtin(builtin, load_builtin_scene(builtin), options);
}

SceneReport validate_builtin(const BuiltinScene& builtin, Scene scene, const RunOptions& options) {
  scene.duration = options.duration.value_or(scene.duration);
  SceneReport report = start_report(scene);
  report.builtin = true;
  builtin.check(scene, options, report);
  add_trade(scene, options, builtin.check, report);
  // What a scene is there to show comes before the checks that every scene has.
  std::stable_partition(report.checks.begin(), report.checks.end(), [](const Check& check) {
    return check.reference.starts_with("closed form");
  });
  return report;
}

SceneReport validate_scene(Scene scene, const RunOptions& options) {
  scene.duration = options.duration.value_or(scene.duration);
  SceneReport report = start_report(scene);
  // Its checks hold for a run of any length.
  RunOptions kept = options;
  kept.keep_stopped = true;
  check_generic(scene, kept, report);
  add_trade(scene, options, check_generic, report);
  return report;
}

}  // namespace signorini::validation
