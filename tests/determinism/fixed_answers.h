#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace signorini::testing {

/// What a part of the library answers to a fixed input.
struct FixedAnswers {
  std::string part;  ///< "time steps, reference"
  /// What a debug and a release build may differ by: |difference| over the largest |number|. They
  /// round differently where the compiler contracts a multiplication and an addition.
  double bound = 0.0;
  std::vector<std::int64_t> choices = {};  ///< statuses, counts, feature ids: equal in every build
  std::vector<double> numbers = {};        ///< what the input determines: w, velocities, poses
  /// Of one build alone: how redundant contacts share a load, iterations, what was
  /// not solved.
  std::vector<double> left_open = {};
};

/// Every solver, impact law (with friction those that take it) and dial position, the event-driven
/// stepper with and without friction, and collision detection.
/// Time steps and sweeps take `threads` threads.
[[nodiscard]] std::vector<FixedAnswers> fixed_answers(int threads);

}  // namespace signorini::testing
