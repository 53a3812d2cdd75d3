#include "bench/stacks_study.h"

#include <signorini/collision/collision_world.h>

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

StacksRow run(const SteppedScene& scene, const Contestant& contestant, double seconds) {
  StacksRow row{.scene = scene.name,
                .name = contestant.name,
                .is_ours = contestant.is_ours,
                .seconds = seconds};
  collision::CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  const std::unique_ptr<ScenePlayer> player = contestant.start(scene);
  const int steps = std::max(1, static_cast<int>(std::lround(seconds / scene.step)));
  const int first_second = std::max(1, static_cast<int>(std::lround(1.0 / scene.step)));
  const int look = std::max(1, steps / kLooks);
  std::vector<double> times;
  times.reserve(steps);
  for (int k = 0; k < steps; ++k) {
    const double start = thread_seconds();
    player->step();
    if (contestant.is_ours || k < first_second) {
      times.push_back(1e3 * (thread_seconds() - start));
    }
    const State poses = player->poses();
    const Vec3 path = scene.path ? scene.path((k + 1) * scene.step) : Vec3(Vec3::Zero());
    const Vec3 moved = poses[scene.watched].x - scene.state[scene.watched].x;
    row.drift = std::max(row.drift, (moved - path).norm());
    if (k % look == look - 1 || k == steps - 1) {
      row.penetration = std::max(row.penetration, deepest_overlap(poses, world));
    }
  }
  row.milliseconds = median(times);
  row.residual = player->worst_residual();
  row.unsolved = player->unsolved_steps();
  return row;
}

}  // namespace

bool StacksReport::passed() const {
  return std::all_of(rows.begin(), rows.end(),
                     [](const StacksRow& row) { return !row.is_ours || row.unsolved == 0; });
}

std::string StacksReport::to_csv() const {
  std::string csv = "scene,engine,seconds,ms a step,drift m,penetration m,residual,unsolved\n";
  for (const StacksRow& row : rows) {
    csv += fmt::format("\"{}\",\"{}\",{},{:.4f},{:.3e},{:.3e},{:.3e},{}\n", row.scene, row.name,
                       row.seconds, row.milliseconds, row.drift, row.penetration, row.residual,
                       row.unsolved);
  }
  return csv;
}

std::vector<SteppedScene> stacks_scenes() {
  std::vector<SteppedScene> scenes{
      stack_scene(100, 1.0 / 60.0, 60.0),  stack_scene(100, 1.0 / 240.0, 60.0),
      pyramid_scene(20, 1.0 / 60.0, 10.0), heavy_scene(1e3, 1.0 / 60.0, 10.0),
      heavy_scene(1e6, 1.0 / 60.0, 10.0),  heavy_scene(1e9, 1.0 / 60.0, 10.0),
      slope_scene(0.45, 1.0 / 60.0, 2.0),  slope_scene(1.0, 1.0 / 60.0, 2.0),
      rolling_scene(1.0 / 60.0, 2.0)};
#ifdef SIGNORINI_HAS_CLP
  for (const Masonry& structure : masonry_scenes()) {
    scenes.push_back(structure(1.05 * critical_friction(structure(1.0)).friction));
  }
#endif
  return scenes;
}

StacksReport run_stacks_study(const StacksOptions& options, const std::vector<SteppedScene>& scenes,
                              const std::vector<Contestant>& contestants, std::ostream& out) {
  StacksReport report;
  out << "ms: median CPU time of a step, collision included; ours over all steps, Bullet's over "
         "its\nfirst second. Sleeping off in both.\n";
  for (const SteppedScene& scene : scenes) {
    if (scene.name.find(options.scene) == std::string::npos) {
      continue;
    }
    out << fmt::format("\n{}\n{:28}{:>8}{:>10}{:>12}{:>14}{:>12}{:>10}\n", scene.name, "", "s",
                       "ms", "drift m", "penetration m", "residual", "unsolved");
    for (const Contestant& contestant : contestants) {
      const double ours = options.seconds > 0.0 ? options.seconds : scene.seconds;
      const StacksRow row =
          run(scene, contestant,
              contestant.is_ours ? ours : std::min(options.bullet_seconds, scene.seconds));
      out << fmt::format("{:28}{:8.1f}{:10.3f}{:12.1e}{:14.1e}{:>12}{:>10}\n", row.name,
                         row.seconds, row.milliseconds, row.drift, row.penetration,
                         row.is_ours ? fmt::format("{:.1e}", row.residual) : "-",
                         row.is_ours ? fmt::format("{}", row.unsolved) : "-");
      out.flush();
      report.rows.push_back(row);
    }
  }
  return report;
}

}  // namespace signorini::bench
