#include "bench/limit_command.h"

#include "bench/limit_study.h"
#include "bench/write_csv.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <string>

namespace signorini::bench {
namespace {

constexpr int kClaimsHold = 0;
constexpr int kWrongClaim = 1;

}  // namespace

struct LimitCommand::Options {
  LimitOptions study;
  std::string accuracy = "engineering";
  std::string out;
};

LimitCommand::LimitCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  command_ = app.add_subcommand(
      "limit",
      "A card house of 5 floors and an arch of 15 stones: mu_c by limit analysis, and that they "
      "stand at 1.05 mu_c and fall at 0.9 mu_c");
  command_->add_option("--seconds", o.study.seconds, "Of each run, at most")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_->add_option("--accuracy", o.accuracy, "The position of the dial")
      ->check(CLI::IsMember({"preview", "game", "engineering", "reference"}))
      ->capture_default_str();
  command_->add_option("--out", o.out,
                       "Folder for limit.csv, made if absent (default: print only)");
}

LimitCommand::~LimitCommand() = default;

bool LimitCommand::is_asked() const {
  return command_->parsed();
}

int LimitCommand::run() const {
  if (!options_->out.empty()) {
    std::filesystem::create_directories(options_->out);
  }
  TimeStepSettings settings;
  settings.accuracy = Accuracy::named(options_->accuracy);
  const LimitReport report = run_limit_study(options_->study, masonry_scenes(),
                                             our_stepper(options_->accuracy, settings), std::cout);
  write_csv(options_->out, "limit", report.to_csv());
  return report.passed ? kClaimsHold : kWrongClaim;
}

}  // namespace signorini::bench
