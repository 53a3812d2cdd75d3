#pragma once

#include "bench/scene_player.h"
#include "tools/limit_analysis.h"

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

/// A structure that stands by friction, for any mu.
using Masonry = std::function<SteppedScene(double friction)>;

struct LimitOptions {
  double seconds = 60.0;     ///< how long each run lasts at most
  double most_drift = 1e-3;  ///< m: of every body of what stands
  double fallen = 0.1;       ///< m: what moved so far fell, and its run ends
};

/// A structure at one mu.
struct LimitRow {
  std::string scene;
  int bodies = 0;
  int contacts = 0;         ///< at the start
  double critical = 0.0;    ///< mu_c by limit analysis
  double factor = 0.0;      ///< mu/mu_c
  double seconds = 0.0;     ///< simulated: until it fell, or all
  double drift = 0.0;       ///< the largest way of a body from its start, m
  int unsolved = 0;         ///< steps
  double milliseconds = 0;  ///< mean CPU time of a step

  /// Above mu_c it must stand, below it must fall.
  [[nodiscard]] bool as_it_should(const LimitOptions& options) const;
};

struct LimitReport {
  std::vector<LimitRow> rows;
  bool passed = true;  ///< all as they should, every step solved
  [[nodiscard]] std::string to_csv() const;
};

/// The card house of 5 floors and the arch of 15 stones, step 1/60 s.
[[nodiscard]] std::vector<Masonry> masonry_scenes();

/// mu_c of a scene (whose own friction does not count).
[[nodiscard]] LimitAnalysis critical_friction(const SteppedScene& scene);

/// Each structure at 1.05 mu_c, where it must stand, and at 0.9 mu_c, where it must fall.
[[nodiscard]] LimitReport run_limit_study(const LimitOptions& options,
                                          const std::vector<Masonry>& structures,
                                          const Contestant& contestant, std::ostream& out);

}  // namespace signorini::bench
