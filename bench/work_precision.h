#pragma once

#include "bench/scene_player.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

struct WorkPrecisionOptions {
  /// Of each of our runs of what should stand; < 0: as long as it should. Scenes that name an error
  /// of their own run to their end.
  double seconds = -1.0;
  double bullet_seconds = 2.0;  ///< the same of Bullet's
  std::string scene;            ///< only scenes whose names contain this; empty: all
};

/// One engine on one scene.
struct WorkPrecisionRow {
  std::string scene;
  std::string name;
  bool is_ours = true;
  double seconds = 0.0;       ///< simulated
  double milliseconds = 0.0;  ///< median CPU time of a step, collision included; ours over all
                              ///< steps, Bullet's over the first second, while its stack stands
  std::string error_name;     ///< of what, and its unit
  double error = 0.0;         ///< SteppedScene::error, or the largest distance of the watched body
                              ///< from where it should be: its start, or SteppedScene::path; m
  double penetration = 0.0;   ///< deepest overlap at 20 looks, ours and Bullet's by our collision
                              ///< detection, m
  double residual = 0.0;      ///< worst unit-free residual of all steps; NaN: not known
  int unsolved = 0;           ///< steps with a contact problem that was not solved
};

struct WorkPrecisionReport {
  std::vector<WorkPrecisionRow> rows;
  /// No step of ours was unsolved.
  [[nodiscard]] bool passed() const;
  [[nodiscard]] std::string to_csv() const;
};

/// The scenes of the study: stacks, a pyramid, heavy on light, slopes, a ball that begins to roll;
/// with Clp the card house and the arch at 1.05 mu_c; flat landings, a touching cradle, bouncing
/// balls and 216 elastic ones.
[[nodiscard]] std::vector<SteppedScene> work_precision_scenes();

/// The dial's positions, the event-driven stepper and Bullet with 10, 50, 200 and 1000 iterations.
[[nodiscard]] std::vector<Contestant> work_precision_contestants();

/// Every contestant on every scene that it takes, one after the other.
[[nodiscard]] WorkPrecisionReport run_work_precision(const WorkPrecisionOptions& options,
                                                     const std::vector<SteppedScene>& scenes,
                                                     const std::vector<Contestant>& contestants,
                                                     std::ostream& out);

}  // namespace signorini::bench
