#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace signorini::bench {

/// What a run of a scene is counted by: the same for every run of one program on one machine. Of
/// all steps together, but for contacts, rows, islands and allocations, which are the last step's.
/// -1: not known (Bullet's).
struct ScalingCounts {
  long contacts = -1;
  long rows = -1;
  long islands = -1;
  long solves = -1;
  long iterations = -1;
  long pivots = -1;
  long factorizations = -1;
  long pairs_asked = -1;           ///< of the narrow phase
  long allocations = -1;           ///< of our own code
  long back_end_allocations = -1;  ///< of sparse back-ends (lcp/back_end.h)

  friend bool operator==(const ScalingCounts&, const ScalingCounts&) = default;
};

using ScalingCount = std::pair<std::string_view, long ScalingCounts::*>;
/// Their names, in the order of the file.
inline constexpr std::array<ScalingCount, 10> kScalingCounts = {{
    {"contacts", &ScalingCounts::contacts},
    {"rows", &ScalingCounts::rows},
    {"islands", &ScalingCounts::islands},
    {"solves", &ScalingCounts::solves},
    {"iterations", &ScalingCounts::iterations},
    {"pivots", &ScalingCounts::pivots},
    {"factorizations", &ScalingCounts::factorizations},
    {"pairs_asked", &ScalingCounts::pairs_asked},
    {"allocations", &ScalingCounts::allocations},
    {"back_end_allocations", &ScalingCounts::back_end_allocations},
}};

/// What it took. NaN: not known.
struct ScalingCosts {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double first_step = kUnknown;  ///< s, without a start, contacts found twice
  double step = kUnknown;        ///< s, median of the steps after it
  // Of one thread alone, s. What rests to the bit is not looked for again, so that collision
  // detection is that of the first step: all pairs are asked.
  double broad = kUnknown;   ///< CollisionWorld: bounds and pairs, the lesser of its two find()s
  double narrow = kUnknown;  ///< CollisionWorld: contacts of the pairs, likewise
  // The parts of one step after it: of those of at least median cost that with the least wall time
  // for its CPU time, since they are wall times and others have the processor too.
  double rows = kUnknown;           ///< assembly
  double solvers = kUnknown;        ///< problems solved and certified
  double move = kUnknown;           ///< integration
  double rest = kUnknown;           ///< islands, choice of contacts, impulses applied, projection
  double held_bytes = kUnknown;     ///< by the world and the stepper after the steps; one thread
  double peak_bytes = kUnknown;     ///< resident, on top of the program's; one thread
  double floor = kUnknown;          ///< s: factorization_floor.h, of all problems of the last step
  double touched_bytes = kUnknown;  ///< that a step must read or write at least once
  double bandwidth = kUnknown;      ///< bytes/s that this machine moves with as many threads
  double residual = kUnknown;       ///< worst of any island and step, m/s
  double error = kUnknown;  ///< m: how far a body that should rest has moved, else the deepest
                            ///< overlap at the end
};

using ScalingCost = std::pair<std::string_view, double ScalingCosts::*>;
inline constexpr std::array<ScalingCost, 15> kScalingCosts = {{
    {"first_step_s", &ScalingCosts::first_step},
    {"step_s", &ScalingCosts::step},
    {"broad_s", &ScalingCosts::broad},
    {"narrow_s", &ScalingCosts::narrow},
    {"rows_s", &ScalingCosts::rows},
    {"solvers_s", &ScalingCosts::solvers},
    {"move_s", &ScalingCosts::move},
    {"rest_s", &ScalingCosts::rest},
    {"held_bytes", &ScalingCosts::held_bytes},
    {"peak_bytes", &ScalingCosts::peak_bytes},
    {"floor_s", &ScalingCosts::floor},
    {"touched_bytes", &ScalingCosts::touched_bytes},
    {"bandwidth", &ScalingCosts::bandwidth},
    {"residual", &ScalingCosts::residual},
    {"error", &ScalingCosts::error},
}};

/// One engine on one scene with so many threads.
struct ScalingRow {
  std::string scene;
  int bodies = 0;  ///< as asked for
  std::string engine;
  std::string accuracy = {};  ///< of the dial; Bullet's: empty
  int threads = 1;
  int steps = 0;             ///< timed, after the first
  std::string failure = {};  ///< why there is no answer, one line; else empty
  bool is_wrong = false;     ///< a failure that no limit of time or memory explains
  ScalingCounts counts = {};
  ScalingCosts costs = {};
};

/// scene, bodies, engine, accuracy, threads, steps: what makes two runs the same one.
[[nodiscard]] std::string scaling_key(const ScalingRow& row);

}  // namespace signorini::bench
