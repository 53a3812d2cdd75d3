#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace signorini::validation {
namespace {

/// How far the two poses of a body are apart: |dx| and the turn, rad.
struct Moved {
  double distance = 0.0;
  double turn = 0.0;
};

using MoveMeasure = std::function<Moved(const Track&, std::size_t)>;

Moved moved(const Pose& from, const Pose& to) {
  return {(to.position - from.position).norm(), from.orientation.angularDistance(to.orientation)};
}

/// What each body did.
void tabulate(const Scene& scene, const Runs& runs, const std::string& title,
              const MoveMeasure& measure, SceneReport& report) {
  Table table;
  table.title = title;
  table.header = {"body"};
  runs.for_each([&](const Track& track) {
    table.header.push_back(track.engine + ": distance [m]");
    table.header.push_back(track.engine + ": turn [rad]");
  });
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].is_dynamic()) continue;
    table.rows.push_back({scene.bodies[i].name});
    runs.for_each([&](const Track& track) {
      const Moved one = measure(track, i);
      table.rows.back().push_back(text(one.distance));
      table.rows.back().push_back(text(one.turn));
    });
  }
  report.tables.push_back(std::move(table));
}

Moved worst(const Scene& scene, const Track& track, const MoveMeasure& measure) {
  Moved most;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].is_dynamic()) continue;
    const Moved one = measure(track, i);
    most.distance = std::max(most.distance, one.distance);
    most.turn = std::max(most.turn, one.turn);
  }
  return most;
}

void judge(const Scene& scene, const Runs& runs, const std::string& name, double distance,
           double turn, const std::string& reason, const MoveMeasure& measure,
           SceneReport& report) {
  runs.for_each([&](const Track& track) {
    const Moved most = worst(scene, track, measure);
    const bool ours = track.engine == "signorini";
    const CheckText far{.name = name + ": greatest distance of a body",
                        .engine = track.engine,
                        .unit = "m",
                        .reason = reason};
    const CheckText turned{.name = name + ": greatest turn of a body",
                           .engine = track.engine,
                           .unit = "rad",
                           .reason = reason};
    report.checks.push_back(ours ? absolute(far, most.distance, 0.0, distance)
                                 : shown(far, most.distance, 0.0));
    report.checks.push_back(ours ? absolute(turned, most.turn, 0.0, turn)
                                 : shown(turned, most.turn, 0.0));
  });
  tabulate(scene, runs, name, measure, report);
}

}  // namespace

/// Nothing moves.
void check_resting_shapes(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  const auto farthest = [](const Track& track, std::size_t body) {
    Moved most;
    for (const std::vector<BodySample>& sample : track.bodies) {
      const Moved one = moved(track.bodies[0][body].pose, sample[body].pose);
      most.distance = std::max(most.distance, one.distance);
      most.turn = std::max(most.turn, one.turn);
    }
    return most;
  };
  const double t = scene.duration;
  const double q = scene.step * scene.gravity.norm();
  const double bound = step_settings(scene).lcp.tolerance * (1.0 + q) * t + 1e-8;
  judge(scene, runs, "from where they stood", bound, 10.0 * bound,
        "closed form: no motion; each step's velocities are solved to the tolerance times "
        "(1 + |q|), |q| = h g, distances of round shapes are found to 1e-8 of their size; the "
        "turn: over a "
        "tenth of a metre",
        farthest, report);
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  add_energy_and_overlap_plots(runs, report);
}

/// Each shape stops where it lands, unturned.
void check_landing_shapes(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  // All fall from one height: that of the first, whose lowest point is under its centre.
  const double fall = scene.state[0].x.z() - collision::bounding_radius(scene.colliders[0].shape,
                                                                        scene.colliders[0].local);
  const auto from_landing_place = [&scene, fall](const Track& track, std::size_t body) {
    Pose landed = scene.state[body].pose();
    landed.position.z() -= fall;
    return moved(landed, track.last(static_cast<int>(body)).pose);
  };
  const double speed = std::sqrt(2.0 * scene.gravity.norm() * fall);
  const double bound = step_settings(scene).lcp.tolerance * (1.0 + speed) * scene.duration + 1e-8;
  judge(scene, runs, "from where they must land", bound, 10.0 * bound,
        "closed form: restitution 0 and impulses through the centre; each step's velocities are "
        "solved to the tolerance times (1 + |q|), |q| the speed of the landing, distances of round "
        "shapes found to 1e-8 of their size; the turn: over a tenth of a metre",
        from_landing_place, report);
  runs.for_each([&](const Track& track) {
    double spin = 0.0;
    for (const std::vector<BodySample>& sample : track.bodies) {
      for (const BodySample& body : sample) spin = std::max(spin, body.velocity.angular.norm());
    }
    report.checks.push_back(shown({.name = "greatest spin of a body at any time",
                                   .engine = track.engine,
                                   .unit = "rad/s",
                                   .reason = "0 in closed form"},
                                  spin, 0.0));
  });
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
