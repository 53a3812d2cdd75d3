#include "bench/tradeoff_command.h"

#include <signorini/lcp/io/whole_file.h>

#include "bench/tradeoff.h"
#include "tools/child_process.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iostream>
#include <unistd.h>

namespace signorini::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kGood = 0;
constexpr int kWrong = 1;
constexpr int kStopped = 130;

void on_interrupt(int /*signal*/) {
  tools::stop_children();
}

/// A line of PeersStudy's progress, with the position of the dial and the time that is left if the
/// positions to come take as long as those that are done.
std::string position_text(std::size_t done, std::size_t all, double tolerance,
                          Clock::time_point start) {
  std::string text = fmt::format("position {} of {}: tolerance {:g}", done + 1, all, tolerance);
  if (done > 0) {
    const double spent = std::chrono::duration<double>(Clock::now() - start).count();
    text += fmt::format(
        ", about {:.0f} min left",
        std::ceil(spent / static_cast<double>(done) * static_cast<double>(all - done) / 60.0));
  }
  return text;
}

}  // namespace

struct TradeoffCommand::Options {
  PeerProblemOptions problems;
  PeersOptions study;
  std::vector<double> dial = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
  std::vector<double> levels = {1e-2, 1e-4, 1e-6, 1e-8};
  std::vector<std::string> folders;
  std::string out = "tradeoff";
};

TradeoffCommand::TradeoffCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  o.problems.families = {"tower4", "pyramid3d", "spheres", "murty", "fathi"};
  o.problems.forms = {"lcp", "box", "cone"};
  o.problems.sizes = {64, 256};
  o.problems.mass_ratios = {1.0, 1e3};
  o.study.regularised = false;
  o.study.limits.child.seconds = 5.0;
  command_ =
      app.add_subcommand("tradeoff",
                         "Every solver at every tolerance: Pareto fronts of error against time, "
                         "performance profiles, success rates, and what to use");
  command_->add_option("FOLDER", o.folders, "Problem folders, or folders of problem folders");
  command_->add_option("--families", o.problems.families, "As of peers; none: folders alone")
      ->delimiter(',')
      ->capture_default_str();
  command_->add_option("--forms", o.problems.forms, "lcp, pyramid, box, cone")
      ->delimiter(',')
      ->capture_default_str();
  command_->add_option("--sizes", o.problems.sizes, "Rows without friction, about")
      ->delimiter(',')
      ->capture_default_str();
  command_->add_option("--ratios", o.problems.mass_ratios, "Mass ratios")
      ->delimiter(',')
      ->capture_default_str();
  command_->add_option("--solvers", o.study.solvers, "Names (default: all, see peers --list)")
      ->delimiter(',');
  command_->add_option("--dial", o.dial, "Tolerances that the solvers are told")
      ->delimiter(',')
      ->check(CLI::Range(1e-15, 0.9))
      ->capture_default_str();
  command_->add_option("--levels", o.levels, "Errors at which they are compared")
      ->delimiter(',')
      ->check(CLI::Range(1e-15, 0.9))
      ->capture_default_str();
  command_
      ->add_option("--time-limit", o.study.limits.child.seconds,
                   "Seconds of CPU time a solver and problem; also what an unsolved one counts as")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_
      ->add_option("--most-dense", o.study.most_dense,
                   "Rows up to which solvers that take n^2 numbers are asked")
      ->capture_default_str();
  command_
      ->add_option("--out", o.out,
                   "Folder for tradeoff.csv, scores.csv, tradeoff.md, pareto.svg and the "
                   "profiles, made if absent")
      ->capture_default_str();
}

TradeoffCommand::~TradeoffCommand() = default;

bool TradeoffCommand::is_asked() const {
  return command_->parsed();
}

int TradeoffCommand::run() const {
  Options& o = *options_;
  if (o.problems.families == std::vector<std::string>{"none"}) o.problems.families.clear();
  o.problems.folders.assign(o.folders.begin(), o.folders.end());
  o.study.settings.time_limit = tools::kWallTimes * o.study.limits.child.seconds;
  o.study.limits.child.loading_seconds = o.study.limits.child.seconds + 60.0;
  const std::vector<PeerEntry> entries = all_peers();
  const std::vector<PeerProblem> problems = peer_problems(o.problems);
  const std::filesystem::path folder = o.out;
  std::filesystem::create_directories(folder);

  struct sigaction action = {};
  action.sa_handler = &on_interrupt;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
  const bool is_watched = ::isatty(STDERR_FILENO) != 0;
  const Clock::time_point start = Clock::now();
  std::vector<DialRuns> dial;
  int wrong = 0;
  bool is_stopped = false;
  for (std::size_t i = 0; i < o.dial.size() && !is_stopped; ++i) {
    fmt::print(stderr, "{}\n", position_text(i, o.dial.size(), o.dial[i], start));
    o.study.settings.tolerance = o.dial[i];
    dial.push_back({o.dial[i], run_peers_study(problems, entries, o.study,
                                               is_watched ? &std::cerr : nullptr)});
    wrong += dial.back().result.wrong_of_ours();
    is_stopped = dial.back().result.is_interrupted;
  }

  const std::vector<LevelScore> scores = level_scores(dial, o.levels, o.study.limits.child.seconds);
  std::vector<std::string> remarks = {
      fmt::format("{} problems, {} positions of the dial ({:g}), {} solvers", problems.size(),
                  dial.size(), fmt::join(o.dial, ", "),
                  o.study.solvers.empty() ? entries.size() : o.study.solvers.size()),
      fmt::format("one thread; time limit {:g} s, which is what an unsolved problem counts as",
                  o.study.limits.child.seconds),
      fmt::format("runs of ours that said solved and were not, or crashed: {}", wrong)};
  for (const AbsentPeer& absent : absent_peers()) {
    remarks.push_back(
        fmt::format("without {}: this build did not find {}", absent.library, absent.package));
  }
  if (is_stopped) remarks.emplace_back("PARTIAL: interrupted, what follows was not run");
  const std::string page = tradeoff_markdown(scores, remarks);
  lcp::write_whole_file(folder / "tradeoff.csv", tradeoff_csv(dial));
  lcp::write_whole_file(folder / "scores.csv", scores_csv(scores));
  lcp::write_whole_file(folder / "tradeoff.md", page);
  lcp::write_whole_file(folder / "pareto.svg", pareto_svg(scores, "Error against time"));
  std::vector<ProfilePanel> panels;
  for (const double level : {1e-4, 1e-8}) {
    for (ProfilePanel& panel : level_profiles(dial, level)) panels.push_back(std::move(panel));
  }
  lcp::write_whole_file(folder / "profiles.svg",
                        performance_profile_svg(panels, "Performance profiles"));
  fmt::print(
      "{}\nwritten: tradeoff.csv, scores.csv, tradeoff.md, pareto.svg and profiles.svg in {}\n",
      page, folder.string());
  if (is_stopped) return kStopped;
  return wrong == 0 ? kGood : kWrong;
}

}  // namespace signorini::bench
