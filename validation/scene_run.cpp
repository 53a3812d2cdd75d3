#include <signorini/validation/bullet_runner.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/event_runner.h>
#include <signorini/validation/scene_playback.h>
#include <signorini/validation/scene_run.h>
#include <signorini/validation/signorini_runner.h>

#include <fmt/format.h>

namespace signorini::validation {
namespace {

void append(const std::vector<std::string>& from, std::vector<std::string>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

std::string endings_text(const Track& track) {
  std::string line;
  for (const auto& [status, count] : track.endings) {
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", count, status);
  }
  return line;
}

void say_if_stopped(const Scene& scene, const Track& track, SceneReport& report) {
  if (!track.interrupted) return;
  report.notices.push_back(fmt::format("stopped: the run of {} ended after {} of {} steps",
                                       track.engine, track.steps, scene.step_count()));
}

void check_broken(const Track& track, SceneReport& report) {
  report.checks.push_back(at_most({.name = kBrokenRuns,
                                   .reference = "definition",
                                   .unit = "1",
                                   .reason = "no NaN and no infinity"},
                                  track.broke_down ? 1.0 : 0.0, 0.0));
}

void check_every_step(const Track& track, UnsolvedSteps unsolved, SceneReport& report) {
  report.settings.push_back(
      fmt::format("Signorini: {} steps: {}", track.steps, endings_text(track)));
  const CheckText text{.name = kUnsolvedSteps,
                       .reference = "certificate",
                       .unit = "1",
                       .reason = "every step's LCP must be certified" +
                                 (track.first_unsolved.empty()
                                      ? ""
                                      : "; the first that was not: " + track.first_unsolved)};
  const auto count = static_cast<double>(track.unsolved_steps);
  report.checks.push_back(unsolved == UnsolvedSteps::kFail ? at_most(text, count, 0.0)
                                                           : shown(text, count, 0.0));
  const CheckText projections{.name = "position projections that were not solved",
                              .reference = "certificate",
                              .unit = "1",
                              .reason = "without them overlap stays"};
  const auto failed = static_cast<double>(track.unsolved_projections);
  report.checks.push_back(unsolved == UnsolvedSteps::kFail ? at_most(projections, failed, 0.0)
                                                           : shown(projections, failed, 0.0));
  check_broken(track, report);
}

/// What the event-driven stepper met, and that it came to the end.
void report_events(const Scene& scene, const Track& track, SceneReport& report) {
  report.settings.push_back(
      fmt::format("Signorini: {} records: {}", track.steps, endings_text(track)));
  if (track.blind_pairs > 0) {
    report.notices.push_back(
        fmt::format("{} times a pair of bodies whose gap closed while its contacts separated was "
                    "passed over for 1e-5 s",
                    track.blind_pairs));
  }
  constexpr std::size_t kMostRows = 100;
  Table table;
  table.title =
      fmt::format("Events ({}{})", track.events.size(),
                  track.events.size() > kMostRows ? fmt::format(", the first {}", kMostRows) : "");
  table.header = {"time [s]", "event", "bodies", "speed [m/s]", "problem of the forces"};
  for (const Event& event : track.events) {
    if (table.rows.size() == kMostRows) break;
    table.rows.push_back({text(event.time), std::string(to_string(event.kind)),
                          scene.bodies[event.body_a].name + " / " + scene.bodies[event.body_b].name,
                          text(event.speed),
                          event.forces_status == lcp::Status::kNotRun
                              ? "-"
                              : std::string(lcp::to_string(event.forces_status))});
  }
  report.tables.push_back(std::move(table));
  report.checks.push_back(
      at_most({.name = kUnsolvedSteps,
               .reference = "certificate",
               .unit = "1",
               .reason = "every impact and every problem of resting forces must be certified" +
                         (track.first_unsolved.empty() ? "" : "; not: " + track.first_unsolved)},
              static_cast<double>(track.unsolved_steps), 0.0));
  check_broken(track, report);
}

bool runs_by_events(const Scene& scene, const RunOptions& options) {
  const Stepper without_choice = options.accuracy ? Stepper::kTime : scene.stepper;
  return options.stepper.value_or(without_choice) == Stepper::kEvents;
}

/// Our run, with what the report says of its settings and steps.
Track run_and_report_ours(const Scene& scene, const RunOptions& options, SceneReport& report,
                          UnsolvedSteps unsolved) {
  if (runs_by_events(scene, options)) {
    const EventSettings settings = event_settings(scene);
    append(describe(settings), report.settings);
    Track track = run_by_events(scene, settings, options.stop, options.watch);
    if (track.interrupted && !options.keep_stopped) throw RunInterrupted{};
    say_if_stopped(scene, track, report);
    report_events(scene, track, report);
    return track;
  }
  const TimeStepSettings settings = step_settings(scene);
  append(describe(settings), report.settings);
  if (options.accuracy) {
    report.settings.push_back("Signorini: accuracy " + options.accuracy->name());
  }
  Track track = run_ours(scene, settings, options);
  say_if_stopped(scene, track, report);
  check_every_step(track, unsolved, report);
  return track;
}

Series series_of(const Track& track, const Measure& measure) {
  Series series;
  series.name = track.engine;
  series.engine = track.engine;
  series.x = track.time;
  series.y.reserve(track.size());
  for (std::size_t k = 0; k < track.size(); ++k) series.y.push_back(measure(track, k));
  return series;
}

}  // namespace

RunOptions options_of(const RunArguments& arguments) {
  RunOptions options;
  options.signorini = arguments.engine != "bullet";
  options.bullet = arguments.engine != "signorini";
  options.duration = arguments.duration;
  options.profile = BulletProfile::named(arguments.bullet_profile);
  options.trade = arguments.trade;
  return options;
}

Track run_ours(const Scene& scene, const TimeStepSettings& settings, const RunOptions& options) {
  TimeStepSettings recorded = settings;
  recorded.lcp.recorder = options.recorder;
  if (options.accuracy) recorded.accuracy = options.accuracy;
  Track track = run_signorini(scene, recorded, options.stop, options.watch);
  if (track.interrupted && !options.keep_stopped) throw RunInterrupted{};
  return track;
}

Track run_theirs(const Scene& scene, const BulletProfile& profile, const RunOptions& options) {
  Track track = run_bullet(scene, profile, options.stop, options.watch);
  if (track.interrupted && !options.keep_stopped) throw RunInterrupted{};
  return track;
}

Runs run_engines(const Scene& scene, const RunOptions& options, SceneReport& report,
                 UnsolvedSteps unsolved) {
  Runs runs;
  report.settings.push_back(fmt::format("{:.9g} s in {} steps; pairing rule: {}", scene.duration,
                                        scene.step_count(), to_string(scene.rule)));
  append(describe_pairs(scene), report.settings);
  if (options.signorini) {
    runs.signorini = run_and_report_ours(scene, options, report, unsolved);
    report.signorini_seconds = runs.signorini->wall_seconds;
    report.signorini_solver_seconds = runs.signorini->solver_seconds;
  }
  if (options.bullet && !(runs.signorini && runs.signorini->interrupted)) {
    append(options.profile.describe(), report.settings);
    runs.bullet = run_theirs(scene, options.profile, options);
    report.bullet_seconds = runs.bullet->wall_seconds;
    say_if_stopped(scene, *runs.bullet, report);
    for (const std::string& remark : runs.bullet->remarks) {
      report.settings.push_back("Bullet: " + remark);
    }
    report.bullet_solver_seconds = runs.bullet->solver_seconds;
    if (runs.bullet->broke_down) {
      report.notices.push_back(fmt::format(
          "Bullet's run ended after {} steps: a number was no longer finite", runs.bullet->steps));
    }
  }
  if (scene.bodies.size() <= kMostPlayedBodies) {
    report.playback = make_playback(scene, runs);
  } else {
    report.notices.push_back(
        fmt::format("no playback: {} bodies, at most {}", scene.bodies.size(), kMostPlayedBodies));
  }
  return runs;
}

Plot plot_over_time(const std::string& title, const std::string& y_label, const Runs& runs,
                    const Measure& measure, const std::function<double(double)>& closed_form) {
  Plot plot;
  plot.title = title;
  plot.x_label = "time [s]";
  plot.y_label = y_label;
  runs.for_each([&](const Track& track) { plot.series.push_back(series_of(track, measure)); });
  if (closed_form && !plot.series.empty()) {
    Series exact;
    exact.name = "closed form";
    exact.engine = "closed form";
    exact.x = plot.series.front().x;
    for (const double t : exact.x) exact.y.push_back(closed_form(t));
    plot.series.push_back(std::move(exact));
  }
  return plot;
}

void add_energy_and_overlap_plots(const Runs& runs, SceneReport& report) {
  report.plots.push_back(
      plot_over_time("Kinetic and potential energy", "energy [J]", runs,
                     [](const Track& track, std::size_t k) { return track.energy(k); }));
  report.plots.push_back(
      plot_over_time("Deepest overlap", "overlap [m]", runs,
                     [](const Track& track, std::size_t k) { return track.overlap[k]; }));
}

std::string text(double value) {
  return fmt::format("{:.9g}", value);
}

std::string text(const Vec3& value) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", value.x(), value.y(), value.z());
}

}  // namespace signorini::validation
