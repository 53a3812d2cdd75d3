#pragma once

#include "bench/stack_scenes.h"

namespace signorini::bench {

/// Scenes of impacts whose outcome is known in closed form or by a conservation law. All name their
/// error (SteppedScene::error) and are short enough for the event-driven stepper.

/// A cube of 1 m falls flat from 0.5 m, mu = 0.5. Error: the greatest |w|, rad/s; exact: none.
[[nodiscard]] SteppedScene landing_scene(double restitution, double step);

/// Five equal balls in a row that touch, e = 1, no gravity; the first moves into the others at
/// 1 m/s. Error: the speeds at the end, how far the worst is off (0, 0, 0, 0, 1) m/s, which takes a
/// law with break-away (docs/impact-laws.md); Newton's gives (-3/5, 2/5, 2/5, 2/5, 2/5).
[[nodiscard]] SteppedScene cradle_scene(double step);

/// A ball of 1 m falls from 1 m and bounces. Error: how far the first three apexes are off e^(2n)
/// m, of each; an apex is that of the parabola through the highest place and its neighbours in
/// time. One that is missing is off by all of it.
[[nodiscard]] SteppedScene bounce_scene(double restitution, double step);

/// edge^3 equal balls, e = 1, no friction, no gravity, that fly into each other. Error: the
/// greatest change of the kinetic energy, of it.
[[nodiscard]] SteppedScene elastic_balls_scene(int edge, double step);

}  // namespace signorini::bench
