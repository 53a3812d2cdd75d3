#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace signorini::validation {

/// One way to run a scene: how far off it ends, and what it costs.
struct TradePoint {
  std::string solver;            ///< "Signorini, 1e-08", "Bullet, neutral, 50 iterations"
  std::string engine;            ///< "signorini" or "bullet"
  double step = 0.0;             ///< s
  double error = 0.0;            ///< of the scene's error, in its unit; NaN: the run gave none
  double whole_seconds = -1.0;   ///< wall time of all steps, s
  double solver_seconds = -1.0;  ///< of that inside the solver of contacts, s; -1: not measured
};

/// The one error that a scene names, under every way it was run.
struct Trade {
  std::string error;      ///< the name of the check
  std::string unit;       ///< of the errors and of the scale
  std::string reference;  ///< "closed form", "conservation law" ...
  double scale = 1.0;     ///< an error of this size is a wholly wrong answer; in unit
  double duration = 0.0;  ///< simulated, s
  std::vector<TradePoint> points;
};

/// Errors below this share of the scale count as equal: none of them is seen.
inline constexpr double kEqualErrors = 1e-9;

/// A point of another engine that is cheaper than every point of ours that errs no more.
struct Loss {
  std::size_t theirs = 0;  ///< index into Trade::points
  bool reached = false;    ///< do we err as little anywhere
  std::size_t ours = 0;    ///< the cheapest point of ours that does, if reached
  /// Our whole_seconds there over theirs, > 1; +infinity if not reached.
  double factor = 0.0;
};

/// Where another engine is faster at equal error: every such point, the largest factor first.
/// A point without an error (NaN), or wrong by the scale or more, is no answer: it wins nothing.
/// O(points^2).
[[nodiscard]] std::vector<Loss> losses(const Trade& trade);

}  // namespace signorini::validation
