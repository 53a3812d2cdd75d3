#include "bench/sequence_command.h"

#include <signorini/lcp/io/dump_recorder.h>

#include "bench/sequence_study.h"
#include "bench/write_csv.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <string>

namespace signorini::bench {

struct SequenceCommand::Options {
  SequenceOptions study;
  std::string out;
};

SequenceCommand::SequenceCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  command_ = app.add_subcommand("sequence",
                                "Replays dumped problems in their order, cold and warm-started");
  command_
      ->add_option("FOLDER", o.study.folder,
                   "Problem folders and FCLIB files in it, as SIGNORINI_DUMP leaves them")
      ->required();
  command_->add_option("--solver", o.study.solver, "A name, or recorded: the one of each record")
      ->capture_default_str();
  command_->add_option("--tolerance", o.study.lcp.tolerance, "Of both residuals")
      ->capture_default_str();
  command_->add_option("--repeats", o.study.repeats, "Of each solve; times are the least")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_->add_option("--out", o.out,
                       "Folder for sequence.csv, made if absent (default: print only)");
}

SequenceCommand::~SequenceCommand() = default;

bool SequenceCommand::is_asked() const {
  return command_->parsed();
}

int SequenceCommand::run() const {
  constexpr int kSolved = 0;
  constexpr int kNotSolved = 2;
  const std::filesystem::path folder = options_->out;
  if (!folder.empty()) {
    std::filesystem::create_directories(folder);
  }
  const auto recorder = lcp::dump_recorder_from_environment();
  options_->study.lcp.recorder = recorder.get();
  const SequenceCounts counts = run_sequence_study(options_->study, std::cout);
  write_csv(folder, "sequence", counts.to_csv());
  if (recorder != nullptr) {
    fmt::print(stderr, "{}\n", summary(*recorder));
  }
  return counts.unsolved() == 0 ? kSolved : kNotSolved;
}

}  // namespace signorini::bench
