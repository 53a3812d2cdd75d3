#pragma once

#include <signorini/validation/report.h>
#include <signorini/validation/scene_run.h>

#include <functional>

namespace signorini::validation {

/// Fills the report of a scene: runs it in the engines of the options and judges it.
using SceneCheck = std::function<void(const Scene&, const RunOptions&, SceneReport&)>;

/// Runs the scene once for each way there is (Signorini and Bullet at the scene's step and at a
/// quarter of it, Bullet in both profiles) and takes the error of the check that the scene names
/// (Scene::error) from each. A run that takes less than 50 ms is repeated twice and the shortest
/// time counts.
/// @param report of the scene: its trade, and a notice if no run had a check of that name (a
///   duration that is too short for it)
/// @throws RunInterrupted
void measure_trade(const Scene& scene, const RunOptions& options, const SceneCheck& check,
                   SceneReport& report);

}  // namespace signorini::validation
