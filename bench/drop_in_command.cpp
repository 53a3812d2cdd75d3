#include "bench/drop_in_command.h"

#include <signorini/integrations/bullet/example_scenes/drop_in_run.h>
#include <signorini/integrations/bullet/example_scenes/example_scenes.h>

#include "bench/write_csv.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace signorini::bench {
namespace {

constexpr int kClaimsHold = 0;
constexpr int kWrongClaim = 1;
constexpr double kMoved = 0.25;  // m: farther than this a stack no longer stands

std::vector<bullet::DropInSolver> solvers() {
  return {bullet::bullet_si(10), bullet::bullet_si(50), bullet::bullet_si(200), bullet::ours(),
          bullet::ours(bullet::FrictionModel::kBox)};
}

std::string moved_text(const bullet::DropInRun& run) {
  const double at = run.moved_at(kMoved);
  return at < 0.0 ? "never" : fmt::format("{:.2f}", at);
}

}  // namespace

struct DropInCommand::Options {
  std::vector<std::string> scenes = bullet::ExampleScene::names();
  double seconds = 5.0;
  std::string out;
};

DropInCommand::DropInCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  command_ = app.add_subcommand(
      "drop-in", "Bullet's example scenes with Bullet's solver and with ours inside: solver time");
  command_->add_option("--scenes", o.scenes, "Of stack, wall, wall-hit, ragdoll, vehicle")
      ->delimiter(',')
      ->check(CLI::IsMember(bullet::ExampleScene::names()));
  command_->add_option("--seconds", o.seconds, "Of each run")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_->add_option("--out", o.out,
                       "Folder for drop-in.csv, made if absent (default: print only)");
}

DropInCommand::~DropInCommand() = default;

bool DropInCommand::is_asked() const {
  return command_->parsed();
}

int DropInCommand::run() const {
  if (!options_->out.empty()) {
    std::filesystem::create_directories(options_->out);
  }
  fmt::print(
      "CPU time of solveGroup() a step, its set-up included; dt 1/60 s, Bullet's defaults\n");
  fmt::print("{:<10}{:<15}{:>11}{:>11}{:>13}{:>13}{:>13}{:>12}\n", "scene", "solver", "median us",
             "most us", "moved .25 m", "moved [m]", "overlap [m]", "not solved");
  std::string csv =
      "scene,solver,steps,median_us,most_us,moved_at_s,moved_m,deepest_overlap_m,joint_error_m,"
      "problems,not_solved\n";
  std::int64_t not_solved = 0;
  for (const std::string& scene : options_->scenes) {
    for (const bullet::DropInSolver& solver : solvers()) {
      const bullet::DropInRun run = bullet::run_drop_in(scene, solver, options_->seconds);
      const double median = 1e6 * run.median_solver_seconds();
      const double most = 1e6 * *std::ranges::max_element(run.solver_seconds);
      const double overlap = *std::ranges::max_element(run.overlap);
      const bool is_ours = run.counters.islands > 0;
      not_solved += is_ours ? run.counters.not_solved() : 0;
      fmt::print("{:<10}{:<15}{:>11.0f}{:>11.0f}{:>13}{:>13.2e}{:>13.2e}{:>12}\n", scene,
                 solver.name, median, most, moved_text(run), run.moved.back(), overlap,
                 is_ours ? fmt::format("{}", run.counters.not_solved()) : "");
      std::fflush(stdout);
      csv += fmt::format("{},{},{},{:.4g},{:.4g},{:.4g},{:.6g},{:.6g},{:.6g},{},{}\n", scene,
                         solver.name, run.time.size(), median, most, run.moved_at(kMoved),
                         run.moved.back(), overlap, run.joint_error.back(), run.counters.islands,
                         is_ours ? run.counters.not_solved() : 0);
    }
  }
  write_csv(options_->out, "drop-in", csv);
  return not_solved == 0 ? kClaimsHold : kWrongClaim;
}

}  // namespace signorini::bench
