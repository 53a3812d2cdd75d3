#include "bench/stepping_command.h"

#include "bench/extremes_study.h"
#include "bench/job_options.h"
#include "bench/work_precision.h"
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

}  // namespace

struct SteppingCommand::Options {
  WorkPrecisionOptions work_precision;
  ExtremesOptions extremes;
  JobOptions jobs;
  std::string out;
};

SteppingCommand::SteppingCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  work_precision_ = app.add_subcommand(
      "work-precision",
      "Stacks, a pyramid, heavy on light, slopes, a rolling ball, a card house, an "
      "arch, landings, a cradle, bounces and 216 elastic balls: error against step "
      "time for every position of the dial, the event-driven stepper and Bullet "
      "with 10, 50, 200 and 1000 iterations");
  work_precision_
      ->add_option("--seconds", o.work_precision.seconds,
                   "Of each run of ours of what should stand (default: the scene's)")
      ->check(CLI::PositiveNumber);
  work_precision_
      ->add_option("--bullet-seconds", o.work_precision.bullet_seconds, "The same of Bullet's")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  work_precision_->add_option("--scene", o.work_precision.scene,
                              "Only scenes whose names contain this");
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
  for (CLI::App* study : {work_precision_, extremes_}) {
    study->add_option("--out", o.out,
                      "Folder for " + study->get_name() +
                          ".csv, made if absent (default: print "
                          "only)");
  }
}

SteppingCommand::~SteppingCommand() = default;

bool SteppingCommand::is_asked() const {
  return work_precision_->parsed() || extremes_->parsed();
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
  const WorkPrecisionReport report = run_work_precision(
      options_->work_precision, work_precision_scenes(), work_precision_contestants(), std::cout);
  write_csv(options_->out, "work-precision", report.to_csv());
  return report.passed() ? kClaimsHold : kWrongClaim;
}

}  // namespace signorini::bench
