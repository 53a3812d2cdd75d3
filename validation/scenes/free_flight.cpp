#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::validation {
namespace {

constexpr int kBrick = 0;

/// Turn about z of a body that spins about z, rad, in (-pi, pi].
double angle(const BodySample& sample) {
  return 2.0 * std::atan2(sample.pose.orientation.z(), sample.pose.orientation.w());
}

/// The difference of two angles, wrapped to (-pi, pi].
double angle_difference(double a, double b) {
  return std::remainder(a - b, 2.0 * M_PI);
}

/// The greatest distance of a track from x0 + v0 t + g t (t + shift)/2.
double distance_from_parabola(const Scene& scene, const Track& track, double shift) {
  const BodySample& start = track.bodies.front()[kBrick];
  double worst = 0.0;
  for (std::size_t k = 0; k < track.size(); ++k) {
    const double t = track.time[k];
    const Vec3 exact =
        start.pose.position + t * start.velocity.linear + 0.5 * t * (t + shift) * scene.gravity;
    worst = std::max(worst, (track.bodies[k][kBrick].pose.position - exact).norm());
  }
  return worst;
}

double final_angle_error(const Scene& scene, const Track& track) {
  const double w = velocity(scene.bodies[kBrick], scene.state[kBrick]).angular.z();
  return std::abs(angle_difference(angle(track.last(kBrick)), w * track.time.back()));
}

}  // namespace

/// x = x0 + v0 t + g t^2/2; angle = w t about a principal axis. Semi-implicit: x is off by
/// g t h/2 exactly, the angle by (w h)^2/12 of itself. RK4 is exact for x and of order (w h)^4 for
/// the angle.
void check_free_flight(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  const double h = scene.step;
  const double t = static_cast<double>(scene.step_count()) * h;
  const double g = scene.gravity.norm();
  const Velocity start = velocity(scene.bodies[kBrick], scene.state[kBrick]);
  const double size = start.linear.norm() * t + 0.5 * g * t * t;
  // One rounding of a sum of this size a step.
  const double rounding = std::numeric_limits<double>::epsilon() * t / h * size;
  const double w = start.angular.z();

  runs.for_each([&](const Track& track) {
    const bool ours = track.engine == "signorini";
    const CheckText parabola{.name = "greatest distance from the parabola",
                             .engine = track.engine,
                             .unit = "m",
                             .reason = "first order: the semi-implicit scheme is off by g t h/2"};
    const double distance = distance_from_parabola(scene, track, 0.0);
    report.checks.push_back(ours ? absolute(parabola, distance, 0.0, 0.5 * g * t * h + rounding)
                                 : shown(parabola, distance, 0.0));
    const CheckText discrete{.name = "greatest distance from x0 + v0 t + g t (t + h)/2",
                             .engine = track.engine,
                             .reference = "closed form of the scheme",
                             .unit = "m",
                             .reason = "one rounding a step"};
    const double off = distance_from_parabola(scene, track, h);
    report.checks.push_back(ours ? absolute(discrete, off, 0.0, rounding)
                                 : shown(discrete, off, 0.0));
    const CheckText turn{.name = "angle after the flight, error",
                         .engine = track.engine,
                         .unit = "rad",
                         .reason =
                             "five turns of 2 atan(a_i w h/2) a step, sum a_i^3 = 0: their fifth "
                             "powers leave w t (w h)^4/1074, and 7 % for the next term"};
    const double error = final_angle_error(scene, track);
    report.checks.push_back(
        ours ? absolute(turn, error, 0.0, w * t * std::pow(w * h, 4) / 1000.0 + rounding)
             : shown(turn, error, 0.0));
  });

  if (options.signorini) {
    TimeStepSettings settings = step_settings(scene);
    settings.integrator = Integrator::kRungeKutta4;
    const Track exact = run_ours(scene, settings, options);
    report.checks.push_back(absolute({.name = "Runge-Kutta 4: greatest distance from the parabola",
                                      .unit = "m",
                                      .reason = "RK4 is exact for a parabola: rounding alone"},
                                     distance_from_parabola(scene, exact, 0.0), 0.0, rounding));
    report.checks.push_back(absolute(
        {.name = "Runge-Kutta 4: angle after the flight, error",
         .unit = "rad",
         .reason = "fourth order: w t (w h)^4/120 of the Taylor remainder of the turn"},
        final_angle_error(scene, exact), 0.0, w * t * std::pow(w * h, 4) / 120.0 + rounding));
  }
  report.plots.push_back(plot_over_time(
      "Height", "height [m]", runs,
      [](const Track& track, std::size_t k) { return track.bodies[k][kBrick].pose.position.z(); },
      [&](double time) {
        return scene.state[kBrick].x.z() + start.linear.z() * time +
               0.5 * scene.gravity.z() * time * time;
      }));
  report.plots.push_back(
      plot_over_time("Kinetic and potential energy", "energy [J]", runs,
                     [](const Track& track, std::size_t k) { return track.energy(k); }));
}

}  // namespace signorini::validation
