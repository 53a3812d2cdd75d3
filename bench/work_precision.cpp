#include "bench/work_precision.h"

#include <signorini/collision/collision_world.h>

#include "bench/impact_scenes.h"
#include "bench/thread_time.h"
#ifdef SIGNORINI_HAS_CLP
#include "bench/limit_study.h"
#endif

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <ostream>

namespace signorini::bench {
namespace {

constexpr int kLooks = 20;  // at the overlap, which costs a collision query

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double deepest_overlap(const State& state, collision::CollisionWorld& world) {
  ContactSet contacts;
  world.find(state, 0.0, contacts);
  double depth = 0.0;
  for (const Contact& contact : contacts) {
    depth = std::max(depth, -contact.gap);
  }
  return depth;
}

/// How long a contestant's run lasts, s.
double seconds_of(const SteppedScene& scene, const Contestant& contestant,
                  const WorkPrecisionOptions& options) {
  if (scene.error) {
    return scene.seconds;
  }
  if (!contestant.is_ours) {
    return std::min(options.bullet_seconds, scene.seconds);
  }
  return options.seconds > 0.0 ? options.seconds : scene.seconds;
}

WorkPrecisionRow run(const SteppedScene& scene, const Contestant& contestant, double seconds) {
  WorkPrecisionRow row{.scene = scene.name,
                       .name = contestant.name,
                       .is_ours = contestant.is_ours,
                       .seconds = seconds,
                       .error_name = scene.error_name};
  collision::CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  const std::unique_ptr<ScenePlayer> player = contestant.start(scene);
  const int steps = std::max(1, static_cast<int>(std::lround(seconds / scene.step)));
  const int first_second = std::max(1, static_cast<int>(std::lround(1.0 / scene.step)));
  const int look = std::max(1, steps / kLooks);
  Course course{{player->poses(), player->velocities()}};
  std::vector<double> times;
  times.reserve(steps);
  for (int k = 0; k < steps; ++k) {
    const double start = thread_seconds();
    player->step();
    if (contestant.is_ours || scene.error || k < first_second) {
      times.push_back(1e3 * (thread_seconds() - start));
    }
    const State poses = player->poses();
    if (scene.error) {
      course.push_back({poses, player->velocities()});
    } else {
      const Vec3 path = scene.path ? scene.path((k + 1) * scene.step) : Vec3(Vec3::Zero());
      const Vec3 moved = poses[scene.watched].x - scene.state[scene.watched].x;
      row.error = std::max(row.error, (moved - path).norm());
    }
    if (k % look == look - 1 || k == steps - 1) {
      row.penetration = std::max(row.penetration, deepest_overlap(poses, world));
    }
  }
  row.error = scene.error ? scene.error(course) : row.error;
  row.milliseconds = median(times);
  row.residual = player->worst_residual();
  row.unsolved = player->unsolved_steps();
  return row;
}

void print(const WorkPrecisionRow& row, std::ostream& out) {
  out << fmt::format("{:28}{:8.1f}{:10.3f}{:16.1e}{:14.1e}{:>12}{:>10}\n", row.name, row.seconds,
                     row.milliseconds, row.error, row.penetration,
                     std::isnan(row.residual) ? "-" : fmt::format("{:.1e}", row.residual),
                     row.is_ours ? fmt::format("{}", row.unsolved) : "-");
  out.flush();
}

}  // namespace

bool WorkPrecisionReport::passed() const {
  return std::all_of(rows.begin(), rows.end(),
                     [](const WorkPrecisionRow& row) { return !row.is_ours || row.unsolved == 0; });
}

std::string WorkPrecisionReport::to_csv() const {
  std::string csv =
      "scene,engine,seconds,ms a step,error of,error,penetration m,residual,unsolved\n";
  for (const WorkPrecisionRow& row : rows) {
    csv += fmt::format("\"{}\",\"{}\",{},{:.4f},\"{}\",{:.3e},{:.3e},{:.3e},{}\n", row.scene,
                       row.name, row.seconds, row.milliseconds, row.error_name, row.error,
                       row.penetration, row.residual, row.unsolved);
  }
  return csv;
}

std::vector<SteppedScene> work_precision_scenes() {
  constexpr double kStep = 1.0 / 60.0;
  std::vector<SteppedScene> scenes{
      stack_scene(100, kStep, 60.0),  stack_scene(100, 1.0 / 240.0, 60.0),
      pyramid_scene(20, kStep, 10.0), heavy_scene(1e3, kStep, 10.0),
      heavy_scene(1e6, kStep, 10.0),  heavy_scene(1e9, kStep, 10.0),
      slope_scene(0.45, kStep, 2.0),  slope_scene(1.0, kStep, 2.0),
      rolling_scene(kStep, 2.0)};
#ifdef SIGNORINI_HAS_CLP
  for (const Masonry& structure : masonry_scenes()) {
    scenes.push_back(structure(1.05 * critical_friction(structure(1.0)).friction));
  }
#endif
  for (const double e : {0.0, 0.5, 1.0}) {
    scenes.push_back(landing_scene(e, kStep));
  }
  scenes.push_back(cradle_scene(kStep));
  for (const double e : {0.5, 0.9, 1.0}) {
    scenes.push_back(bounce_scene(e, kStep));
  }
  scenes.push_back(elastic_balls_scene(6, kStep));
  return scenes;
}

std::vector<Contestant> work_precision_contestants() {
  std::vector<Contestant> all;
  for (const char* position : {"preview", "game", "engineering", "reference"}) {
    TimeStepSettings settings;
    settings.accuracy = Accuracy::named(position);
    all.push_back(our_stepper(std::string("signorini, ") + position, settings));
  }
  all.push_back(our_event_stepper());
#ifdef SIGNORINI_PEER_BULLET
  for (const int iterations : {10, 50, 200, 1000}) {
    all.push_back(bullet_stepper(iterations));
  }
#endif
  return all;
}

WorkPrecisionReport run_work_precision(const WorkPrecisionOptions& options,
                                       const std::vector<SteppedScene>& scenes,
                                       const std::vector<Contestant>& contestants,
                                       std::ostream& out) {
  WorkPrecisionReport report;
  out << "ms: median CPU time of a step, collision included; of what should stand ours over all "
         "steps,\nBullet's over its first second, else over all steps of both. Sleeping off in "
         "both.\n";
  for (const SteppedScene& scene : scenes) {
    if (scene.name.find(options.scene) == std::string::npos) {
      continue;
    }
    out << fmt::format("\n{}\n{:28}{:>8}{:>10}{:>16}{:>14}{:>12}{:>10}\n", scene.name, "", "s",
                       "ms", scene.error_name, "penetration m", "residual", "unsolved");
    for (const Contestant& contestant : contestants) {
      if (!contestant.is_event_driven || scene.error) {
        report.rows.push_back(run(scene, contestant, seconds_of(scene, contestant, options)));
        print(report.rows.back(), out);
      }
    }
  }
  return report;
}

}  // namespace signorini::bench
