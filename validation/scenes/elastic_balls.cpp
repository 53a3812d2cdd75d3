#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>

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
    double sideways = 0.0;
    double size = 0.0;  // of the momenta: the sum of all |m v|
    for (std::size_t k = 0; k < track.size(); ++k) {
      off = std::max(off, std::abs(track.energy(k) - track.energy(0)));
      const Vec3 p = momentum(scene.bodies, track.bodies[k]);
      sideways = std::max(sideways, std::hypot(p.x(), p.y()));
      double sum = 0.0;
      for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].is_dynamic()) continue;
        sum += scene.bodies[i].mass * track.bodies[k][i].velocity.linear.norm();
      }
      size = std::max(size, sum);
    }
    const bool ours = track.engine == "signorini";
    const CheckText kept{.name = "greatest change of the energy, of that over the plane",
                         .engine = track.engine,
                         .reference = "conservation law",
                         .unit = "1",
                         .reason =
                             "restitution 1 and no friction. In flight the scheme keeps "
                             "E - (h/2) g.p, an impact keeps E; the plane gives p what "
                             "gravity takes, so E rises by (h/2) g^2 m a second: first order"};
    const double rise = 0.5 * track.step * scene.gravity.squaredNorm() * mass * track.time.back();
    report.checks.push_back(ours ? absolute(kept, off / energy, 0.0, rise / energy)
                                 : shown(kept, off / energy, 0.0));
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

}  // namespace signorini::validation
