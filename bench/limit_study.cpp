#include "bench/limit_study.h"

#include <signorini/collision/collision_world.h>

#include "bench/masonry_scenes.h"
#include "bench/thread_time.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <ostream>

namespace signorini::bench {
namespace {

constexpr double kTouching = 1e-6;  // m

ContactSet contacts_of(const SteppedScene& scene) {
  collision::CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  ContactSet contacts;
  world.find(scene.state, kTouching, contacts);
  return contacts;
}

double largest_way(const State& from, const State& to) {
  double way = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    way = std::max(way, (to[k].x - from[k].x).norm());
  }
  return way;
}

LimitRow run(const SteppedScene& scene, const Contestant& contestant, const LimitOptions& options) {
  LimitRow row;
  const std::unique_ptr<ScenePlayer> player = contestant.start(scene);
  const int steps = static_cast<int>(std::lround(options.seconds / scene.step));
  const double start = thread_seconds();
  int done = 0;
  while (done < steps && row.drift <= options.fallen) {
    player->step();
    ++done;
    row.drift = std::max(row.drift, largest_way(scene.state, player->poses()));
  }
  row.milliseconds = 1e3 * (thread_seconds() - start) / std::max(1, done);
  row.seconds = done * scene.step;
  row.unsolved = player->unsolved_steps();
  return row;
}

}  // namespace

bool LimitRow::as_it_should(const LimitOptions& options) const {
  return factor > 1.0 ? drift <= options.most_drift : drift > options.fallen;
}

std::string LimitReport::to_csv() const {
  std::string csv = "scene,bodies,contacts,mu_c,mu/mu_c,seconds,drift m,unsolved,ms a step\n";
  for (const LimitRow& row : rows) {
    csv += fmt::format("\"{}\",{},{},{:.9f},{},{:.4f},{:.3e},{},{:.4f}\n", row.scene, row.bodies,
                       row.contacts, row.critical, row.factor, row.seconds, row.drift, row.unsolved,
                       row.milliseconds);
  }
  return csv;
}

std::vector<Masonry> masonry_scenes() {
  constexpr double kStep = 1.0 / 60.0;
  constexpr double kSeconds = 60.0;
  return {[](double friction) { return card_house_scene(5, friction, kStep, kSeconds); },
          [](double friction) { return arch_scene(15, friction, kStep, kSeconds); }};
}

LimitAnalysis critical_friction(const SteppedScene& scene) {
  return critical_friction(scene.bodies, scene.state, contacts_of(scene), scene.gravity,
                           Vec3::UnitY());
}

LimitReport run_limit_study(const LimitOptions& options, const std::vector<Masonry>& structures,
                            const Contestant& contestant, std::ostream& out) {
  LimitReport report;
  out << fmt::format("{:34}{:>8}{:>10}{:>12}{:>10}{:>8}{:>11}{:>10}{:>8}\n", "", "bodies",
                     "contacts", "mu_c", "mu/mu_c", "s", "drift m", "unsolved", "ms");
  for (const Masonry& structure : structures) {
    const double critical = critical_friction(structure(1.0)).friction;
    for (const double factor : {1.05, 0.9}) {
      const SteppedScene scene = structure(factor * critical);
      LimitRow row = run(scene, contestant, options);
      row.scene = scene.name;
      row.bodies = static_cast<int>(scene.bodies.size()) - 1;
      row.contacts = static_cast<int>(contacts_of(scene).size());
      row.critical = critical;
      row.factor = factor;
      const bool good = row.as_it_should(options) && row.unsolved == 0;
      report.passed = report.passed && good;
      out << fmt::format("{:34}{:8}{:10}{:12.6f}{:10.2f}{:8.2f}{:11.1e}{:10}{:8.2f}  {}\n",
                         row.scene, row.bodies, row.contacts, row.critical, row.factor, row.seconds,
                         row.drift, row.unsolved, row.milliseconds,
                         row.drift > options.fallen ? "falls" : "stands");
      out.flush();
      report.rows.push_back(row);
    }
  }
  return report;
}

}  // namespace signorini::bench
