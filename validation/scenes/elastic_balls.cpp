#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::validation {

/// Energy and horizontal momentum stay.
void check_elastic_grid(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  double energy = 0.0;
  double mass = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].is_dynamic()) continue;
    energy -= scene.bodies[i].mass * scene.gravity.dot(scene.state[i].x);
    mass += scene.bodies[i].mass;
  }
  runs.for_each([&](const Track& track) {
    double off = 0.0;
    double rise = 0.0;
    double sideways = 0.0;
    double size = 0.0;    // of the momenta: the sum of all |m v|
    double upward = 0.0;  // momentum against gravity
    for (std::size_t k = 0; k < track.size(); ++k) {
      off = std::max(off, std::abs(track.energy(k) - track.energy(0)));
      rise = std::max(rise, track.energy(k) - track.energy(0));
      const Vec3 p = momentum(scene.bodies, track.bodies[k]);
      sideways = std::max(sideways, std::hypot(p.x(), p.y()));
      upward = std::max(upward, -p.dot(scene.gravity.normalized()));
      double sum = 0.0;
      for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].is_dynamic()) continue;
        sum += scene.bodies[i].mass * track.bodies[k][i].velocity.linear.norm();
      }
      size = std::max(size, sum);
    }
    const bool ours = track.engine == "signorini";
    report.checks.push_back(shown(
        {.name = "greatest change of the energy, of that over the plane",
         .engine = track.engine,
         .reference = "conservation law",
         .unit = "1",
         .reason = "restitution 1 and no friction: none. Ours loses some where a ball comes to "
                   "another within a step of an impact and is stopped at its gap; of first order"},
        off / energy, 0.0));
    const CheckText risen{.name = "greatest rise of the energy, of that over the plane",
                          .engine = track.engine,
                          .reference = "conservation law",
                          .unit = "1",
                          .reason =
                              "E changes by -(h/2) m g^2 a step in flight and by -h g.J in an "
                              "impact J, and the plane's impulses are M g t and the momentum: "
                              "(h/2) M g^2 t + h |g| |p|"};
    const double g = scene.gravity.norm();
    const double bound =
        0.5 * track.step * g * g * mass * track.time.back() + track.step * g * upward +
        std::numeric_limits<double>::epsilon() * static_cast<double>(track.steps) * energy;
    report.checks.push_back(ours ? absolute(risen, rise / energy, 0.0, bound / energy)
                                 : shown(risen, rise / energy, 0.0));
    const CheckText across{.name = "greatest momentum along the plane",
                           .engine = track.engine,
                           .reference = "conservation law",
                           .unit = "kg m/s",
                           .reason =
                               "equal and opposite impulses, none along the plane: one rounding "
                               "of every momentum a step, all to one side"};
    const double rounding =
        std::numeric_limits<double>::epsilon() * static_cast<double>(track.steps) * size;
    report.checks.push_back(ours ? absolute(across, sideways, 0.0, rounding)
                                 : shown(across, sideways, 0.0));
  });
  add_overlap_check(scene, runs, report);
  add_energy_and_overlap_plots(runs, report);
}

/// Each ball stops on the one below, its column upright, and nothing overlaps.
void check_ball_columns(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  // Where it must land: above those that are lower at the same place.
  std::vector<Vec3> landed;
  std::vector<std::size_t> balls;
  double highest = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].is_dynamic()) continue;
    const Vec3 x = scene.state[i].x;
    const double radius = std::get<collision::Sphere>(scene.colliders[i].shape).radius;
    double height = radius;
    for (std::size_t j = 0; j < scene.bodies.size(); ++j) {
      const Vec3 other = scene.state[j].x;
      const bool below = other.head<2>() == x.head<2>() && other.z() < x.z();
      height += scene.bodies[j].is_dynamic() && below ? 2.0 * radius : 0.0;
    }
    balls.push_back(i);
    landed.emplace_back(x.x(), x.y(), height);
    highest = std::max(highest, x.z() - height);
  }
  const double speed = std::sqrt(2.0 * scene.gravity.norm() * highest);
  runs.for_each([&](const Track& track) {
    double off = 0.0;
    for (std::size_t b = 0; b < balls.size(); ++b) {
      off = std::max(off, (track.bodies.back()[balls[b]].pose.position - landed[b]).norm());
    }
    const bool ours = track.engine == "signorini";
    const double solved = step_settings(scene).lcp.tolerance * (1.0 + speed) * scene.duration;
    const CheckText place{.name = "from where they must land: greatest distance of a body",
                          .engine = track.engine,
                          .unit = "m",
                          .reason =
                              "restitution 0 and one line of centres: each step's velocities are "
                              "solved to the tolerance times (1 + |q|), |q| the speed of the "
                              "landing, over the run"};
    const CheckText depth{.name = "deepest overlap of the run",
                          .engine = track.engine,
                          .reference = "definition",
                          .unit = "m",
                          .reason = "the same, and 1e-10 m that the projection leaves"};
    report.checks.push_back(ours ? absolute(place, off, 0.0, solved) : shown(place, off, 0.0));
    report.checks.push_back(ours ? absolute(depth, track.deepest_overlap(), 0.0, solved + 1e-10)
                                 : shown(depth, track.deepest_overlap(), 0.0));
  });
  add_energy_check(scene, runs, report);
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
