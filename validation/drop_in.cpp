#include <signorini/integrations/bullet/example_scenes/drop_in_run.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/drop_in.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace signorini::validation {
namespace {

constexpr DropInScene kScenes[] = {
    {"drop-in-stack", "stack", "Drop-in: Bullet's stack of 30 cubes", 10.0, true},
    {"drop-in-wall", "wall", "Drop-in: Bullet's wall of bricks", 1.0, true},
    {"drop-in-wall-hit", "wall-hit", "Drop-in: Bullet's wall, hit by a ball", 0.5, false},
    {"drop-in-ragdoll", "ragdoll", "Drop-in: Bullet's ragdoll falls", 3.0, false},
    {"drop-in-vehicle", "vehicle", "Drop-in: Bullet's vehicle on four sprung wheels", 3.0, false},
};

struct Timed {
  bullet::DropInRun run;
  double seconds;
};

Timed run_timed(const DropInScene& scene, const bullet::DropInSolver& solver,
                const RunOptions& options) {
  const auto stopped = [&options] { return options.stop != nullptr && options.stop->load(); };
  const auto start = std::chrono::steady_clock::now();
  Timed timed{bullet::run_drop_in(std::string(scene.example), solver,
                                  options.duration.value_or(scene.seconds), stopped),
              0.0};
  timed.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (stopped()) throw RunInterrupted{};
  return timed;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double most(const std::vector<double>& values) {
  double found = 0.0;
  for (const double value : values) {
    if (!(value <= found)) found = value;  // NaN stays
    if (std::isnan(value)) break;
  }
  return found;
}

void add_series(Plot& plot, const std::string& engine, const bullet::DropInRun& run,
                const std::vector<double>& values) {
  plot.series.push_back({.name = engine == "signorini" ? "Bullet with Signorini inside" : "Bullet",
                         .engine = engine,
                         .x = run.time,
                         .y = values});
}

Plot over_time(const std::string& title, const std::string& y_label) {
  Plot plot;
  plot.title = title;
  plot.x_label = "time [s]";
  plot.y_label = y_label;
  return plot;
}

/// The checks of one run. Ours are judged, Bullet's shown.
void check(const DropInScene& scene, const std::string& engine, const bullet::DropInRun& run,
           SceneReport& report) {
  const auto add = [&](CheckText text, double value, double bound) {
    text.engine = engine;
    report.checks.push_back(engine == "signorini" ? at_most(text, value, bound)
                                                  : shown(text, value, 0.0));
  };
  if (scene.must_stand) {
    // 600 steps of double rounding on coordinates of up to 30 m come to 600 * 30 * 1e-16 = 2e-12
    // m; an answer certified to 1e-8 |q|, |q| = g h, may leave 1.6e-9 m/s for 10 s.
    add({.name = "farthest that a body moved",
         .reference = "closed form: nothing moves",
         .unit = "m",
         .reason = "velocities certified to 1e-8 g h for the whole run: 1.6e-8 m, ten times that"},
        most(run.moved), 2e-7);
  }
  add({.name = "joint anchors apart at the end",
       .reference = "definition",
       .unit = "m",
       .reason = "erp takes a fifth of the error a step; a limb turning at w drifts w^2 r dt^2/2 a "
                 "step: 1 mm at 7 rad/s, 1 m"},
      run.joint_error.empty() ? 0.0 : run.joint_error.back(), 5e-3);
  report.checks.push_back(
      shown({.name = "deepest overlap", .engine = engine, .unit = "m"}, most(run.overlap), 0.0));
}

void check_answers(const bullet::DropInRun& run, SceneReport& report) {
  const bullet::Counters& counters = run.counters;
  report.checks.push_back(at_most({.name = "islands that were not solved",
                                   .reference = "certificate",
                                   .unit = "1",
                                   .reason = "every island of every step must be certified"},
                                  static_cast<double>(counters.not_solved()), 0.0));
  const bool finite = std::isfinite(most(run.moved)) && std::isfinite(most(run.kinetic_energy));
  report.checks.push_back(at_most({.name = "runs that ended with a number that is not finite",
                                   .reference = "definition",
                                   .unit = "1",
                                   .reason = "no NaN and no infinity"},
                                  finite ? 0.0 : 1.0, 0.0));
  report.settings.push_back(fmt::format(
      "Signorini inside Bullet: {} islands; {} still had the last step's impulses as an answer, {} "
      "without slip, {} without friction rows, {} coupled",
      counters.islands, counters.count(bullet::Route::kUnchanged),
      counters.count(bullet::Route::kSticking), counters.count(bullet::Route::kBounds),
      counters.count(bullet::Route::kCoupled)));
}

}  // namespace

std::span<const DropInScene> drop_in_scenes() {
  return kScenes;
}

const DropInScene* find_drop_in_scene(std::string_view name) {
  const auto* found = std::ranges::find(kScenes, name, &DropInScene::name);
  return found == std::end(kScenes) ? nullptr : found;
}

SceneReport validate_drop_in(const DropInScene& scene, const RunOptions& options) {
  SceneReport report;
  report.name = scene.name;
  report.title = scene.title;
  report.description =
      "Bullet runs one of its own example scenes twice: with its sequential impulses, and with "
      "signorini::bullet::ConstraintSolver in their place, one line changed. Collision detection, "
      "joints and integration are Bullet's in both.";
  report.source = "built in code: integrations/bullet/example_scenes";
  report.text = fmt::format("<!-- {}, {} -->\n", scene.name, report.source);
  report.builtin = true;
  report.settings.push_back("Bullet, double precision, its defaults, dt 1/60 s, sleeping off");
  Plot moved = over_time("Farthest that a body is from its start", "distance [m]");
  Plot energy = over_time("Kinetic energy", "energy [J]");
  Plot overlap = over_time("Deepest overlap", "overlap [m]");
  const auto take = [&](const std::string& engine, const Timed& timed) {
    add_series(moved, engine, timed.run, timed.run.moved);
    add_series(energy, engine, timed.run, timed.run.kinetic_energy);
    add_series(overlap, engine, timed.run, timed.run.overlap);
    check(scene, engine, timed.run, report);
  };
  if (options.signorini) {
    const Timed timed =
        run_timed(scene, bullet::ours(bullet::FrictionModel::kCone, options.recorder), options);
    report.signorini_seconds = timed.seconds;
    report.signorini_solver_seconds = sum(timed.run.solver_seconds);
    check_answers(timed.run, report);
    take("signorini", timed);
  }
  if (options.bullet) {
    const Timed timed = run_timed(scene, bullet::bullet_si(options.profile.iterations), options);
    report.bullet_seconds = timed.seconds;
    report.bullet_solver_seconds = sum(timed.run.solver_seconds);
    report.settings.push_back(fmt::format("Bullet's own solver: sequential impulses, {} iterations",
                                          options.profile.iterations));
    take("bullet", timed);
  }
  report.plots = {std::move(moved), std::move(energy), std::move(overlap)};
  return report;
}

}  // namespace signorini::validation
