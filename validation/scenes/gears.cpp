#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

/// Two wheels on parallel axles, pressed on each other by N, friction mu: F = mu N until the
/// surfaces have one speed.
struct Gears {
  double r1, r2, J1, J2, w0, force;

  [[nodiscard]] double meshes_at() const {
    return w0 * r1 / (force * (r1 * r1 / J1 + r2 * r2 / J2));
  }
  [[nodiscard]] double driver(double t) const {
    return w0 - force * r1 / J1 * std::min(t, meshes_at());
  }
  [[nodiscard]] double driven(double t) const {
    return -force * r2 / J2 * std::min(t, meshes_at());
  }
};

double radius(const Scene& scene, int body) {
  for (const collision::Collider& collider : scene.colliders) {
    if (collider.body == body) return std::get<collision::Cylinder>(collider.shape).radius;
  }
  return std::nan("");
}

}  // namespace

/// w1 and w2 fall and rise evenly until w1 R1 = -w2 R2, and stay.
void check_gears(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const int driver = scene.body("driver");
  const int driven = scene.body("driven::wheel");
  const int carriage = scene.body("driven::carriage");
  const double pressing =
      (scene.bodies[driven].mass + scene.bodies[carriage].mass) * scene.gravity.norm();
  const Gears gears{.r1 = radius(scene, driver),
                    .r2 = radius(scene, driven),
                    .J1 = scene.bodies[driver].inertia(2, 2),
                    .J2 = scene.bodies[driven].inertia(2, 2),
                    .w0 = velocity(scene.bodies[driver], scene.state[driver]).angular.y(),
                    .force = scene.colliders.front().material.friction * pressing};
  const Runs runs = run_engines(scene, options, report);
  const auto spin = [](const Track& track, std::size_t k, int body) {
    return track.bodies[k][body].velocity.angular.y();
  };
  runs.for_each([&](const Track& track) {
    double off = 0.0;
    for (std::size_t k = 0; k < track.size(); ++k) {
      off = std::max({off, std::abs(spin(track, k, driver) - gears.driver(track.time[k])),
                      std::abs(spin(track, k, driven) - gears.driven(track.time[k]))});
    }
    const double slip = spin(track, track.size() - 1, driver) * gears.r1 +
                        spin(track, track.size() - 1, driven) * gears.r2;
    const CheckText spins{.name = "greatest error of a wheel's spin",
                          .engine = track.engine,
                          .unit = "rad/s",
                          .reason =
                              "a constant force, so that steps are exact; each step's velocities "
                              "are solved to the tolerance times (1 + |q|), |q| = w0 R1"};
    const CheckText meshed{
        .name = "slip of the surfaces at the end",
        .engine = track.engine,
        .unit = "m/s",
        .reason = "they have one speed: solved to the tolerance times (1 + |q|)"};
    const bool ours = track.engine == "signorini";
    const double solved = step_settings(scene).lcp.tolerance * (1.0 + gears.w0 * gears.r1);
    const double steps = static_cast<double>(track.steps);
    report.checks.push_back(ours ? absolute(spins, off, 0.0, steps * solved / gears.r2)
                                 : shown(spins, off, 0.0));
    report.checks.push_back(ours ? absolute(meshed, slip, 0.0, solved) : shown(meshed, slip, 0.0));
  });
  add_joint_check(scene, runs, report);
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  report.plots.push_back(plot_over_time(
      "Driving wheel", "w about the axle [rad/s]", runs,
      [&](const Track& track, std::size_t k) { return spin(track, k, driver); },
      [&](double t) { return gears.driver(t); }));
  report.plots.push_back(plot_over_time(
      "Driven wheel", "w about the axle [rad/s]", runs,
      [&](const Track& track, std::size_t k) { return spin(track, k, driven); },
      [&](double t) { return gears.driven(t); }));
  add_energy_and_overlap_plots(runs, report);
}

/// Wheels that are spun up by the ground: v = v0 M/(M + 4 J/r^2) once they roll.
void check_vehicle(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const int chassis = scene.body("vehicle::chassis");
  double mass = 0.0;
  double rolling = 0.0;  // the sum of J/r^2
  double wheel = 0.0;    // the radius
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.is_dynamic()) continue;
    mass += body.mass;
    if (static_cast<int>(i) == chassis) continue;
    wheel = radius(scene, static_cast<int>(i));
    rolling += body.inertia(2, 2) / (wheel * wheel);
  }
  const double start = velocity(scene.bodies[chassis], scene.state[chassis]).linear.y();
  const double rolls = start * mass / (mass + rolling);
  const Runs runs = run_engines(scene, options, report);
  runs.for_each([&](const Track& track) {
    double slip = 0.0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (!scene.bodies[i].is_dynamic() || static_cast<int>(i) == chassis) continue;
      const Velocity v = track.last(static_cast<int>(i)).velocity;
      slip = std::max(slip, std::abs(v.linear.y() + wheel * v.angular.x()));
    }
    const CheckText speed{
        .name = "speed at the end",
        .engine = track.engine,
        .unit = "m/s",
        .reason =
            "momentum and spin are exchanged by one impulse, so that steps are "
            "exact; a step's velocities are solved to the tolerance times "
            "(1 + |q|), and the axles are closed by the projection: h of 1e-10 m"};
    const CheckText rolled{.name = "greatest slip of a wheel at the end",
                           .engine = track.engine,
                           .unit = "m/s",
                           .reason = "it rolls: solved to the tolerance times (1 + |q|)"};
    const bool ours = track.engine == "signorini";
    const double solved = step_settings(scene).lcp.tolerance * (1.0 + start);
    const double at_end = track.last(chassis).velocity.linear.y();
    report.checks.push_back(
        ours ? absolute(speed, at_end, rolls,
                        solved * static_cast<double>(track.steps) + 1e-10 / track.step)
             : shown(speed, at_end, rolls));
    report.checks.push_back(ours ? absolute(rolled, slip, 0.0, 2.0 * solved)
                                 : shown(rolled, slip, 0.0));
  });
  add_joint_check(scene, runs, report);
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  report.plots.push_back(plot_over_time(
      "Speed of the chassis", "v [m/s]", runs,
      [chassis](const Track& track, std::size_t k) {
        return track.bodies[k][chassis].velocity.linear.y();
      },
      [rolls](double) { return rolls; }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
