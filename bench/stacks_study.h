#pragma once

#include "bench/scene_player.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

struct StacksOptions {
  double seconds = -1.0;        ///< of each of our runs; < 0: as long as the scene should stand
  double bullet_seconds = 2.0;  ///< of each run of Bullet's
  std::string scene;            ///< only scenes whose names contain this; empty: all
};

/// One engine on one scene.
struct StacksRow {
  std::string scene;
  std::string name;
  bool is_ours = true;
  double seconds = 0.0;       ///< simulated
  double milliseconds = 0.0;  ///< median CPU time of a step, collision included; ours over all
                              ///< steps, Bullet's over the first second, while its stack stands
  double drift = 0.0;         ///< the largest distance of the watched body from where it should be:
                              ///< its start, or SteppedScene::path; m
  double penetration = 0.0;   ///< deepest overlap at 20 looks, ours and Bullet's by our collision
                              ///< detection, m
  double residual = 0.0;      ///< worst unit-free residual of all steps; NaN: not known
  int unsolved = 0;           ///< steps with a contact problem that was not solved
};

struct StacksReport {
  std::vector<StacksRow> rows;
  /// No step of ours was unsolved.
  [[nodiscard]] bool passed() const;
  [[nodiscard]] std::string to_csv() const;
};

/// The scenes of the study: stacks, a pyramid, heavy on light, slopes, a ball that begins to roll;
/// with Clp the card house and the arch at 1.05 mu_c.
[[nodiscard]] std::vector<SteppedScene> stacks_scenes();

/// Every contestant on every scene, one after the other.
[[nodiscard]] StacksReport run_stacks_study(const StacksOptions& options,
                                            const std::vector<SteppedScene>& scenes,
                                            const std::vector<Contestant>& contestants,
                                            std::ostream& out);

}  // namespace signorini::bench
