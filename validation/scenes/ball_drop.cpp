#include <signorini/core/response/event_stepper.h>
#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/scene_contacts.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace signorini::validation {
namespace {

constexpr int kBall = 0;
constexpr double kFewest = 1e-3;  ///< apexes lower than this are not looked at, m

/// The drop in closed form: heights of the ball's lowest point above the plane.
struct Drop {
  double g;
  double e;
  double height;  ///< at the start, m

  [[nodiscard]] double impact_speed(int bounce) const {
    return std::sqrt(2.0 * g * height) * std::pow(e, bounce);
  }
  [[nodiscard]] double apex(int bounce) const { return height * std::pow(e, 2 * bounce); }
  /// When bounce number `bounce` (from 1) happens, s.
  [[nodiscard]] double impact_time(int bounce) const {
    double t = std::sqrt(2.0 * height / g);
    for (int k = 1; k < bounce; ++k) t += 2.0 * impact_speed(k) / g;
    return t;
  }
  [[nodiscard]] double apex_time(int bounce) const {
    return impact_time(bounce) + impact_speed(bounce) / g;
  }
  [[nodiscard]] double at(double t) const {
    if (t < impact_time(1)) return height - 0.5 * g * t * t;
    for (int k = 1; k < 10000; ++k) {
      const double flight = 2.0 * impact_speed(k) / g;
      if (flight < 1e-9) return 0.0;
      const double since = t - impact_time(k);
      if (since < flight) return impact_speed(k) * since - 0.5 * g * since * since;
    }
    return 0.0;
  }
};

Drop drop_of(const Scene& scene) {
  const Material material =
      pair(scene.colliders[0].material, scene.colliders[1].material, scene.rule);
  const double radius = std::get<collision::Sphere>(scene.colliders[0].shape).radius;
  return {scene.gravity.norm(), material.restitution, scene.state[kBall].x.z() - radius};
}

/// The bounces of a track: samples k where the ball goes down before and up after.
struct Bounce {
  std::size_t sample;  ///< the first with the velocity upwards
  double speed_before;
  double speed_after;
};

std::vector<Bounce> bounces_of(const Track& track) {
  std::vector<Bounce> bounces;
  for (std::size_t k = 1; k < track.size(); ++k) {
    const double before = track.bodies[k - 1][kBall].velocity.linear.z();
    const double after = track.bodies[k][kBall].velocity.linear.z();
    if (before < 0.0 && after > 0.0) bounces.push_back({k, -before, after});
  }
  return bounces;
}

/// The greatest height (lowest point of the ball) between two bounces of a track, m.
std::vector<double> apexes_of(const Track& track, double start_height) {
  std::vector<double> apexes;
  const double ground = track.bodies[0][kBall].pose.position.z() - start_height;
  const std::vector<Bounce> bounces = bounces_of(track);
  for (std::size_t b = 0; b < bounces.size(); ++b) {
    const std::size_t end = b + 1 < bounces.size() ? bounces[b + 1].sample : track.size();
    double apex = -std::numeric_limits<double>::infinity();
    bool complete = false;
    for (std::size_t k = bounces[b].sample; k < end; ++k) {
      const BodySample& ball = track.bodies[k][kBall];
      apex = std::max(apex, ball.pose.position.z() - ground);
      complete = complete || ball.velocity.linear.z() < 0.0;
    }
    if (complete) apexes.push_back(apex);
  }
  return apexes;
}

/// How far apex n may be off.
///
/// In flight the semi-implicit scheme keeps C = g z + v^2/2 - g h v/2. A bounce comes at a depth
/// delta in [0, s h], s the speed, as v+ = e s followed by z += h v+:
///
///     C+ = e^2 C- - (1 - e^2) g delta + e (1 - e) g h s / 2.
///
/// So one bounce puts the apex off by at most s h max(1 - e^2 - e (1 - e)/2, e (1 - e)/2), an error
/// that each later bounce multiplies by e^2. The highest point of the grid is up to g h^2/8 below
/// the parabola's, and s itself differs by O(g h) from the closed form's: g h^2 a bounce.
double apex_tolerance(const Drop& drop, double h, int bounce) {
  const double e = drop.e;
  const double early = 0.5 * e * (1.0 - e);
  const double late = 1.0 - e * e - early;
  double tolerance = 0.0;
  for (int k = 0; k < bounce; ++k) {
    tolerance =
        e * e * tolerance + drop.impact_speed(k) * h * std::max(early, late) + drop.g * h * h;
  }
  return tolerance;
}

void check_apexes(const Scene& scene, const Drop& drop, const Track& track, SceneReport& report) {
  const std::vector<double> apexes = apexes_of(track, drop.height);
  for (int n = 1; drop.apex(n) > kFewest && drop.apex_time(n) < track.time.back() && n <= 5; ++n) {
    const CheckText text{.name = fmt::format("apex {} above the plane", n),
                         .engine = track.engine,
                         .unit = "m",
                         .reason =
                             "e^(2n) H; a first-order scheme meets the plane up to one step "
                             "late: 2 v h a bounce, times e^2 at the next"};
    const double apex = n <= static_cast<int>(apexes.size())
                            ? apexes[n - 1]
                            : std::numeric_limits<double>::quiet_NaN();
    report.checks.push_back(
        track.engine == "signorini"
            ? absolute(text, apex, drop.apex(n), apex_tolerance(drop, scene.step, n))
            : shown(text, apex, drop.apex(n)));
  }
}

/// speed after / speed before of the first bounce: the law itself.
void check_restitution(const Drop& drop, const Track& track, SceneReport& report) {
  const std::vector<Bounce> bounces = bounces_of(track);
  if (bounces.empty()) return;
  const CheckText text{.name = "speed after / speed before the first bounce",
                       .engine = track.engine,
                       .reference = "restitution law",
                       .unit = "1",
                       .reason = "v+ = -e v- with v- of the step's start: a few roundings"};
  const double ratio = bounces.front().speed_after / bounces.front().speed_before;
  report.checks.push_back(track.engine == "signorini" ? absolute(text, ratio, drop.e, 1e-12)
                                                      : shown(text, ratio, drop.e));
}

void check_rest(const Drop& drop, const Scene& scene, const Track& track, SceneReport& report) {
  const double end = track.last(kBall).pose.position.z() - scene.state[kBall].x.z() + drop.height;
  const CheckText text{.name = "height at the end",
                       .engine = track.engine,
                       .unit = "m",
                       .reason =
                           "e = 0: the ball stays on the plane; overlap up to 1e-10 m is "
                           "tolerated by the projection, and h times the velocity's "
                           "tolerance by the step"};
  report.checks.push_back(track.engine == "signorini" ? absolute(text, end, 0.0, 1e-9)
                                                      : shown(text, end, 0.0));
}

/// The event-driven stepper from apex to apex, and, for e < 1, until the ball rests.
void check_events(const Scene& scene, const Drop& drop, SceneReport& report) {
  SceneContacts contacts(scene);
  EventStepper stepper(scene.bodies, contacts, {.gravity = scene.gravity});
  State state = scene.state;
  EventReport events;
  const double ground = scene.state[kBall].x.z() - drop.height;
  double now = 0.0;
  for (int n = 1; n <= 5 && drop.apex(n) > kFewest; ++n) {
    stepper.advance(state, drop.apex_time(n) - now, events);
    now = drop.apex_time(n);
    report.checks.push_back(absolute(
        {.name = fmt::format("event-driven: apex {} above the plane", n),
         .unit = "m",
         .reason = "e^(2n) H; the flight is exact, the contact time is found to 1e-9 of the ball"},
        state[kBall].x.z() - ground, drop.apex(n), 1e-6 * drop.apex(n)));
  }
  if (drop.e == 1.0) return;
  const double rest = std::sqrt(2.0 * drop.height / drop.g) * (1.0 + drop.e) / (1.0 - drop.e);
  state = scene.state;
  stepper.advance(state, 1.01 * rest, events);
  const bool rested = !events.events.empty() && events.events.back().kind == EventKind::kRest;
  const double time = rested ? events.events.back().time + events.events.back().skipped_seconds
                             : std::numeric_limits<double>::quiet_NaN();
  report.checks.push_back(absolute(
      {.name = "event-driven: infinitely many bounces end after",
       .unit = "s",
       .reason = "sqrt(2 H/g) (1 + e)/(1 - e); bounces below 5e-4 m/s are skipped, and their time "
                 "is added"},
      time, rest, 1e-6 * rest));
}

/// First apex at h, h/2, h/4, h/8.
Table convergence(const Scene& scene, const Drop& drop, const RunOptions& options) {
  Table table;
  table.title = "First apex against the step";
  table.header = {"step [s]", "apex [m]", "error [m]", "v h [m]"};
  for (const int division : {1, 2, 4, 8, 16}) {
    Scene finer = scene;
    finer.step = scene.step / division;
    const std::vector<double> apexes =
        apexes_of(run_ours(finer, step_settings(finer), options), drop.height);
    if (apexes.empty()) continue;
    table.rows.push_back({text(finer.step), text(apexes[0]), text(apexes[0] - drop.apex(1)),
                          text(drop.impact_speed(0) * finer.step)});
  }
  return table;
}

}  // namespace

/// Apex n is e^(2n) H; e = 0: at rest on the plane.
void check_ball_drop(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Drop drop = drop_of(scene);
  const Runs runs = run_engines(scene, options, report);
  runs.for_each([&](const Track& track) {
    if (drop.e > 0.0) {
      check_restitution(drop, track, report);
      check_apexes(scene, drop, track, report);
    } else if (drop.impact_time(1) < track.time.back()) {
      check_rest(drop, scene, track, report);
    }
  });
  if (options.signorini && options.studies && drop.e > 0.0) check_events(scene, drop, report);
  if (options.bullet && options.studies && drop.e > 0.0 && options.profile.name == "neutral") {
    const std::vector<double> apexes =
        apexes_of(run_theirs(scene, BulletProfile::bullet_default(), options), drop.height);
    if (!apexes.empty()) {
      report.checks.push_back(shown({.name = "apex 1 above the plane, Bullet's default profile",
                                     .engine = "bullet",
                                     .unit = "m",
                                     .reason = "what Bullet's defaults do"},
                                    apexes[0], drop.apex(1)));
    }
  }
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  if (options.signorini && options.studies && drop.e > 0.0) {
    report.tables.push_back(convergence(scene, drop, options));
  }
  const double ground = scene.state[kBall].x.z() - drop.height;
  report.plots.push_back(plot_over_time(
      "Height of the ball's lowest point", "height [m]", runs,
      [ground](const Track& track, std::size_t k) {
        return track.bodies[k][kBall].pose.position.z() - ground;
      },
      [&](double t) { return drop.at(t); }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
