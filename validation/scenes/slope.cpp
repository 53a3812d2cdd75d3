#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

constexpr int kBox = 0;

struct Slope {
  Vec3 downhill;        ///< unit
  double acceleration;  ///< g (sin - mu cos), or 0 where friction holds
};

Slope slope_of(const Scene& scene) {
  const Vec3 normal = scene.colliders[1].local.orientation * Vec3::UnitZ();
  const Vec3 g = scene.gravity;
  const Vec3 along = g - g.dot(normal) * normal;
  const double mu =
      pair(scene.colliders[0].material, scene.colliders[1].material, scene.rule).friction;
  return {along.normalized(), std::max(0.0, along.norm() - mu * std::abs(g.dot(normal)))};
}

double distance(const Slope& slope, const Track& track, std::size_t k) {
  return slope.downhill.dot(track.bodies[k][kBox].pose.position -
                            track.bodies[0][kBox].pose.position);
}

double sideways(const Slope& slope, const Track& track) {
  const Vec3 moved = track.last(kBox).pose.position - track.bodies[0][kBox].pose.position;
  return (moved - slope.downhill.dot(moved) * slope.downhill).norm();
}

}  // namespace

/// Below the friction angle: no motion. Above: a t^2/2 with a = g (sin - mu cos).
void check_slope(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Slope slope = slope_of(scene);
  const Runs runs = run_engines(scene, options, report);
  const double h = scene.step;
  runs.for_each([&](const Track& track) {
    const bool ours = track.engine == "signorini";
    const double t = track.time.back();
    const double fastest = slope.acceleration * t + scene.gravity.norm() * h;
    // Each step's velocities are solved to tolerance (1 + |q|), |q| the speeds in the step; in the
    // worst case these errors add up, and the positions add up the velocities.
    const double steps = static_cast<double>(track.steps);
    const double solver = step_settings(scene).lcp.tolerance * (1.0 + fastest) * steps * t / 2.0;
    if (slope.acceleration == 0.0) {
      const CheckText text{.name = "creep along the slope by the end",
                           .engine = track.engine,
                           .unit = "m",
                           .reason =
                               "friction holds: no motion; each step's velocity is solved to "
                               "the tolerance times (1 + |q|)"};
      const double bound = step_settings(scene).lcp.tolerance * (1.0 + fastest) * t;
      report.checks.push_back(
          ours ? absolute(text, distance(slope, track, track.size() - 1), 0.0, bound)
               : shown(text, distance(slope, track, track.size() - 1), 0.0));
      return;
    }
    const double went = distance(slope, track, track.size() - 1);
    const double exact = 0.5 * slope.acceleration * t * t;
    const CheckText text{.name = "distance slid by the end",
                         .engine = track.engine,
                         .unit = "m",
                         .reason =
                             "a t^2/2; first order: the semi-implicit scheme is a t h/2 "
                             "ahead, and the solver's tolerance"};
    report.checks.push_back(
        ours ? absolute(text, went, exact, 0.5 * slope.acceleration * t * h + solver)
             : shown(text, went, exact));
    const CheckText discrete{.name = "distance slid, against a t (t + h)/2",
                             .engine = track.engine,
                             .reference = "closed form of the scheme",
                             .unit = "m",
                             .reason = "errors of the tolerance times (1 + |q|) a step, added up"};
    const double scheme = 0.5 * slope.acceleration * t * (t + h);
    report.checks.push_back(ours ? absolute(discrete, went, scheme, solver)
                                 : shown(discrete, went, scheme));
  });
  runs.for_each([&](const Track& track) {
    report.checks.push_back(shown({.name = "motion off the line of steepest descent",
                                   .engine = track.engine,
                                   .unit = "m",
                                   .reason = "0 in closed form; includes the overlap that the "
                                             "scheme leaves"},
                                  sideways(slope, track), 0.0));
  });
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  report.plots.push_back(plot_over_time(
      "Distance along the slope", "distance [m]", runs,
      [slope](const Track& track, std::size_t k) { return distance(slope, track, k); },
      [slope](double t) { return 0.5 * slope.acceleration * t * t; }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
