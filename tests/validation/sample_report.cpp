#include "tests/validation/sample_report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>

namespace signorini::validation {
namespace {

constexpr double kGravity = 9.81;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Function = std::function<double(double)>;

Series sampled(const std::string& name, const std::string& engine, double duration, double step,
               const Function& y_of_t) {
  Series series{name, engine, {}, {}};
  const int steps = static_cast<int>(std::lround(duration / step));
  for (int i = 0; i <= steps; ++i) {
    series.x.push_back(i * step);
    series.y.push_back(y_of_t(i * step));
  }
  return series;
}

/// Height of the bottom of a ball dropped from h0 with restitution e.
double bounce_height(double t, double h0, double e) {
  double speed = std::sqrt(2.0 * kGravity * h0);
  double start = speed / kGravity;
  if (t < start) return h0 - 0.5 * kGravity * t * t;
  for (speed *= e; speed > 1e-3; speed *= e) {
    const double flight = 2.0 * speed / kGravity;
    if (t < start + flight) return speed * (t - start) - 0.5 * kGravity * (t - start) * (t - start);
    start += flight;
  }
  return 0.0;
}

/// m g h right after the bounces so far.
double bounce_energy(double t, double h0, double e) {
  double speed = std::sqrt(2.0 * kGravity * h0);
  double energy = kGravity * h0;
  double start = speed / kGravity;
  while (t >= start && speed > 1e-3) {
    speed *= e;
    energy *= e * e;
    start += 2.0 * speed / kGravity;
  }
  return energy;
}

Function noise(unsigned seed, double amplitude) {
  auto generator = std::make_shared<std::mt19937_64>(seed);
  return [generator, amplitude](double) {
    return amplitude * std::uniform_real_distribution<double>(-1.0, 1.0)(*generator);
  };
}

Check check(std::string name, std::string reference, std::string unit, double value,
            double expected, double tolerance, std::string reason) {
  Check result;
  result.name = std::move(name);
  result.engine = "signorini";
  result.reference = std::move(reference);
  result.unit = std::move(unit);
  result.value = value;
  result.expected = expected;
  result.error = std::abs(value - expected);
  result.tolerance = tolerance;
  result.error_kind = "absolute";
  result.reason = std::move(reason);
  result.verdict = judge(result.error, tolerance);
  return result;
}

/// What Bullet measures under the same name: shown, not judged.
Check bullets(const Check& ours, double value) {
  Check result = ours;
  result.engine = "bullet";
  result.value = value;
  result.error = std::abs(value - ours.expected);
  result.tolerance = 0.0;
  result.reason = "shown beside ours; no tolerance is owed";
  result.verdict = Verdict::kInformation;
  return result;
}

SceneReport scene(std::string name, std::string title, std::string description) {
  SceneReport result;
  result.command = "signorini-validate " + name + " --engine both --duration 5 --out report";
  result.source = "validation/scenes/" + name + ".sdf";
  result.name = std::move(name);
  result.title = std::move(title);
  result.description = std::move(description);
  result.settings = {
      "signorini: time stepping, step 1/1000 s, solver lemke, tolerance 1e-8, impact law: Newton",
      "bullet 3.24 (double), neutral profile: step 1/1000 s, sequential impulse, 50 iterations, "
      "contact processing threshold 0, split impulse threshold 0, restitution velocity threshold "
      "0, warm starting 0.85, sleeping off, friction and restitution multiplied"};
  result.signorini_seconds = 0.0123;
  result.bullet_seconds = 0.0089;
  return result;
}

/// A ball that bounces with e on a plane; a contact's force where it is down.
Playback::PlaybackTrack ball_track(const std::string& engine, double e) {
  Playback::PlaybackTrack track;
  track.engine = engine;
  constexpr double kFrame = 1.0 / 30.0;
  for (int k = 0; k <= 150; ++k) {
    Playback::Frame frame;
    frame.time = k * kFrame;
    const double height = bounce_height(frame.time, 1.0, e);
    frame.poses = {{{0.0, 0.0, 0.1 + height}, {1.0, 0.0, 0.0, 0.0}}};
    if (height < 0.02) frame.contacts = {{1, 0, {0.0, 0.0, 0.0}, {0.0, 0.0, kGravity}}};
    frame.all_contacts = frame.contacts.size();
    track.frames.push_back(frame);
  }
  return track;
}

Playback ball_playback(double e, double bullet_e) {
  Playback playback;
  playback.gravity = {0.0, 0.0, -kGravity};
  playback.bodies = {{"ground", "fixed", {}}, {"ball", "dynamic", {{0.0, 0.0, 1.1}}}};
  playback.shapes = {{"surface", 0, "half_space", {}, -1, {}},
                     {"shape", 1, "sphere", {0.1}, -1, {}}};
  playback.tracks = {ball_track("signorini", e), ball_track("bullet", bullet_e)};
  return playback;
}

/// Ours at two steps, Bullet in two profiles: one of Bullet's is cheaper than ours at its error.
Trade ball_trade() {
  return {.error = "apex height after the first bounce",
          .unit = "m",
          .reference = "closed form",
          .scale = 1.0,
          .duration = 5.0,
          .points = {{"Signorini, 1e-08", "signorini", 0.004, 3e-9, 0.012, 0.004},
                     {"Bullet, neutral, 50 iterations", "bullet", 0.004, 2e-4, 0.0008, -1.0},
                     {"Bullet, default, 10 iterations", "bullet", 0.004, 0.3, 0.0006, -1.0},
                     {"Signorini, 1e-08", "signorini", 0.001, 1e-9, 0.05, 0.016},
                     {"Bullet, neutral, 50 iterations", "bullet", 0.001, 1e-5, 0.003, -1.0},
                     {"Bullet, default, 10 iterations", "bullet", 0.001, kNaN, 0.002, -1.0}}};
}

SceneReport ball_drop(double e, double bullet_e) {
  SceneReport result = scene(
      fmt::format("ball-drop-e{}", e), fmt::format("Ball dropped, e = {}", e),
      "A ball of 1 kg and radius 0.1 m falls 1 m onto a fixed plane. Each bounce keeps e of the "
      "speed and e\u00b2 of the energy; the apex after the first bounce is e\u00b2 h. Bullet's "
      "default "
      "profile loses restitution to speculative contacts (v = e v\u207b \u2212 gap/dt).");
  result.playback = ball_playback(e, bullet_e);
  result.trade = ball_trade();
  const Check apex = check(
      "apex height after the first bounce", "closed form", "m", e * e * (1.0 + 3e-9), e * e, 1e-6,
      "e\u00b2 h; the contact time is found to 1e-9 s, which moves the apex by "
      "less than 1e-7 m");
  const Check energy = check("kinetic energy kept by the first bounce", "closed form", "1",
                             e * e + 2e-16, e * e, 1e-12, "e\u00b2, to rounding");
  result.checks = {apex, bullets(apex, bullet_e * bullet_e), energy,
                   bullets(energy, bullet_e * bullet_e)};
  result.plots = {
      {"Height of the ball's lowest point",
       "time [s]",
       "height [m]",
       false,
       {sampled("height", "closed form", 5, 0.005,
                [e](double t) { return bounce_height(t, 1, e); }),
        sampled("height", "signorini", 5, 0.001, [e](double t) { return bounce_height(t, 1, e); }),
        sampled("height", "bullet", 5, 0.001,
                [bullet_e](double t) { return bounce_height(t, 1, bullet_e); })}},
      {"Energy",
       "time [s]",
       "kinetic + potential energy [J]",
       false,
       {sampled("energy", "signorini", 5, 0.001, [e](double t) { return bounce_energy(t, 1, e); }),
        sampled("energy", "bullet", 5, 0.001,
                [bullet_e](double t) { return bounce_energy(t, 1, bullet_e); })}},
      {"Penetration",
       "time [s]",
       "penetration [m]",
       true,
       {sampled("penetration", "signorini", 5, 0.001, [](double) { return 0.0; }),
        sampled("penetration", "bullet", 5, 0.001, [bullet_e](double t) {
          const double height = bounce_height(t, 1, bullet_e);
          return height < 2e-3 ? 4e-3 * std::exp(-0.5 * t) : 0.0;
        })}}};
  return result;
}

SceneReport torque_free_spin() {
  SceneReport result = scene(
      "torque-free-spin", "Torque-free spin (Dzhanibekov)",
      "Inertia 1 : 2 : 3, |\u03c9| = 10 rad/s, 45\u00b0 off the middle axis, no forces. Kinetic "
      "energy "
      "and angular momentum are conserved; the angular velocity is given by Jacobi's elliptic "
      "functions. 100 s.");
  const Check energy = check("kinetic energy after 100 s, relative", "conservation law", "1",
                             1.0 + 4.1e-7, 1.0, 1e-5, "RK4 at 1/1000 s: O(h\u2074) times 100 s");
  const Check momentum =
      check("angular momentum after 100 s, relative", "conservation law", "1", 1.0 + 1.1e-14, 1.0,
            1e-12, "L is a state variable and has no torque");
  result.checks = {momentum, bullets(momentum, 1.08), energy, bullets(energy, 0.69)};
  const auto wobble = [](double phase, double amplitude) {
    return [phase, amplitude](double t) { return amplitude * std::sin(0.9 * t + phase); };
  };
  result.plots = {
      {"Angular velocity in the body frame",
       "time [s]",
       "\u03c9 [rad/s]",
       false,
       {sampled("\u03c9\u2081", "closed form", 100, 0.05, wobble(0.0, 7.0)),
        sampled("\u03c9\u2082", "closed form", 100, 0.05, wobble(1.6, 5.0)),
        sampled("\u03c9\u2081", "signorini", 100, 0.01, wobble(0.0, 7.0)),
        sampled("\u03c9\u2082", "signorini", 100, 0.01, wobble(1.6, 5.0)),
        sampled("\u03c9\u2081", "bullet", 100, 0.01,
                [&wobble](double t) { return wobble(0.02 * t, 7.0 * std::exp(-0.002 * t))(t); }),
        sampled("\u03c9\u2082", "bullet", 100, 0.01,
                [&wobble](double t) {
                  return wobble(1.6 + 0.02 * t, 5.0 * std::exp(-0.002 * t))(t);
                })}},
      {"Drift of the kinetic energy",
       "time [s]",
       "|T \u2212 T\u2080| / T\u2080",
       true,
       {sampled("energy drift", "signorini", 100, 0.01, [](double t) { return 4.1e-9 * t; }),
        sampled("energy drift", "bullet", 100, 0.01,
                [](double t) { return 1.0 - std::exp(-0.0037 * t); })}},
      {"Drift of the rotation from orthogonality",
       "time [s]",
       "|R\u1d40R \u2212 I|",
       true,
       {sampled("quaternion, normalised", "signorini", 100, 0.01,
                [](double t) { return 1e-16 * (1.0 + std::abs(std::sin(3.0 * t))); }),
        sampled("matrix, Gram-Schmidt", "signorini", 100, 0.01,
                [](double t) { return 2e-16 * (1.0 + std::abs(std::cos(2.0 * t))); })}}};
  result.signorini_seconds = 0.41;
  result.bullet_seconds = 0.22;
  return result;
}

SceneReport wedge() {
  SceneReport result =
      scene("wedge", "The wedge: sequential against simultaneous impulses",
            "A point of unit mass falls with (0, \u2212s) into a corner with the normals N\u2080 = "
            "(1, 1)/\u221a2 and "
            "N\u2081 = (\u22122, 1)/\u221a5, e = 1. Each impulse alone leaves the other contact "
            "penetrating; "
            "repeated to the end, the order decides; simultaneously the answer is (0, s).");
  result.source = "built in code: SDF cannot say it";
  result.checks = {
      check("simultaneous impulse, velocity", "closed form", "m/s", 2.2e-16, 0.0, 1e-12,
            "(0, s): solve A f = \u22122 d'\u207b; 1e-12 is 4500 roundings of numbers near 1"),
      check("P0 first, repeated to the end", "closed form", "m/s", 1.1e-16, 0.0, 1e-12,
            "(\u22123s/5, 4s/5)"),
      check("P1 first, repeated to the end", "closed form", "m/s", 0.0, 0.0, 1e-12,
            "(7s/25, 24s/25)")};
  result.tables = {
      {"Post-impulse velocities for s = 1",
       {"way", "v_x", "v_y", "d\u2080'", "d\u2081'", "energy", "valid"},
       {{"P0 alone", "1", "0", "0.7071", "\u22120.8944", "1", "no: penetrates P1"},
        {"P1 alone", "\u22120.8", "\u22120.6", "\u22120.9899", "0.4472", "1", "no: penetrates P0"},
        {"P0 first, repeated", "\u22120.6", "0.8", "0.1414", "0.8944", "1", "yes"},
        {"P1 first, repeated", "0.28", "0.96", "0.8768", "0.1789", "1", "yes"},
        {"half of each (the scan)", "0.1", "\u22120.3", "\u22120.1414", "\u22120.2236", "0.1",
         "no: penetrates both"},
        {"simultaneous", "0", "1", "0.7071", "0.4472", "1", "yes"}}}};
  result.signorini_seconds = 2.1e-5;
  result.bullet_seconds = -1.0;
  result.notices = {
      "Bullet was not run: a point mass without rotation is no rigid body of Bullet's."};
  return result;
}

SceneReport stack() {
  SceneReport result = scene(
      "stack-of-5-boxes", "Stack of 5 boxes",
      "Five cubes of 1 kg rest on each other. Nothing may move: each contact carries the weight "
      "above it. The penetration must stay below the projection's tolerance.");
  const Check force = check("force under the lowest box", "closed form", "N",
                            5 * kGravity * (1 + 1e-13), 5 * kGravity, 1e-9, "5 m g");
  const Check sink = check("deepest penetration", "closed form", "m", 1.4e-6, 0.0, 1e-6,
                           "slop of the position projection: 1e-6 m");
  Check drift = check("sideways drift of the top box in 5 s", "closed form", "m", kNaN, 0.0, 1e-9,
                      "by symmetry nothing moves sideways");
  drift.error = kNaN;
  drift.verdict = Verdict::kFail;
  result.checks = {force, bullets(force, 49.2), sink, bullets(sink, 3.1e-3), drift};
  const Function jitter = noise(7, 2e-4);
  result.plots = {
      {"Height of the top box above its rest",
       "time [s]",
       "height [m]",
       false,
       {sampled("top box", "signorini", 5, 0.001,
                [](double t) { return t < 3.2 ? 4.5 - 1.4e-6 * t : kNaN; }),
        sampled("top box", "bullet", 5, 0.001,
                [&jitter](double t) { return 4.5 - 3.1e-3 * (1 - std::exp(-t)) + jitter(t); })}},
      {"Natural residual of each step",
       "time [s]",
       "residual",
       true,
       {sampled("residual", "signorini", 5, 0.001,
                [n = noise(8, 1.0)](double t) {
                  return t < 3.2 ? std::pow(10.0, -14.5 + 0.7 * n(t)) : kNaN;
                }),
        sampled("residual", "bullet", 5, 0.001,
                [n = noise(9, 1.0)](double t) { return std::pow(10.0, -3.0 + 0.3 * n(t)); })}}};
  result.notices = {
      "signorini: the run ended at t = 3.2 s: step 3200 gave the status \"numerical breakdown\".",
      "ignored in the file: 5 <visual>, 1 <plugin name=\"physics|engine\">, 1 <gui>."};
  result.signorini_seconds = 0.92;
  result.bullet_seconds = 0.047;
  return result;
}

SceneReport slope(double degrees, bool sticks) {
  SceneReport result =
      scene(fmt::format("box-on-slope-{}-degrees-{}-the-friction-angle-of-26.565-degrees", degrees,
                        sticks ? "below" : "above"),
            fmt::format("Box on a slope of {}\u00b0, {} the friction angle", degrees,
                        sticks ? "below" : "above"),
            "A box on a slope, \u03bc = 0.5. Below the friction angle it must stick, above it it "
            "slides with "
            "g (sin \u03b1 \u2212 \u03bc cos \u03b1).");
  const double alpha = degrees * std::numbers::pi / 180.0;
  const double a = sticks ? 0.0 : kGravity * (std::sin(alpha) - 0.5 * std::cos(alpha));
  const Check way =
      check("way down the slope after 5 s", "closed form", "m", 12.5 * a + 3e-8, 12.5 * a, 1e-3,
            "a t\u00b2/2; the pyramid has 8 sides and one edge points down");
  result.checks = {way, bullets(way, 12.5 * a + 9.1e-4)};
  result.plots = {
      {"Way down the slope",
       "time [s]",
       "way [m]",
       false,
       {sampled("way", "closed form", 5, 0.01, [a](double t) { return 0.5 * a * t * t; }),
        sampled("way", "signorini", 5, 0.001, [a](double t) { return 0.5 * a * t * t + 1e-9 * t; }),
        sampled("way", "bullet", 5, 0.001,
                [a](double t) { return 0.5 * a * t * t + 1.8e-4 * t; })}}};
  return result;
}

SceneReport cradle() {
  SceneReport result = scene(
      "newtons-cradle", "Newton's cradle, five touching balls",
      "Five equal balls touch, the first is hit with v, e = 1. Newton's law has a closed form: "
      "(\u22123/5, 2/5, 2/5, 2/5, 2/5) v. It does not break away; the law that does comes later.");
  result.checks = {
      check("velocity of the first ball / v", "closed form", "1", -0.6, -0.6, 1e-12, "\u22123/5"),
      check("kinetic energy after / before", "conservation law", "1", 1.0 + 4e-16, 1.0, 1e-12,
            "e = 1")};
  result.checks.push_back(bullets(result.checks[0], -0.33));
  result.checks.push_back(bullets(result.checks[1], 1.2));
  result.plots = {{"Position along the cradle", "time [s]", "x [m]", false, {}}};
  const double ours[] = {-0.6, 0.4, 0.4, 0.4, 0.4};
  const double theirs[] = {-0.33, -0.07, -0.07, 0.73, 0.73};
  for (const auto& [engine, velocities] : {std::pair{"signorini", ours}, {"bullet", theirs}}) {
    for (int ball = 0; ball < 5; ++ball) {
      result.plots[0].series.push_back(sampled(fmt::format("ball {}", ball + 1), engine, 2, 0.002,
                                               [ball, v = velocities[ball]](double t) {
                                                 return 0.2 * ball + std::max(0.0, t - 0.5) * v;
                                               }));
    }
  }
  result.tables = {
      {"Velocities after the impact, in v",
       {"engine", "1", "2", "3", "4", "5", "energy after / before"},
       {{"closed form (Newton)", "\u22120.6", "0.4", "0.4", "0.4", "0.4", "1"},
        {"signorini", "\u22120.6", "0.4", "0.4", "0.4", "0.4", "1"},
        {"bullet, default", "\u22120.33", "\u22120.07", "\u22120.07", "0.73", "0.73", "1.20"},
        {"bullet, neutral", "\u22121/3", "0", "0", "2/3", "2/3", "1"}}}};
  return result;
}

SceneReport mass_ratio() {
  SceneReport result =
      scene("mass-ratio-1000", "1000 kg on 1 kg",
            "A block of 1000 kg rests on a block of 1 kg for 5 s. The lower block must not sink.");
  Check sink = check("deepest penetration", "closed form", "m", 8.8e-7, 0.0, 1e-6,
                     "slop of the position projection: 1e-6 m");
  result.checks = {sink, bullets(sink, 6e-4)};
  result.plots = {{"Penetration",
                   "time [s]",
                   "penetration [m]",
                   true,
                   {sampled("penetration", "signorini", 5, 0.001,
                            [](double t) { return 8.8e-7 * (1 - std::exp(-3 * t)); }),
                    sampled("penetration", "bullet", 5, 0.001,
                            [](double t) { return 6e-4 * (1 - std::exp(-2 * t)); })}}};
  return result;
}

SceneReport only_information() {
  SceneReport result = scene(
      "gz-sim_shapes", "Gazebo's shapes world, as it comes",
      "A scene of other people's without a closed form. It is run in both engines and compared by "
      "energy; a chaotic pile owes no agreement, so nothing is judged.");
  Check energy;
  energy.name = "energy after 5 s";
  energy.engine = "signorini";
  energy.reference = "bullet";
  energy.unit = "J";
  energy.value = 12.402;
  energy.expected = 12.377;
  energy.error = 0.025;
  energy.error_kind = "absolute";
  energy.reason = "two engines, neither of them the truth";
  result.checks = {energy};
  result.notices = {"ignored in the file: 5 <visual>, 4 <plugin>, 1 <light>, 1 <gui>."};
  result.plots = {{"Energy",
                   "time [s]",
                   "kinetic + potential energy [J]",
                   false,
                   {sampled("energy", "signorini", 5, 0.001, [](double) { return 12.402; }),
                    sampled("energy", "bullet", 5, 0.001, [](double t) {
                      return 12.377 + 0.1 * std::exp(-4 * t) * std::cos(30 * t);
                    })}}};
  return result;
}

SceneReport hostile_texts() {
  SceneReport result =
      scene("texts | with </script> & `markup`", "Texts with </script>, <!-- and | in them",
            "A name may hold </script><script>throw new Error('escaped badly')"
            "</script>, a | pipe, *stars*, _bars_, `ticks`, [links](x) and\na line "
            "break. None of it may do anything.");
  result.checks = {};
  result.notices = {"</script>", "<img src=x onerror=alert(1)>"};
  result.tables = {{"A | table", {"<b>a</b>", "b|c"}, {{"1|2", "</table>"}}}};
  result.settings.clear();
  result.signorini_seconds = -1.0;
  result.bullet_seconds = -1.0;
  return result;
}

SceneReport simple(const std::string& name, const std::string& title,
                   const std::string& description, double error, double tolerance,
                   double bullets_error) {
  SceneReport result = scene(name, title, description);
  const Check ours = check("largest error", "closed form", "m", error, 0.0, tolerance,
                           "derived from the step: 1/2 g h\u00b2 a step");
  result.checks = {ours, bullets(ours, bullets_error)};
  result.plots = {
      {"Error against the closed form",
       "time [s]",
       "error [m]",
       true,
       {sampled("error", "signorini", 5, 0.001, [error](double t) { return error * t / 5.0; }),
        sampled("error", "bullet", 5, 0.001,
                [bullets_error](double t) { return bullets_error * t / 5.0; })}}};
  return result;
}

}  // namespace

Report sample_report() {
  Report report;
  report.command = "signorini-validate --engine both --duration 5 --out report";
  report.version = "0.1.0";
  report.engines = "Bullet 3.24 (double), libsdformat 12.3.0";
  report.scenes = {
      simple(
          "free-flight", "Free flight",
          "A body thrown in a vacuum follows its parabola; semi-implicit Euler is off by g h t/2.",
          3.1e-13, 1e-12, 0.0245),
      torque_free_spin(),
      ball_drop(0.0, 0.0),
      ball_drop(0.5, 0.14),
      ball_drop(0.9, 0.44),
      ball_drop(1.0, 0.54),
      wedge(),
      simple("box-lands-flat", "Box landing flat",
             "A box lands flat on a plane without tangential velocity: it must not start to turn.",
             1e-15, 1e-12, 4.2),
      slope(20.0, true),
      slope(30.0, false),
      stack(),
      cradle(),
      simple("ball-between-two-opposite-walls", "Ball between two opposite walls",
             "Both walls touch the ball, e > 0: the Newton LCP is infeasible, and its ray says so. "
             "The energy-safe form answers.",
             0.0, 0.0, 0.31),
      mass_ratio(),
      only_information(),
      hostile_texts()};
  return report;
}

}  // namespace signorini::validation
