#pragma once

#include <signorini/validation/scene.h>
#include <signorini/validation/trade_runs.h>

#include "tools/byte_archive.h"

#include <limits>
#include <string>
#include <vector>

namespace signorini::bench {

/// A scene of the trade: what happens, who judges it, and what one error stands for it.
struct TradeScene {
  validation::Scene scene;
  validation::SceneCheck check;
};

/// The built-in scenes of validation/ that name an error and a kind; and, larger ones, stacks,
/// pyramids and a heavy box on a light one (stack_scenes.h), whose error is the greatest motion of
/// a body that should rest (closed form: none), of 1 m.
/// @param part only scenes whose names contain this; empty: all
[[nodiscard]] std::vector<TradeScene> trade_scenes(const std::string& part = {});
/// One of them, without reading the others. @throws std::invalid_argument for another name
[[nodiscard]] TradeScene trade_scene(const std::string& name);

/// An engine at a position of its dial.
struct SceneSetting {
  std::string name;      ///< "game", "Bullet SI50", "Bullet float SI50"
  std::string library;   ///< "Signorini", "Bullet", "Bullet float"
  std::string position;  ///< ours: of the accuracy dial
  std::string profile;   ///< Bullet's: "neutral" or "default" (bullet_profile.h)
  int iterations = 0;    ///< of Bullet's sequential impulses
};

/// preview, game, engineering, reference; Bullet with 10, 50, 200 and 1000 iterations under the
/// neutral profile and with its defaults; the same of Bullet in single precision.
[[nodiscard]] std::vector<SceneSetting> scene_settings();

/// What a run came to.
struct SceneOutcome {
  /// Of the scene's error, over the size that is wholly wrong; NaN: the run gave none.
  double error = std::numeric_limits<double>::quiet_NaN();
  double whole_seconds = -1.0;   ///< of all steps, for one simulated second; -1: no answer
  double solver_seconds = -1.0;  ///< of that inside the solver; -1: not measured
  double unsolved_steps = 0.0;   ///< ours: steps whose contact problem was not solved
  std::string said = {};         ///< why there is no answer
};
void visit_fields(auto& archive, tools::Reflects<SceneOutcome> auto& outcome) {
  archive(outcome.error, outcome.whole_seconds, outcome.solver_seconds, outcome.unsolved_steps,
          outcome.said);
}

/// Runs the scene at its step over `divisor`. The answer is judged first; where it is one (an error
/// below the scale) and took less than 50 ms, it is run again up to twice and the shortest time
/// counts. @throws std::runtime_error if it errs otherwise when it is run again
[[nodiscard]] SceneOutcome run_trade_scene(const TradeScene& trade, const SceneSetting& setting,
                                           int divisor);

}  // namespace signorini::bench
