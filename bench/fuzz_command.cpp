#include "bench/fuzz_command.h"

#include "bench/fuzz_study.h"
#include "bench/write_csv.h"
#include "tools/child_process.h"

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <string>

namespace signorini::bench {

struct FuzzCommand::Options {
  FuzzOptions study;
  std::string out;
};

FuzzCommand::FuzzCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  command_ = app.add_subcommand(
      "fuzz", "Random and adversarial problems, every claim judged without rounding");
  command_->add_option("--problems", o.study.problems, "How many, for each solver")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command_->add_option("--first", o.study.first, "Number of the first one: ranges can be resumed")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command_->add_option("--seed", o.study.seed, "Of the problems")->capture_default_str();
  command_->add_option("--solver", o.study.solver, "A name, or all")->capture_default_str();
  command_->add_option("--tolerance", o.study.tolerance, "Of the solvers and of the judge")
      ->check(CLI::Range(1e-15, 0.9))
      ->capture_default_str();
  command_->add_option("--max-iterations", o.study.max_iterations, "Of every solver")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command_
      ->add_option("--truth-every", o.study.truth_every,
                   "Every so many problems exact Lemke says whether a solution exists")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_->add_flag("--warm", o.study.warm, "Solve again from each answer with noise");
  command_->add_option("--hang", o.study.hang_seconds, "Seconds after which a problem is a hang")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_->add_flag("--no-children{false}", o.study.in_children,
                     "Run in this process, for a debugger");
  command_->add_option("--out", o.out, "Folder for fuzz.csv, made if absent (default: print only)");
}

FuzzCommand::~FuzzCommand() = default;

bool FuzzCommand::is_asked() const {
  return command_->parsed();
}

int FuzzCommand::run() const {
#ifdef SIGNORINI_HAS_GMP
  constexpr int kClaimsHold = 0;
  constexpr int kWrongClaim = 1;
  constexpr int kInterrupted = 130;
  const std::filesystem::path folder = options_->out;
  if (!folder.empty()) {
    std::filesystem::create_directories(folder);
  }
  std::signal(SIGINT, [](int) { tools::stop_children(); });
  std::signal(SIGTERM, [](int) { tools::stop_children(); });
  const FuzzCounts counts = run_fuzz_study(options_->study, std::cout);
  write_csv(folder, "fuzz", counts.to_csv());
  if (counts.is_interrupted) {
    return kInterrupted;
  }
  return counts.wrong() == 0 ? kClaimsHold : kWrongClaim;
#else
  fmt::print(stderr, "signorini-bench fuzz: this build has no GMP (SIGNORINI_WITH_GMP=OFF)\n");
  return 70;
#endif
}

}  // namespace signorini::bench
