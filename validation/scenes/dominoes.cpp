#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace signorini::validation {
namespace {

constexpr double kFallen = std::numbers::pi / 6.0;  ///< turned by more than this, rad
constexpr double kMoved = 1e-3;                     ///< turned by more than this, rad
constexpr double kNever = std::numeric_limits<double>::infinity();

/// When a domino is first turned by more than an angle about y, s.
double first_time(const Track& track, std::size_t domino, double angle) {
  for (std::size_t k = 0; k < track.size(); ++k) {
    const Vec3 up = track.bodies[k][domino].pose.orientation * Vec3::UnitZ();
    if (std::atan2(up.x(), up.z()) > angle) return track.time[k];
  }
  return kNever;
}

}  // namespace

/// They fall one after another, forwards.
void check_dominoes(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  std::size_t count = 0;
  while (count < scene.bodies.size() && scene.bodies[count].is_dynamic()) ++count;
  Table table;
  table.title = "When each domino has turned by 30 degrees [s]";
  table.header = {"domino"};
  for (std::size_t i = 0; i < count; ++i) table.rows.push_back({scene.bodies[i].name});
  runs.for_each([&](const Track& track) {
    const bool ours = track.engine == "signorini";
    table.header.push_back(track.engine);
    double standing = 0.0;
    double out_of_turn = 0.0;
    double previous = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double fell = first_time(track, i, kFallen);
      table.rows[i].push_back(text(fell));
      standing += fell < kNever ? 0.0 : 1.0;
      // It falls after the one before, and did not move before that one had begun to fall.
      const double began = i == 0 ? 0.0 : first_time(track, i - 1, kMoved);
      const bool in_turn = fell >= previous && first_time(track, i, kMoved) >= began;
      out_of_turn += in_turn ? 0.0 : 1.0;
      previous = fell;
    }
    const auto add = [&](const std::string& name, double value) {
      const CheckText text{.name = name,
                           .engine = track.engine,
                           .reference = "definition",
                           .unit = "1",
                           .reason =
                               "each has the next one within its reach, and friction holds "
                               "its foot"};
      report.checks.push_back(ours ? absolute(text, value, 0.0, 0.0) : shown(text, value, 0.0));
    };
    add("dominoes still standing at the end", standing);
    add("dominoes that fall or begin to fall before the one before them", out_of_turn);
  });
  report.tables.push_back(std::move(table));
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  report.plots.push_back(
      plot_over_time("Turn of the last domino", "cosine of the angle to the vertical [1]", runs,
                     [count](const Track& track, std::size_t k) {
                       return (track.bodies[k][count - 1].pose.orientation * Vec3::UnitZ()).z();
                     }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
