#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace signorini::validation {
namespace {

constexpr int kTop = 0;

/// The greatest |E(t)/E(0) - 1| of a track.
double energy_drift(const Track& track) {
  double worst = 0.0;
  for (const double T : track.kinetic) {
    worst = std::max(worst, std::abs(T / track.kinetic[0] - 1.0));
  }
  return worst;
}

Vec3 angular_momentum(const Scene& scene, const BodySample& sample) {
  const Mat3 R = sample.pose.orientation.toRotationMatrix();
  return R * scene.bodies[kTop].inertia * R.transpose() * sample.velocity.angular;
}

/// The greatest |L(t) - L(0)| / |L(0)|.
double momentum_drift(const Scene& scene, const Track& track) {
  const Vec3 start = angular_momentum(scene, track.bodies.front()[kTop]);
  double worst = 0.0;
  for (const std::vector<BodySample>& sample : track.bodies) {
    worst = std::max(worst, (angular_momentum(scene, sample[kTop]) - start).norm());
  }
  return worst / start.norm();
}

std::string name(const TimeStepSettings& settings) {
  const bool quaternion = settings.orientation == OrientationScheme::kQuaternion;
  return fmt::format("{}, {}", integrator_name(settings.integrator),
                     quaternion ? "quaternion" : "rotation matrix");
}

std::string percent(double value) {
  return fmt::format("{:.3g}", value);
}

/// Runs one scheme at the scene's step and at half of it. @return the run at the scene's step
Track try_scheme(const Scene& scene, const RunOptions& options, const TimeStepSettings& settings,
                 Table& table, SceneReport& report) {
  const Track track = run_ours(scene, settings, options);
  Scene finer_scene = scene;
  finer_scene.step = 0.5 * scene.step;
  TimeStepSettings finer_settings = settings;
  finer_settings.step = finer_scene.step;
  const Track finer = run_ours(finer_scene, finer_settings, options);
  const double drift = energy_drift(track);
  const double momentum = momentum_drift(scene, track);
  const double order = std::log2(drift / energy_drift(finer));
  table.rows.push_back({"Signorini: " + name(settings), percent(drift),
                        percent(energy_drift(finer)), fmt::format("{:.2f}", order),
                        percent(momentum)});

  // L is a variable of the state that no torque changes; what the measure sees is the rounding of
  // L -> w -> L, a few operations of 3 x 3 matrices.
  report.checks.push_back(absolute({.name = name(settings) + ": relative drift of |L|",
                                    .reference = "conservation law",
                                    .unit = "1",
                                    .reason = "L is integrated and no torque acts: rounding"},
                                   momentum, 0.0, 1e-12));
  if (settings.integrator == Integrator::kEnergyMomentum) {
    report.checks.push_back(
        absolute({.name = name(settings) + ": relative drift of the energy",
                  .reference = "conservation law",
                  .unit = "1",
                  .reason = "the midpoint rule keeps the energy to rounding; 1e-6 is what the "
                            "default stepper promises over 100 s at 1/240"},
                 drift, 0.0, 1e-6));
    return track;
  }
  if (settings.integrator != Integrator::kRungeKutta4) {
    report.checks.push_back(
        shown({.name = name(settings) + ": relative drift of the energy",
               .reference = "conservation law",
               .unit = "1",
               .reason = "a first-order scheme drifts by O(w h) each turn: shown, not judged"},
              drift, 0.0));
    return track;
  }
  const double spin = velocity(scene.bodies[kTop], scene.state[kTop]).angular.norm();
  const double wh = spin * scene.step;
  const double bound = spin * scene.duration * std::pow(wh, 4) / 120.0;
  report.checks.push_back(absolute(
      {.name = name(settings) + ": relative drift of the energy",
       .reference = "conservation law",
       .unit = "1",
       .reason = "fourth order: (w h)^5/120 a step is the Taylor remainder of a turn by w h, and "
                 "they add up"},
      drift, 0.0, bound));
  report.checks.push_back(
      at_most({.name = name(settings) + ": order of the energy drift, below 4 by",
               .reference = "order of the scheme",
               .unit = "1",
               .reason = "halving the step divides the drift of RK4 by 2^4 or more; 0.25 for the "
                         "terms of the next order"},
              4.0 - order, 0.25));
  return track;
}

}  // namespace

/// Energy and angular momentum are constant.
void check_torque_free_spin(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  runs.for_each([&](const Track& track) {
    const CheckText text{.name = "relative drift of the energy",
                         .engine = track.engine,
                         .reference = "conservation law",
                         .unit = "1",
                         .reason =
                             "no torque acts; 1e-6 is what the default stepper promises over "
                             "100 s at 1/240"};
    const double drift = energy_drift(track);
    report.checks.push_back(track.engine == "signorini" ? absolute(text, drift, 0.0, 1e-6)
                                                        : shown(text, drift, 0.0));
  });
  Plot plot = plot_over_time("Rotational energy", "energy [J]", {},
                             [](const Track& track, std::size_t k) { return track.kinetic[k]; });
  if (runs.bullet) {
    plot.series.push_back({"Bullet", "bullet", runs.bullet->time, runs.bullet->kinetic});
  }
  Table table;
  table.title = "Drift of the orientation schemes";
  table.header = {"scheme", "energy drift at h", "energy drift at h/2", "order", "drift of |L|"};
  if (options.signorini && options.studies) {
    for (const Integrator integrator :
         {Integrator::kEnergyMomentum, Integrator::kRungeKutta4, Integrator::kSemiImplicit}) {
      for (const OrientationScheme orientation :
           {OrientationScheme::kQuaternion, OrientationScheme::kRotationMatrix}) {
        TimeStepSettings settings = step_settings(scene);
        settings.integrator = integrator;
        settings.orientation = orientation;
        const Track track = try_scheme(scene, options, settings, table, report);
        plot.series.push_back(
            {"Signorini: " + name(settings), "signorini", track.time, track.kinetic});
      }
    }
  }
  if (options.bullet && options.studies) {
    for (const auto& [gyroscopic, label] :
         {std::pair{BulletGyroscopic::kImplicitBody, "implicit gyroscopic torque (its default)"},
          std::pair{BulletGyroscopic::kExplicit, "explicit gyroscopic torque"},
          std::pair{BulletGyroscopic::kNone, "no gyroscopic torque"}}) {
      BulletProfile profile = options.profile;
      profile.gyroscopic = gyroscopic;
      const Track track = run_theirs(scene, profile, options);
      const double last = track.kinetic.back() / track.kinetic[0] - 1.0;
      table.rows.push_back({std::string("Bullet: ") + label, percent(energy_drift(track)), "", "",
                            percent(momentum_drift(scene, track))});
      report.checks.push_back(shown({.name = std::string(label) + ": energy at the end, change",
                                     .engine = "bullet",
                                     .reference = "conservation law",
                                     .unit = "1",
                                     .reason = "what Bullet does"},
                                    last, 0.0));
    }
  }
  report.tables.push_back(table);
  const double energy = kinetic_energy(scene.bodies, scene.state);
  plot.series.push_back({"closed form", "closed form", {0.0, scene.duration}, {energy, energy}});
  report.plots.push_back(plot);
}

}  // namespace signorini::validation
