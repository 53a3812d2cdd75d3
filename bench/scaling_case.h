#pragma once

#include "bench/scaling_row.h"

#include <cstddef>
#include <string>
#include <vector>

namespace signorini::bench {

inline constexpr const char* kOurEngine = "signorini";

/// A scene of so many bodies.
struct ScalingCase {
  std::string scene;  ///< of scaling_scene_names()
  int bodies = 0;
};

struct ScalingRunOptions {
  std::string accuracy = "engineering";  ///< position of the dial
  std::vector<int> threads = {1};        ///< the first is 1
  int steps = 10;                        ///< timed, after the first; >= 1
  double cpu_seconds = 3600.0;           ///< of a case, > 0
  std::size_t bytes = 0;                 ///< of a case, > 0
};

/// Steps the scene with TimeStepper and CollisionWorld. First on one thread with every solve
/// certified anew (certify()) and counted; then timed with each number of threads, and once more
/// for the allocations: these runs must end in the same bits, or they are no answer. In a child
/// process. @return one row a number of threads, or one that says why there is none
[[nodiscard]] std::vector<ScalingRow> run_scaling_case(const ScalingCase& what,
                                                       const ScalingRunOptions& options);

/// The same scene stepped by Bullet in double precision with its defaults.
[[nodiscard]] ScalingRow run_bullet_scaling_case(const ScalingCase& what, int iterations,
                                                 const ScalingRunOptions& options);

}  // namespace signorini::bench
