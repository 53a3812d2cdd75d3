#pragma once

#include "bench/stack_scenes.h"

#include <span>
#include <string_view>

namespace signorini::bench {

/// The scenes of `scaling`, of any number of bodies. SI units, step 1/60 s, mu = 0.5, e = 0.
///
/// - stacks: towers of ten cubes of 1 m and 1 kg, 1.5 m apart: islands of one size, at rest
/// - pyramid: rows of such cubes in a plane, each on two of the row below (pyramid_scene()): one
///   island, at rest
/// - pile: balls and turned cubes of 0.45 to 0.5 m circumradius, thrown together five deep: islands
///   that come, grow and go; nothing rests
struct ScalingScene {
  SteppedScene scene;
  bool is_at_rest = true;  ///< every body should stay where it is
};

[[nodiscard]] std::span<const std::string_view> scaling_scene_names();

/// @param bodies >= 1, besides the ground; stacks of fewer than ten are one lower tower, and a
/// pyramid has the whole rows whose bodies are nearest
/// @throws std::invalid_argument for another name or number
[[nodiscard]] ScalingScene make_scaling_scene(std::string_view name, int bodies);

}  // namespace signorini::bench
