#pragma once

#include <signorini/validation/report.h>
#include <signorini/validation/scene_run.h>

#include <span>
#include <string>
#include <string_view>

namespace signorini::validation {

/// A scene of this repository: a file in validation/scenes and the checks that know its closed
/// form.
struct BuiltinScene {
  std::string_view name;  ///< of the file, without .sdf
  void (*check)(const Scene& scene, const RunOptions& options, SceneReport& report);
};

/// All of them, in the order of the report.
[[nodiscard]] std::span<const BuiltinScene> builtin_scenes();
/// Null if there is none of that name.
[[nodiscard]] const BuiltinScene* find_builtin_scene(std::string_view name);
/// The scene as its file says. @throws InputError if the file is wrong, which a test excludes.
[[nodiscard]] Scene load_builtin_scene(const BuiltinScene& builtin);

/// Runs a built-in scene and fills its report. @throws RunInterrupted
[[nodiscard]] SceneReport validate_builtin(const BuiltinScene& builtin, const RunOptions& options);
/// The same, of a scene that was read from elsewhere: what its checks know is in its bodies.
[[nodiscard]] SceneReport validate_builtin(const BuiltinScene& builtin, Scene scene,
                                           const RunOptions& options);
/// Runs a scene from outside under the generic checks. A run that is stopped is kept as far as it
/// came, with a notice.
[[nodiscard]] SceneReport validate_scene(Scene scene, const RunOptions& options);

// The checks, one scene family a file in validation/scenes/. Each documents its closed forms.
void check_free_flight(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_torque_free_spin(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_ball_drop(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_wedge(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_flat_landing(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_slope(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_stack(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_mass_ratio(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_pendulum(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_load_on_a_chain(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_newtons_cradle(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_ball_between_walls(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_rod_on_supports(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_rolling(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_headings(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_resting_shapes(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_landing_shapes(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_tipping(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_dominoes(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_dzhanibekov(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_elastic_grid(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_ball_columns(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_masonry_stands(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_masonry_falls(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_wrecking_ball(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_gears(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_vehicle(const Scene& scene, const RunOptions& options, SceneReport& report);
void check_painleve_rod(const Scene& scene, const RunOptions& options, SceneReport& report);

}  // namespace signorini::validation
