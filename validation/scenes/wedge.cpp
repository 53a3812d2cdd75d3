#include <signorini/core/response/single_impulse.h>
#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/impact_cases.h>
#include <signorini/validation/signorini_runner.h>

#include <fmt/format.h>

namespace signorini::validation {
namespace {

constexpr int kBall = 0;
/// The notes' rows are exact; the data are not: normals, radius and impulses rounded, a handful of
/// operations each.
constexpr double kTolerance = 1e-12;

std::string pair_text(const Vec3& v) {
  return fmt::format("({:.9g}, {:.9g})", v.x(), v.z());
}

class Rows {
 public:
  explicit Rows(SceneReport& report) : report_(report) {
    table_.title = "Velocity after the impulses, in units of s = 1 m/s";
    table_.header = {"how", "closed form", "computed", "error [m/s]", "T+ / T-", "note"};
  }

  void add(const std::string& how, const Vec3& computed, double x, double z,
           const std::string& note) {
    const Vec3 exact(x, 0.0, z);
    const double error = (computed - exact).norm();
    table_.rows.push_back({how, pair_text(exact), pair_text(computed), text(error),
                           text(computed.squaredNorm()), note});
    report_.checks.push_back(
        absolute({.name = how + ": distance from the closed form",
                  .unit = "m/s",
                  .reason = "the notes' row, exact; rounding of normals and a few operations"},
                 error, 0.0, kTolerance));
  }
  void show(const std::string& how, const Vec3& computed, const std::string& note) {
    table_.rows.push_back({how, "", pair_text(computed), "", text(computed.squaredNorm()), note});
  }
  void finish() { report_.tables.push_back(table_); }

 private:
  SceneReport& report_;
  Table table_;
};

/// Half of each single impulse at once: our reading of the scan.
Vec3 half_of_each(const Scene& scene, const ContactSet& contacts) {
  State state = scene.state;
  std::vector<double> impulses;
  for (const Contact& contact : contacts) {
    impulses.push_back(0.5 * single_impulse(scene.bodies, scene.state, contact).f_max);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    apply_impulse(scene.bodies, contacts[i], impulses[i], state);
  }
  return velocity(scene.bodies[kBall], state[kBall]).linear;
}

void add_rows(const Scene& scene, SceneReport& report) {
  const ContactSet contacts = touching_contacts(scene);
  if (contacts.size() != 2) {
    report.checks.push_back(absolute({.name = "touching contacts", .unit = "1"},
                                     static_cast<double>(contacts.size()), 2.0, 0.0));
    return;
  }
  const ContactSet first{contacts[0]};
  const ContactSet second{contacts[1]};
  const ContactSet plastic = with_restitution(contacts, 0.0);
  const auto v = [&](const ContactSet& set, const ImpactSettings& settings) {
    return impact(scene, set, settings).linear(scene, kBall);
  };
  const ImpactSettings once{.law = ImpactLaw::kSequentialOnce, .energy_safe = false};
  ImpactSettings repeated{.law = ImpactLaw::kSequentialRepeated, .energy_safe = false};
  Rows rows(report);
  rows.add("P0 alone", v(first, once), 1.0, 0.0, "leaves P1 penetrating");
  rows.add("P1 alone", v(second, once), -0.8, -0.6, "leaves P0 penetrating");
  rows.add("half of each (our reading of the scan)", half_of_each(scene, contacts), 0.1, -0.3,
           "still penetrates both");
  repeated.order = {0, 1};
  rows.add("sequential, repeated, P0 first", v(contacts, repeated), -0.6, 0.8,
           "all four conditions hold");
  repeated.order = {1, 0};
  rows.add("sequential, repeated, P1 first", v(contacts, repeated), 0.28, 0.96,
           "all four conditions hold: the order decides");
  const ImpactSettings newton{.law = ImpactLaw::kNewton, .energy_safe = false};
  rows.add("simultaneous, Newton, e = 1", v(contacts, newton), 0.0, 1.0, "energy kept");
  rows.add("simultaneous, Newton, e = 0", v(plastic, newton), 0.0, 0.0, "the object simply stops");
  rows.add("simultaneous, the notes' form, e = 1",
           v(contacts, {.law = ImpactLaw::kNotes, .energy_safe = false}), 0.0, 1.0, "");
  const ImpactOutcome safe = impact(scene, contacts, {.law = ImpactLaw::kNewton});
  rows.add("simultaneous, Newton, energy-safe, e = 1", safe.linear(scene, kBall), 0.0, 1.0,
           fmt::format("theta = {:g}", safe.report.theta.sum()));
  rows.finish();
}

}  // namespace

/// The rows of the notes, section 4, in units of s.
void check_wedge(const Scene& scene, const RunOptions& options, SceneReport& report) {
  if (options.signorini) add_rows(scene, report);
  const Runs runs = run_engines(scene, options, report);
  runs.for_each([&](const Track& track) {
    const Vec3 after = track.bodies[1][kBall].velocity.linear;
    const CheckText text{.name = "stepped: distance of v after the first step from (0, s)",
                         .engine = track.engine,
                         .unit = "m/s",
                         .reason =
                             "the same LCP inside a time step, to the solver's tolerance "
                             "times (1 + |q|), |q| < 2"};
    const double error = (after - Vec3(0.0, 0.0, 1.0)).norm();
    report.checks.push_back(
        track.engine == "signorini"
            ? absolute(text, error, 0.0, 3.0 * step_settings(scene).lcp.tolerance)
            : shown(text, error, 0.0));
  });
  report.plots.push_back(plot_over_time(
      "Height of the ball", "z [m]", runs,
      [](const Track& track, std::size_t k) { return track.bodies[k][kBall].pose.position.z(); },
      [](double t) { return t; }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
