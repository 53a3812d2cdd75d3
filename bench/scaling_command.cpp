#include "bench/scaling_command.h"

#include "bench/job_options.h"
#include "bench/scaling_baseline.h"
#include "bench/scaling_scenes.h"
#include "bench/scaling_study.h"
#include "bench/write_csv.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

namespace signorini::bench {
namespace {

constexpr int kClaimsHold = 0;
constexpr int kWrongClaim = 1;
constexpr int kInterrupted = 130;

/// 1, 2, 4 .. and all of this machine.
std::vector<int> all_threads() {
  const int most = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
  std::vector<int> threads;
  for (int count = 1; count < most; count *= 2) {
    threads.push_back(count);
  }
  threads.push_back(most);
  return threads;
}

double half_of_the_memory_in_gib() {
  const auto bytes =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return 0.5 * bytes / (1 << 30);
}

}  // namespace

struct ScalingCommand::Options {
  ScalingOptions study;
  double memory_gib = half_of_the_memory_in_gib();
  std::string baseline;
  std::string out;
};

ScalingCommand::ScalingCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  o.study.run.threads = all_threads();
  command_ = app.add_subcommand(
      "scaling",
      "Whole steps of stacks, a pyramid and a pile of 10, 30, 100 .. bodies: time of every stage, "
      "memory, exponents, threads, beside one factorisation, the memory's bandwidth and Bullet");
  command_
      ->add_option("--bodies", o.study.max_bodies,
                   "The most; 100000 is the full study, for tens of minutes and gigabytes")
      ->check(CLI::Range(10, 100000))
      ->capture_default_str();
  command_->add_option("--scenes", o.study.scenes, "Of stacks, pyramid, pile (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"stacks", "pyramid", "pile"}));
  command_->add_option("--accuracy", o.study.run.accuracy, "Position of the dial, or m/s")
      ->capture_default_str();
  command_->add_option("--steps", o.study.run.steps, "That are timed, after the first")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command_
      ->add_option("--threads", o.study.run.threads,
                   "Numbers of threads, from 1 up (default: 1, 2, 4 .. all)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024));
  command_->add_option("--bullet-iterations", o.study.bullet_iterations, "0: without Bullet")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command_->add_option("--time-limit", o.study.run.cpu_seconds, "CPU seconds of a scene and size")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_
      ->add_option("--memory", o.memory_gib,
                   "GiB of a scene and size (default: half of this machine's)")
      ->check(CLI::PositiveNumber);
  command_->add_option("--baseline", o.baseline,
                       "A scaling.csv of an earlier run: exit 1 if a count of ours grew; times "
                       "are only told");
  command_->add_option("--out", o.out,
                       "Folder for scaling.csv, made if absent (default: print only)");
}

ScalingCommand::~ScalingCommand() = default;

bool ScalingCommand::is_asked() const {
  return command_->parsed();
}

int ScalingCommand::run() const {
  ScalingOptions study = options_->study;
  study.run.bytes = static_cast<std::size_t>(options_->memory_gib * (1 << 30));
  validate(study);
  std::optional<std::vector<ScalingRow>> baseline;
  if (!options_->baseline.empty()) {
    baseline = read_baseline(options_->baseline, planned_rows(study));
  }
  if (!options_->out.empty()) {
    std::filesystem::create_directories(options_->out);
  }
  // One job at a time: what is measured is the machine.
  study.jobs = JobOptions().list_options(
      options_->out, fmt::format("scaling {} {} {} {} {}", study.run.accuracy, study.run.steps,
                                 study.run.threads, study.run.cpu_seconds, study.run.bytes));
  const ScalingReport report = run_scaling_study(study);
  if (!report.is_leader) {
    return kClaimsHold;
  }
  print(report, std::cout);
  write_csv(options_->out, "scaling", report.to_csv());
  bool holds = report.passed();
  if (baseline) {
    const BaselineComparison comparison = compare(report.rows, *baseline);
    std::cout << to_text(comparison);
    holds = holds && comparison.passed();
  }
  if (report.is_interrupted) {
    return kInterrupted;
  }
  if (!study.jobs.folder.empty() && report.failure.empty()) {
    tools::forget_finished_jobs(scaling_jobs(study), study.jobs.folder);
  }
  return holds ? kClaimsHold : kWrongClaim;
}

}  // namespace signorini::bench
