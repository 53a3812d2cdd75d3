#pragma once

#include <signorini/validation/report.h>
#include <signorini/validation/scene_run.h>

#include <span>
#include <string>
#include <string_view>

namespace signorini::validation {

/// A scene of Bullet's own examples (integrations/bullet/example_scenes), run by Bullet twice: with
/// its solver and with ours inside. In its report the engine "signorini" is Bullet with our solver.
struct DropInScene {
  std::string_view name;     ///< "drop-in-stack"
  std::string_view example;  ///< ExampleScene's name
  std::string_view title;
  double seconds;   ///< of the run
  bool must_stand;  ///< no body may move
};

/// All of them, in the order of the report.
[[nodiscard]] std::span<const DropInScene> drop_in_scenes();
/// Null if there is none of that name.
[[nodiscard]] const DropInScene* find_drop_in_scene(std::string_view name);

/// Runs the scene with the solvers chosen and fills its report. Bullet's defaults, double
/// precision, sleeping off; options.profile gives Bullet's iterations. @throws RunInterrupted
[[nodiscard]] SceneReport validate_drop_in(const DropInScene& scene, const RunOptions& options);

}  // namespace signorini::validation
