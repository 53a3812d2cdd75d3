#include "bench/stepping_command.h"

#include "bench/extremes_study.h"
#include "bench/job_options.h"
#include "bench/stacks_study.h"
#include "bench/write_csv.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <string>
#include <vector>

namespace signorini::bench {
namespace {

constexpr int kClaimsHold = 0;
constexpr int kWrongClaim = 1;
constexpr int kInterrupted = 130;

std::vector<Contestant> contestants() {
  std::vector<Contestant> all;
  for (const char* position : {"preview", "game", "engineering", "reference"}) {
    TimeStepSettings settings;
    settings.accuracy = Accuracy::named(position);
    all.push_back(our_stepper(std::string("signorini, ") + position, settings));
  }
#ifdef SIGNORINI_PEER_BULLET
  for (const int iterations : {10, 50, 200, 1000}) {
    all.push_back(bullet_stepper(iterations));
  }
#endif
  return all;
}

}  // namespace

struct SteppingCommand::Options {
  StacksOptions stacks;
  ExtremesOptions extremes;
  JobOptions jobs;
  std::string out;
};

SteppingCommand::SteppingCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  stacks_ =
      app.add_subcommand("stacks",
                         "Stacks, a pyramid, heavy on light, slopes, a rolling ball: error against "
                         "step time for every "
                         "position of the dial and Bullet with 10, 50, 200 and 1000 iterations");
  stacks_->add_option("--seconds", o.stacks.seconds, "Of each run of ours (default: the scene's)")
      ->check(CLI::PositiveNumber);
  stacks_->add_option("--bullet-seconds", o.stacks.bullet_seconds, "Of each run of Bullet's")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  stacks_->add_option("--scene", o.stacks.scene, "Only scenes whose names contain this");
  extremes_ = app.add_subcommand(
      "extremes",
      "Mass ratios, sizes, steps, speeds, restitution, friction, heights, redundant and nearly "
      "parallel contacts, inertia ratios, distances: pass, degraded or fail for every solver");
  extremes_->add_option("--cap", o.extremes.cap, "CPU seconds of a cell")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  extremes_->add_option("--axis", o.extremes.axis, "Only axes whose names contain this");
  extremes_->add_option("--contestant", o.extremes.contestant,
                        "Only solvers and engines whose names contain this");
  o.jobs.add_to(*extremes_);
  for (CLI::App* study : {stacks_, extremes_}) {
    study->add_option("--out", o.out,
                      "Folder for " + study->get_name() +
                          ".csv, made if absent (default: print "
                          "only)");
  }
}

SteppingCommand::~SteppingCommand() = default;

bool SteppingCommand::is_asked() const {
  return stacks_->parsed() || extremes_->parsed();
}

int SteppingCommand::run_extremes() const {
  ExtremesOptions& o = options_->extremes;
  o.jobs = options_->jobs.list_options(options_->out, fmt::format("extremes {}", o.cap));
  const std::vector<ExtremeCell> cells = extreme_cells();
  const std::vector<ExtremeContestant> contestants = extreme_contestants();
  const ExtremesReport report = run_extremes_study(o, cells, contestants, std::cout);
  if (!report.is_leader) {
    return kClaimsHold;
  }
  write_csv(options_->out, "extremes", report.to_csv());
  if (report.is_interrupted) {
    return kInterrupted;
  }
  if (!o.jobs.folder.empty()) {
    tools::forget_finished_jobs(extremes_jobs(o, cells, contestants), o.jobs.folder);
  }
  return report.passed() ? kClaimsHold : kWrongClaim;
}

int SteppingCommand::run() const {
  if (!options_->out.empty()) {
    std::filesystem::create_directories(options_->out);
  }
  if (extremes_->parsed()) {
    return run_extremes();
  }
  const StacksReport report =
      run_stacks_study(options_->stacks, stacks_scenes(), contestants(), std::cout);
  write_csv(options_->out, "stacks", report.to_csv());
  return report.passed() ? kClaimsHold : kWrongClaim;
}

}  // namespace signorini::bench
