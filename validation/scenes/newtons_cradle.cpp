#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/impact_cases.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace signorini::validation {
namespace {

using Speeds = std::vector<double>;

/// (-3/5, 2/5, ..., 2/5) v for n balls: (2/n - 1, 2/n, ...) v.
Speeds newton_speeds(std::size_t n, double v) {
  Speeds speeds(n, 2.0 * v / static_cast<double>(n));
  speeds[0] -= v;
  return speeds;
}

Speeds break_away_speeds(std::size_t n, double v) {
  Speeds speeds(n, 0.0);
  speeds[n - 1] = v;
  return speeds;
}

double distance(const Speeds& a, const Speeds& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

Speeds speeds_of(const Scene& scene, const ImpactOutcome& outcome) {
  Speeds speeds;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    speeds.push_back(outcome.linear(scene, static_cast<int>(i)).x());
  }
  return speeds;
}

Speeds speeds_of(const std::vector<BodySample>& sample) {
  Speeds speeds;
  for (const BodySample& body : sample) speeds.push_back(body.velocity.linear.x());
  return speeds;
}

class Rows {
 public:
  Rows() {
    table_.title = "Speeds after the impact [m/s]";
    table_.header = {"how", "ball 1", "ball 2", "ball 3", "ball 4", "ball 5", "T+ / T-", "note"};
  }
  void add(const std::string& how, const Speeds& speeds, const std::string& note) {
    std::vector<std::string> row{how};
    double energy = 0.0;
    for (const double v : speeds) {
      row.push_back(fmt::format("{:.6g}", v));
      energy += v * v;
    }
    row.push_back(text(energy));
    row.push_back(note);
    table_.rows.push_back(row);
  }
  [[nodiscard]] const Table& table() const { return table_; }

 private:
  Table table_;
};

void check_law(const Scene& scene, const ContactSet& contacts, const std::string& name,
               const ImpactSettings& settings, const Speeds& exact, const std::string& form,
               Rows& rows, SceneReport& report) {
  const ImpactOutcome outcome = impact(scene, contacts, settings);
  const Speeds speeds = speeds_of(scene, outcome);
  rows.add("Signorini: " + name, speeds, describe_status(outcome.report));
  const std::string reason = "four contacts, solved to 1e-12 (1 + |q|), |q| = 2";
  report.checks.push_back(absolute(
      {.name = name + ": speeds, distance from the " + form, .unit = "m/s", .reason = reason},
      distance(speeds, exact), 0.0, 3e-12));
  report.checks.push_back(absolute({.name = name + ": energy, relative change",
                                    .reference = "conservation law",
                                    .unit = "1",
                                    .reason = "e = 1 keeps the energy here; twice the speeds' "
                                              "tolerance"},
                                   outcome.energy_gain(), 0.0, 6e-12));
}

}  // namespace

/// Newton's law, all four contacts at once: (-3/5, 2/5, 2/5, 2/5, 2/5) v.
void check_newtons_cradle(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const double v = velocity(scene.bodies[0], scene.state[0]).linear.x();
  const Speeds exact = newton_speeds(scene.bodies.size(), v);
  Rows rows;
  rows.add("Newton law, closed form", exact, "");
  rows.add("steel balls (break-away)", break_away_speeds(scene.bodies.size(), v),
           "takes a law with break-away: the reflections");
  if (options.signorini) {
    const ContactSet contacts = touching_contacts(scene);
    check_law(scene, contacts, "Newton law", {.law = ImpactLaw::kNewton, .energy_safe = false},
              exact, "Newton closed form", rows, report);
    check_law(scene, contacts, "Newton law, energy-safe", {.law = ImpactLaw::kNewton}, exact,
              "Newton closed form", rows, report);
    check_law(scene, contacts, "Poisson's law", {.law = ImpactLaw::kPoisson}, exact,
              "Newton closed form", rows, report);
    check_law(scene, contacts, "generalized reflections", {.law = ImpactLaw::kReflections},
              break_away_speeds(scene.bodies.size(), v), "break-away (0, 0, 0, 0, v)", rows,
              report);
    const ImpactOutcome notes = impact(scene, contacts, {.law = ImpactLaw::kNotes});
    rows.add("Signorini: the notes' form, energy-safe", speeds_of(scene, notes),
             describe_status(notes.report));
    const ImpactOutcome sequential =
        impact(scene, contacts, {.law = ImpactLaw::kSequentialRepeated, .energy_safe = false});
    rows.add("Signorini: sequential, repeated", speeds_of(scene, sequential),
             "the order of the contacts is that of the balls, so the blow is passed on");
  }
  const Runs runs = run_engines(scene, options, report);
  runs.for_each([&](const Track& track) {
    const Speeds speeds = speeds_of(track.bodies.back());
    rows.add((track.engine == "signorini" ? "Signorini" : "Bullet") + std::string(": stepped"),
             speeds, track.engine == "bullet" ? "profile " + options.profile.name : "");
    const CheckText text{
        .name = "stepped: speeds at the end, distance from the Newton closed form",
        .engine = track.engine,
        .unit = "m/s",
        .reason =
            "the same law inside a time step, solved to its tolerance times (1 + |q|), |q| = 2"};
    report.checks.push_back(
        track.engine == "signorini"
            ? absolute(text, distance(speeds, exact), 0.0, 3.0 * step_settings(scene).lcp.tolerance)
            : shown(text, distance(speeds, exact), 0.0));
  });
  if (options.bullet && options.profile.name == "neutral") {
    const Track track = run_theirs(scene, BulletProfile::bullet_default(), options);
    rows.add("Bullet: stepped", speeds_of(track.bodies.back()), "profile default");
  }
  report.tables.push_back(rows.table());
  for (const std::size_t ball : {std::size_t{0}, scene.bodies.size() - 1}) {
    report.plots.push_back(plot_over_time(
        fmt::format("Position of ball {}", ball + 1), "x [m]", runs,
        [ball](const Track& track, std::size_t k) {
          return track.bodies[k][ball].pose.position.x();
        },
        [&](double t) { return scene.state[ball].x.x() + exact[ball] * t; }));
  }
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
