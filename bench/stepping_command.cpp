#include "bench/stepping_command.h"

#include <signorini/lcp/io/whole_file.h>

#include "bench/stacks_study.h"

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
  std::string out;
};

SteppingCommand::SteppingCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  stacks_ = app.add_subcommand(
      "stacks",
      "Stacks, a pyramid, heavy on light: step time, drift and penetration beside "
      "Bullet's");
  stacks_->add_option("--seconds", o.stacks.seconds, "Of each run of ours (default: the scene's)")
      ->check(CLI::PositiveNumber);
  stacks_->add_option("--bullet-seconds", o.stacks.bullet_seconds, "Of each run of Bullet's")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  stacks_->add_option("--scene", o.stacks.scene, "Only scenes whose names contain this");
  stacks_->add_option("--out", o.out,
                      "Folder for stacks.csv, made if absent (default: print only)");
}

SteppingCommand::~SteppingCommand() = default;

bool SteppingCommand::is_asked() const {
  return stacks_->parsed();
}

int SteppingCommand::run() const {
  if (!options_->out.empty()) {
    std::filesystem::create_directories(options_->out);
  }
  const StacksReport report =
      run_stacks_study(options_->stacks, stacks_scenes(), contestants(), std::cout);
  if (!options_->out.empty()) {
    const std::filesystem::path file = std::filesystem::path(options_->out) / "stacks.csv";
    lcp::write_whole_file(file, report.to_csv());
    fmt::print("written: {}\n", file.string());
  }
  return report.passed() ? kClaimsHold : kWrongClaim;
}

}  // namespace signorini::bench
