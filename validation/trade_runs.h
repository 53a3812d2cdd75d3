#pragma once

#include <signorini/validation/report.h>
#include <signorini/validation/scene_run.h>

#include <functional>
#include <string>

namespace signorini::validation {

/// Fills the report of a scene: runs it in the engines of the options and judges it.
using SceneCheck = std::function<void(const Scene&, const RunOptions&, SceneReport&)>;

/// A way to run a scene.
struct TradeWay {
  std::string solver;  ///< as TradePoint::solver
  std::string engine;  ///< "signorini" or "bullet"
  double step = 0.0;   ///< s
  RunOptions options;  ///< of that engine alone, without studies
};

/// What else there is to say of a run.
struct RunFacts {
  double unsolved_steps = 0.0;  ///< of ours: steps whose contact problem was not solved
  bool broke_down = false;      ///< a number was no longer finite: the error is NaN
};

/// Runs the scene that way once: the point's times become this run's where it took less, its error
/// that of the check which the scene names; NaN: there was none.
/// @param trade its unit and reference, taken from the check @throws RunInterrupted
RunFacts run_way(const Scene& scene, const TradeWay& way, const SceneCheck& check,
                 TradePoint& point, Trade& trade);

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
