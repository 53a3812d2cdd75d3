#include <signorini/core/response/position_projection.h>
#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace signorini::validation {
namespace {

/// The arithmetic-geometric mean of 1 and x.
double agm(double x) {
  double a = 1.0;
  for (int i = 0; i < 60 && a != x; ++i) {
    const double mean = 0.5 * (a + x);
    x = std::sqrt(a * x);
    a = mean;
  }
  return a;
}

/// Twice the time between the first two passages of x through 0, or NaN.
double measured_period(const Track& track, int body) {
  std::vector<double> passages;
  for (std::size_t k = 1; k < track.size(); ++k) {
    const double before = track.bodies[k - 1][body].pose.position.x();
    const double now = track.bodies[k][body].pose.position.x();
    if (before * now < 0.0) {
      passages.push_back(track.time[k] -
                         now / (now - before) * (track.time[k] - track.time[k - 1]));
    }
  }
  return passages.size() < 2 ? std::nan("") : 2.0 * (passages[1] - passages[0]);
}

}  // namespace

/// A bar on a hinge at the origin, let go at rest at an angle theta from the vertical:
/// T = 2 pi sqrt(J_pivot/(m g l)) / agm(1, cos(theta/2)).
void check_pendulum(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  const int bar = scene.body("pendulum");
  const Body& body = scene.bodies[bar];
  const Vec3 start = scene.state[bar].x;
  const double length = start.norm();
  const double theta = std::atan2(std::abs(start.x()), -start.z());
  const double J = body.inertia(1, 1) + body.mass * length * length;
  const double period = 2.0 * std::numbers::pi *
                        std::sqrt(J / (body.mass * scene.gravity.norm() * length)) /
                        agm(std::cos(0.5 * theta));
  runs.for_each([&](const Track& track) {
    const CheckText text{.name = "period",
                         .engine = track.engine,
                         .unit = "s",
                         .reason =
                             "second order in the step, (w h)^2 with the frequency w; of first "
                             "order is the swing's energy, w h, which the period knows by theta^2 "
                             "/ 8 at most"};
    const double measured = measured_period(track, bar);
    const double wh = 2.0 * std::numbers::pi / period * track.step;
    const double bound = wh * wh + theta * theta / 8.0 * wh;
    report.checks.push_back(track.engine == "signorini" ? relative(text, measured, period, bound)
                                                        : shown(text, measured, period));
  });
  add_joint_check(scene, runs, report);
  add_energy_check(scene, runs, report);
  report.plots.push_back(plot_over_time(
      "Pendulum", "x [m]", runs,
      [bar](const Track& track, std::size_t k) { return track.bodies[k][bar].pose.position.x(); }));
  add_energy_and_overlap_plots(runs, report);
}

/// A load hangs on a chain of light links, pushed aside with v: its height stays within v^2/(2 g)
/// above the start.
void check_load_on_a_chain(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  const int load = scene.body("crane::load");
  const double v = velocity(scene.bodies[load], scene.state[load]).linear.norm();
  const double rise = v * v / (2.0 * scene.gravity.norm());
  runs.for_each([&](const Track& track) {
    double most = 0.0;
    double down = 0.0;
    for (const std::vector<BodySample>& sample : track.bodies) {
      const double change =
          sample[load].pose.position.z() - track.bodies[0][load].pose.position.z();
      most = std::max(most, std::abs(change));
      down = std::max(down, -change);
    }
    const double links = static_cast<double>(scene.joints.size());
    const double slack = kToleratedJointError * links;
    const CheckText text{.name = "greatest change of the load's height",
                         .engine = track.engine,
                         .unit = "m",
                         .reason =
                             "closed form: at most v^2/(2 g) up, nothing down; beside that "
                             "what the steps' projection leaves, 1e-10 m a link"};
    const CheckText below{
        .name = "greatest drop of the load",
        .engine = track.engine,
        .unit = "m",
        .reason = "closed form: none; what the steps' projection leaves, 1e-10 m a link"};
    const bool ours = track.engine == "signorini";
    report.checks.push_back(ours ? absolute(text, most, 0.0, rise + slack)
                                 : shown(text, most, 0.0));
    report.checks.push_back(ours ? at_most(below, down, slack) : shown(below, down, 0.0));
  });
  add_joint_check(scene, runs, report);
  report.plots.push_back(plot_over_time(
      "Height of the load over its start", "height [m]", runs,
      [load](const Track& track, std::size_t k) {
        return track.bodies[k][load].pose.position.z() - track.bodies[0][load].pose.position.z();
      },
      [](double) { return 0.0; }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
