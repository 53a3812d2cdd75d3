#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace signorini::validation {
namespace {

constexpr int kCube = 0;
constexpr double kLands = std::numbers::pi / 4.0;  ///< the angle at which a face lies down, rad

/// A cube that tips over an edge fixed at the origin along y: its centre at the distance R, turned
/// by the angle `a` past the vertical. About the edge J = J_c + m R^2, so
///
///     w^2 = w0^2 + 2 m g R (cos a0 - cos a) / J.
struct Tipping {
  double start;  ///< a0, rad
  double spin;   ///< w0, rad/s
  double pull;   ///< m g R / J, 1/s^2: the greatest w'

  [[nodiscard]] double w(double angle) const {
    return std::sqrt(spin * spin + 2.0 * pull * (std::cos(start) - std::cos(angle)));
  }
  /// The time from the start to an angle: the integral of 1/w, by Simpson's rule.
  [[nodiscard]] double time(double angle) const {
    constexpr int kIntervals = 2000;
    const double step = (angle - start) / kIntervals;
    double sum = 1.0 / w(start) + 1.0 / w(angle);
    for (int k = 1; k < kIntervals; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) / w(start + k * step);
    return sum * step / 3.0;
  }
};

Tipping tipping_of(const Scene& scene) {
  const Body& cube = scene.bodies[kCube];
  const Vec3 x = scene.state[kCube].x;
  const double R = x.norm();
  const double inertia = cube.inertia(1, 1) + cube.mass * R * R;
  return {std::atan2(x.x(), x.z()), velocity(cube, scene.state[kCube]).angular.y(),
          cube.mass * scene.gravity.norm() * R / inertia};
}

double spin(const Track& track, std::size_t k) {
  return track.bodies[k][kCube].velocity.angular.y();
}

/// The first sample after which the spin falls to less than half within two steps: the landing.
std::size_t landing(const Track& track) {
  for (std::size_t k = 0; k + 2 < track.size(); ++k) {
    if (spin(track, k) > 1.0 && spin(track, k + 2) < 0.5 * spin(track, k)) return k;
  }
  return track.size() - 1;
}

}  // namespace

/// The cube tips about its edge, lands on a face and rocks on at a quarter of its spin.
void check_tipping(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Tipping exact = tipping_of(scene);
  const Runs runs = run_engines(scene, options, report);
  const double h = scene.step;
  runs.for_each([&](const Track& track) {
    const bool ours = track.engine == "signorini";
    const auto add = [&](const CheckText& text, double value, double expected, double tolerance) {
      report.checks.push_back(ours ? absolute(text, value, expected, tolerance)
                                   : shown(text, value, expected));
    };
    const std::size_t last = landing(track);
    add({.name = "spin when the face lands",
         .engine = track.engine,
         .unit = "rad/s",
         .reason = "energy about the edge; the landing falls inside a step: one step of the "
                   "greatest angular acceleration m g R/J, and one of the scheme's first order"},
        spin(track, last), exact.w(kLands), 2.0 * exact.pull * h);
    add({.name = "time when the face lands",
         .engine = track.engine,
         .unit = "s",
         .reason = "the integral of 1/w from 10 to 45 degrees; seen two steps early or late, and "
                   "the scheme's first order, half a step of the greatest angular acceleration "
                   "over the spin"},
        track.time[last], exact.time(kLands), 2.0 * h + exact.pull * h * track.time[last]);
    const std::size_t after = std::min(last + 2, track.size() - 1);
    add({.name = "spin after the landing over spin before",
         .engine = track.engine,
         .unit = "1",
         .reason = "angular momentum about the new edge: (J_c + m r_A.r_B)/(J_c + m R^2) = 1/4 of "
                   "a cube whose edges are 90 degrees apart (Housner 1963); two steps of the "
                   "greatest angular acceleration over the spin"},
        spin(track, after) / spin(track, last), 0.25, 2.0 * exact.pull * h / exact.w(kLands));
  });
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  const double lands = exact.time(kLands);
  report.plots.push_back(plot_over_time("Spin about the edge", "spin [rad/s]", runs, spin));
  // In closed form up to the landing.
  Series line{"closed form", "closed form", {}, {}};
  for (int k = 0; k <= 100; ++k) {
    const double angle = exact.start + (kLands - exact.start) * k / 100.0;
    line.x.push_back(k == 100 ? lands : exact.time(angle));
    line.y.push_back(exact.w(angle));
  }
  report.plots.back().series.push_back(std::move(line));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
