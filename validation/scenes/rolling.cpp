#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::validation {
namespace {

constexpr int kRound = 0;

/// A round body on a plane that slopes by alpha, with speed v0 downhill and no spin: m mass, r its
/// radius, I its inertia about its axis. While it slips (s = v - r w > 0)
///
///     v' = g sin - mu g cos,  w' = mu m g cos r / I,  s' = g sin - mu g cos (1 + m r^2/I);
///
/// from s = 0 on it rolls with v' = g sin / (1 + I/(m r^2)), if friction carries that:
/// g sin I/(I + m r^2) <= mu g cos.
struct Rolling {
  Vec3 downhill;  ///< unit
  Vec3 axis;      ///< w > 0 about it rolls downhill, unit
  double radius;
  double speed;        ///< v0, m/s
  double slipping;     ///< v', m/s^2
  double spinning_up;  ///< w' while slipping, rad/s^2
  double rolling;      ///< v' once it rolls, m/s^2
  double rolls_from;   ///< s; +infinity: never

  /// What v, and w, may be off by when rolling begins inside a step of length h.
  [[nodiscard]] double speed_slack(double h) const {
    return rolls_from > 0.0 && std::isfinite(rolls_from) ? std::abs(slipping - rolling) * h : 0.0;
  }
  [[nodiscard]] double spin_slack(double h) const {
    return rolls_from > 0.0 && std::isfinite(rolls_from)
               ? std::abs(spinning_up - rolling / radius) * h
               : 0.0;
  }
  [[nodiscard]] double v(double t) const {
    const double slips = std::min(t, rolls_from);
    return speed + slipping * slips + rolling * (t - slips);
  }
  [[nodiscard]] double w(double t) const {
    return t <= rolls_from ? spinning_up * t : v(t) / radius;
  }
  [[nodiscard]] double distance(double t) const {
    const double slips = std::min(t, rolls_from);
    const double then = t - slips;
    return speed * slips + 0.5 * slipping * slips * slips + v(slips) * then +
           0.5 * rolling * then * then;
  }
};

Rolling rolling_of(const Scene& scene) {
  const Body& body = scene.bodies[kRound];
  const Vec3 normal = scene.colliders[1].local.orientation * Vec3::UnitZ();
  const Vec3 along = scene.gravity - scene.gravity.dot(normal) * normal;
  const Vec3 velocity_0 = velocity(body, scene.state[kRound]).linear;
  Rolling result;
  result.downhill = along.norm() > 1e-9 ? along.normalized() : velocity_0.normalized();
  result.axis = normal.cross(result.downhill);
  result.radius = normal.dot(scene.state[kRound].x - scene.state[1].x);
  result.speed = velocity_0.dot(result.downhill);
  const Mat3 R = scene.state[kRound].q.toRotationMatrix();
  const double inertia = result.axis.dot(R * body.inertia * R.transpose() * result.axis);
  const double ratio = body.mass * result.radius * result.radius / inertia;
  const double mu =
      pair(scene.colliders[0].material, scene.colliders[1].material, scene.rule).friction;
  const double pull = along.norm();
  const double friction = mu * std::abs(scene.gravity.dot(normal));
  const double slip_rate = pull - friction * (1.0 + ratio);
  result.slipping = pull - friction;
  result.spinning_up = friction * ratio / result.radius;
  result.rolling = pull / (1.0 + 1.0 / ratio);
  result.rolls_from =
      slip_rate < 0.0 ? result.speed / -slip_rate : std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace

/// Speed, distance and spin of a body that slips and rolls on a plane.
void check_rolling(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Rolling exact = rolling_of(scene);
  const Runs runs = run_engines(scene, options, report);
  const double h = scene.step;
  const auto speed = [exact](const Track& track, std::size_t k) {
    return exact.downhill.dot(track.bodies[k][kRound].velocity.linear);
  };
  const auto spin = [exact](const Track& track, std::size_t k) {
    return exact.axis.dot(track.bodies[k][kRound].velocity.angular);
  };
  const auto distance = [exact](const Track& track, std::size_t k) {
    return exact.downhill.dot(track.bodies[k][kRound].pose.position -
                              track.bodies[0][kRound].pose.position);
  };
  runs.for_each([&](const Track& track) {
    const bool ours = track.engine == "signorini";
    const std::size_t last = track.size() - 1;
    const double t = track.time.back();
    const double greatest = std::max({exact.speed, exact.v(t), exact.radius * exact.w(t)});
    // Each step's velocities are solved to tolerance (1 + |q|); these errors add up.
    const double solver = step_settings(scene).lcp.tolerance *
                          (1.0 + greatest + h * scene.gravity.norm()) *
                          static_cast<double>(track.steps);
    const double fastest = std::max(std::abs(exact.slipping), std::abs(exact.rolling));
    const auto add = [&](const CheckText& text, double value, double expected, double tolerance) {
      report.checks.push_back(ours ? absolute(text, value, expected, tolerance)
                                   : shown(text, value, expected));
    };
    add({.name = "speed at the end",
         .engine = track.engine,
         .unit = "m/s",
         .reason = "exact but for the step inside which slipping ends, if it does: a step of the "
                   "change of acceleration there; and the solver's tolerance"},
        speed(track, last), exact.v(t), exact.speed_slack(h) + solver);
    add({.name = "spin at the end",
         .engine = track.engine,
         .unit = "rad/s",
         .reason = "as for the speed"},
        spin(track, last), exact.w(t), exact.spin_slack(h) + solver / exact.radius);
    add({.name = "distance at the end",
         .engine = track.engine,
         .unit = "m",
         .reason = "first order: the semi-implicit scheme is a t h/2 ahead; and the speed's error "
                   "over the whole time"},
        distance(track, last), exact.distance(t),
        0.5 * fastest * t * h + (exact.speed_slack(h) + solver) * t);
  });
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  report.plots.push_back(plot_over_time("Speed", "speed [m/s]", runs, speed,
                                        [exact](double t) { return exact.v(t); }));
  report.plots.push_back(
      plot_over_time("Spin", "spin [rad/s]", runs, spin, [exact](double t) { return exact.w(t); }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
