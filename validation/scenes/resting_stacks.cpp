#include <signorini/core/response/resting.h>
#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/impact_cases.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace signorini::validation {
namespace {

/// The force that the contacts of two bodies carry: sum of the normal forces, N.
double carried(const ContactSet& contacts, const lcp::Vector& forces, int a, int b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const bool between = (contacts[i].body_a == a && contacts[i].body_b == b) ||
                         (contacts[i].body_a == b && contacts[i].body_b == a);
    if (between) sum += forces[i];
  }
  return sum;
}

/// Resting forces of the start, level by level: body k rests on body k - 1, body 0 on the ground,
/// which is the last body.
void check_resting_forces(const Scene& scene, SceneReport& report) {
  const ContactSet contacts = touching_contacts(scene);
  RestingReport resting;
  resting_forces(scene.bodies, scene.state, contacts, gravity_loads(scene.bodies, scene.gravity),
                 {}, {}, resting);
  Table table;
  table.title = "Resting forces of the start, all contacts at once";
  table.header = {"between", "contacts carry [N]", "weight above [N]", "relative error"};
  const int levels = static_cast<int>(scene.bodies.size()) - 1;
  const int ground = levels;
  double worst = 0.0;
  for (int k = levels - 1; k >= 0; --k) {
    double weight = 0.0;
    for (int i = k; i < levels; ++i) weight += scene.bodies[i].mass * scene.gravity.norm();
    const int below = k == 0 ? ground : k - 1;
    const double force = carried(contacts, resting.forces, k, below);
    const double error = std::abs(force / weight - 1.0);
    worst = std::isnan(error) ? error : std::max(worst, error);
    table.rows.push_back({scene.bodies[k].name + " / " + scene.bodies[below].name, text(force),
                          text(weight), text(error)});
  }
  report.tables.push_back(table);
  report.settings.push_back(
      fmt::format("Resting forces: {} contacts, {}, unit-free residual {:.3g}", contacts.size(),
                  lcp::to_string(resting.status), resting.result.certificate.unit_free_residual));
  report.checks.push_back(absolute(
      {.name = "resting forces: greatest relative error of a level's sum",
       .unit = "1",
       .reason = "each level carries the weight above; accelerations are solved to 1e-12 (1 + g): "
                 "over the levels above, with the masses' ratio to the lightest body"},
      worst, 0.0, [&] {
        double lightest = scene.bodies[0].mass;
        double total = 0.0;
        for (int i = 0; i < levels; ++i) {
          lightest = std::min(lightest, scene.bodies[i].mass);
          total += scene.bodies[i].mass;
        }
        return 1e-12 * (1.0 + scene.gravity.norm()) * total / lightest;
      }()));
}

double greatest_motion(const Track& track, std::size_t body) {
  double most = 0.0;
  for (const std::vector<BodySample>& sample : track.bodies) {
    most =
        std::max(most, (sample[body].pose.position - track.bodies[0][body].pose.position).norm());
  }
  return most;
}

void check_stands(const Scene& scene, const RunOptions& options, const std::string& what,
                  SceneReport& report) {
  if (options.signorini) check_resting_forces(scene, report);
  const Runs runs = run_engines(scene, options, report);
  const std::size_t levels = scene.bodies.size() - 1;
  runs.for_each([&](const Track& track) {
    const double t = track.time.back();
    const CheckText text{
        .name = what,
        .engine = track.engine,
        .unit = "m",
        .reason =
            "closed form: no motion; each step's velocities are solved to "
            "the tolerance times (1 + |q|), and the overlap that this makes is pushed "
            "out above 1e-10 m"};
    double most = 0.0;
    for (std::size_t body = 0; body < levels; ++body) {
      most = std::max(most, greatest_motion(track, body));
    }
    const double bound =
        step_settings(scene).lcp.tolerance * (1.0 + scene.gravity.norm() * scene.step) * t +
        1e-10 * static_cast<double>(levels);
    report.checks.push_back(track.engine == "signorini" ? absolute(text, most, 0.0, bound)
                                                        : shown(text, most, 0.0));
  });
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  const std::size_t top = levels - 1;
  report.plots.push_back(plot_over_time(
      "Height of the top body over its start", "height [m]", runs,
      [top](const Track& track, std::size_t k) {
        return track.bodies[k][top].pose.position.z() - track.bodies[0][top].pose.position.z();
      },
      [](double) { return 0.0; }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace

/// No motion; each level carries the weight above.
void check_stack(const Scene& scene, const RunOptions& options, SceneReport& report) {
  check_stands(scene, options, "greatest motion of a box", report);
}

/// No motion; 1000 g on the small box and 1001 g under it.
void check_mass_ratio(const Scene& scene, const RunOptions& options, SceneReport& report) {
  check_stands(scene, options, "greatest motion of a box", report);
}

}  // namespace signorini::validation
