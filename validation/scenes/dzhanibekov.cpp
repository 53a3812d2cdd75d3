#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

constexpr int kBlock = 0;

/// Spin about the middle axis in body axes, rad/s; the inertia is diagonal.
double middle_spin(const Track& track, std::size_t k, int axis) {
  const BodySample& sample = track.bodies[k][kBlock];
  return (sample.pose.orientation.conjugate() * sample.velocity.angular)[axis];
}

struct Axes {
  int low, middle, high;
  double I1, I2, I3;  ///< ascending, kg m^2
};

Axes axes_of(const Body& body) {
  std::array<int, 3> order = {0, 1, 2};
  const Vec3 J = body.inertia.diagonal();
  std::sort(order.begin(), order.end(), [&J](int a, int b) { return J[a] < J[b]; });
  return {order[0], order[1], order[2], J[order[0]], J[order[1]], J[order[2]]};
}

/// Half a period of the spin: Landau and Lifshitz, Mechanics, section 37. With L^2 = sum (I w)^2
/// and 2T = sum I w^2, where L^2 > 2T I2 (else with 1 and 3 exchanged),
///
///     w_2 ~ sn(t sqrt((I3 - I2)(L^2 - 2T I1)/(I1 I2 I3)), k),
///     k^2 = (I2 - I1)(2T I3 - L^2) / ((I3 - I2)(L^2 - 2T I1)),
///
/// so w_2 changes its sign every 2 K(k) over that rate.
double half_period(const Axes& axes, const Vec3& w) {
  const double L2 = std::pow(axes.I1 * w[axes.low], 2) + std::pow(axes.I2 * w[axes.middle], 2) +
                    std::pow(axes.I3 * w[axes.high], 2);
  const double T2 = axes.I1 * w[axes.low] * w[axes.low] +
                    axes.I2 * w[axes.middle] * w[axes.middle] +
                    axes.I3 * w[axes.high] * w[axes.high];
  double I1 = axes.I1;
  double I3 = axes.I3;
  if (L2 < T2 * axes.I2) std::swap(I1, I3);
  const double k2 = (axes.I2 - I1) * (T2 * I3 - L2) / ((I3 - axes.I2) * (L2 - T2 * I1));
  const double rate = std::sqrt((I3 - axes.I2) * (L2 - T2 * I1) / (I1 * axes.I2 * I3));
  return 2.0 * std::comp_ellint_1(std::sqrt(k2)) / rate;
}

/// The times at which the middle spin changes its sign, by a straight line between samples.
std::vector<double> turnings(const Track& track, int axis) {
  std::vector<double> times;
  for (std::size_t k = 1; k < track.size(); ++k) {
    const double a = middle_spin(track, k - 1, axis);
    const double b = middle_spin(track, k, axis);
    if (a * b < 0.0) {
      times.push_back(track.time[k - 1] + (track.time[k] - track.time[k - 1]) * a / (a - b));
    }
  }
  return times;
}

}  // namespace

/// The time from one turning-over to the next.
void check_dzhanibekov(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Axes axes = axes_of(scene.bodies[kBlock]);
  const Vec3 w = scene.state[kBlock].q.conjugate() *
                 velocity(scene.bodies[kBlock], scene.state[kBlock]).angular;
  const double exact = half_period(axes, w);
  const Runs runs = run_engines(scene, options, report);
  runs.for_each([&](const Track& track) {
    const bool ours = track.engine == "signorini";
    const std::vector<double> times = turnings(track, axes.middle);
    const auto expected_count = static_cast<double>(std::floor(scene.duration / exact + 0.5));
    const CheckText count{.name = "times it turned over",
                          .engine = track.engine,
                          .unit = "1",
                          .reason = "from its start in a quarter period, then every half period"};
    const auto turned = static_cast<double>(times.size());
    report.checks.push_back(ours ? absolute(count, turned, expected_count, 0.0)
                                 : shown(count, turned, expected_count));
    if (times.size() < 2) return;
    const double n = static_cast<double>(times.size() - 1);
    const double interval = (times.back() - times.front()) / n;
    const CheckText text{.name = "time from one turning-over to the next, on average",
                         .engine = track.engine,
                         .unit = "s",
                         .reason =
                             "Jacobi's elliptic functions; the spin is straight where it is 0, "
                             "so that each end is found to h (w h)^2, and the integrator's own "
                             "error is of fourth order, (w h)^4 of the whole"};
    const double wh = w.norm() * scene.step;
    const double bound = 2.0 * scene.step / n * wh * wh + exact * std::pow(wh, 4);
    report.checks.push_back(ours ? absolute(text, interval, exact, bound)
                                 : shown(text, interval, exact));
  });
  add_energy_check(scene, runs, report);
  const int middle = axes.middle;
  report.plots.push_back(plot_over_time(
      "Spin about the middle axis of the block", "spin [rad/s]", runs,
      [middle](const Track& track, std::size_t k) { return middle_spin(track, k, middle); }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
