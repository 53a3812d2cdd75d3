#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

struct BroadPhaseOptions {
  int bodies = 10000;  ///< > 0
  int steps = 60;      ///< > 0
  std::uint64_t seed = 1;
};

/// One broad phase on one crowd.
struct BroadPhaseRow {
  std::string crowd;   ///< where the boxes are
  std::string motion;  ///< creep: by 1/60 of a mean edge a step; jump: anywhere each step
  std::string name;
  double milliseconds = -1.0;  ///< median of a step: update and pairs, CPU time of the thread
  double pairs = -1.0;         ///< mean of a step, as it reports them (fat bounds: more)
  long missed = -1;            ///< overlapping pairs that it did not report, all steps
  long extra = -1;             ///< pairs beyond those that overlap, all steps
};

struct BroadPhaseReport {
  std::vector<BroadPhaseRow> rows;
  /// Ours missed nothing and reported nothing else.
  [[nodiscard]] bool passed() const;
  [[nodiscard]] std::string to_csv() const;
};

/// Moving boxes: ours, a plain sort and sweep, and the broad phases of the libraries of the build,
/// all on the same bounds, judged step by step against each other.
[[nodiscard]] BroadPhaseReport run_broad_phase_study(const BroadPhaseOptions& options,
                                                     std::ostream& out);

}  // namespace signorini::bench
