#include "bench/tradeoff_command.h"

#include <signorini/lcp/io/whole_file.h>

#include "bench/job_options.h"
#include "bench/problem_trade_jobs.h"
#include "bench/tradeoff.h"
#include "tools/file_state.h"

#ifdef SIGNORINI_HAS_SCENES
#include "bench/scene_trade_jobs.h"
#endif

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

namespace signorini::bench {
namespace {

constexpr int kGood = 0;
constexpr int kWrong = 1;
constexpr int kStopped = 130;

/// Sizes and times of the files in these folders: whether they have changed.
std::string state_of(const std::vector<std::string>& folders) {
  std::vector<std::string> files;
  for (const std::string& folder : folders) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
      if (!file.is_regular_file()) continue;
      files.push_back(tools::file_state(file.path()));
    }
  }
  std::sort(files.begin(), files.end());
  return fmt::format("{}", fmt::join(files, "\n"));
}

/// The runs of ours that said solved and were not, or crashed.
int wrong_of_ours(const std::vector<DialRuns>& dial) {
  int wrong = 0;
  for (const DialRuns& position : dial) {
    wrong += position.result.wrong_of_ours();
  }
  return wrong;
}

void add_profiles(const std::vector<TradeRun>& runs, double level,
                  std::vector<ProfilePanel>& panels) {
  for (ProfilePanel& panel : level_profiles(runs, level)) {
    panels.push_back(std::move(panel));
  }
}

}  // namespace

struct TradeoffCommand::Options {
  PeerProblemOptions problems;
  PeersOptions study;
  std::vector<double> dial = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
  std::vector<double> levels = {1e-2, 1e-4, 1e-6, 1e-8};
  std::vector<double> scene_levels = {1e-1, 1e-2, 1e-3, 1e-4, 1e-8};
  std::vector<std::string> folders;
#ifdef SIGNORINI_HAS_SCENES
  SceneTradeOptions scenes;
#endif
  bool without_problems = false;
  bool without_scenes = false;
  JobOptions jobs;
  std::string out = "tradeoff";

  /// All that decides the results.
  [[nodiscard]] std::string text() const {
    std::vector<std::string> programs;  // that have solvers
    for (const PeerEntry& peer : all_peers()) {
      if (!peer.program.empty()) {
        programs.push_back(tools::file_state(peer.program));
      }
    }
    return fmt::format("tradeoff {} {} {} {} {} {} {} {} {}", fmt::join(problems.families, ","),
                       fmt::join(problems.forms, ","), fmt::join(problems.sizes, ","),
                       fmt::join(problems.mass_ratios, ","), fmt::join(dial, ","),
                       state_of(folders), study.limits.child.seconds, study.most_dense,
                       fmt::join(programs, ","));
  }
};

TradeoffCommand::TradeoffCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  o.problems.families = {"tower4", "pyramid3d", "spheres", "murty", "fathi"};
  o.problems.forms = {"lcp", "box", "cone"};
  o.problems.sizes = {64, 256};
  o.problems.mass_ratios = {1.0, 1e3};
  o.study.regularised = false;
  o.study.limits.child.seconds = 5.0;
  command_ = app.add_subcommand(
      "tradeoff",
      "Every solver at every tolerance on contact problems, and every position of the accuracy "
      "dial and Bullet with 10 to 1000 iterations on scenes: Pareto fronts of error against time, "
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
  command_->add_flag("--no-problems", o.without_problems, "Scenes alone");
#ifdef SIGNORINI_HAS_SCENES
  command_->add_flag("--no-scenes", o.without_scenes, "Problems alone");
  command_->add_option("--scene", o.scenes.scene, "Only scenes whose names contain this");
  command_
      ->add_option("--steps", o.scenes.divisors,
                   "What the scenes' own steps are divided by: each is run at all of them")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command_
      ->add_option("--scene-levels", o.scene_levels,
                   "Errors at which scenes are compared, of the size that is wholly wrong")
      ->delimiter(',')
      ->check(CLI::Range(1e-15, 0.9))
      ->capture_default_str();
  command_
      ->add_option("--scene-time-limit", o.scenes.seconds, "Seconds of CPU time a run of a scene")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
#endif
  o.jobs.add_to(*command_);
  command_
      ->add_option("--out", o.out,
                   "Folder for tradeoff.csv, scenes.csv, scores.csv, tradeoff.md, "
                   "recommendations.md, pareto.svg and profiles.svg, made if absent; finished jobs "
                   "are kept in its folder jobs/ until all are done")
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
  if (o.without_problems) {
    o.problems.families.clear();
    o.problems.folders.clear();
  }
  o.study.settings.time_limit = tools::kWallTimes * o.study.limits.child.seconds;
  o.study.limits.child.loading_seconds = o.study.limits.child.seconds + 60.0;
  const std::filesystem::path folder = o.out;
  const ProblemTrade problems(o.problems, o.study, o.dial);
  std::vector<tools::Job> jobs = problems.jobs();
  const std::size_t of_problems = jobs.size();
  std::string settings = o.text();
#ifdef SIGNORINI_HAS_SCENES
  std::optional<SceneTrade> scenes;
  if (!o.without_scenes) {
    scenes.emplace(o.scenes);
    settings += "\n" + scenes->settings();
    for (tools::Job& job : scenes->jobs()) jobs.push_back(std::move(job));
  }
#endif
  const tools::JobListResult result =
      tools::run_job_list(jobs, o.jobs.list_options(folder, settings));
  if (!result.is_leader) return kGood;

  const auto split = result.jobs.begin() + static_cast<std::ptrdiff_t>(of_problems);
  const std::vector<DialRuns> dial = problems.runs({result.jobs.begin(), split});
  const int wrong = wrong_of_ours(dial);
  std::vector<std::string> remarks = {
      fmt::format("{} problems, {} positions of the dial ({:g}), {} solvers",
                  problems.problem_count(), dial.size(), fmt::join(o.dial, ", "),
                  problems.solver_count()),
      fmt::format(
          "one thread a job; time limit {:g} s, which is what an unsolved problem counts as",
          o.study.limits.child.seconds),
      result.remark(),
      fmt::format("runs of ours that said solved and were not, or crashed: {}", wrong)};
  for (const AbsentPeer& absent : absent_peers()) {
    remarks.push_back(
        fmt::format("without {}: this build did not find {}", absent.library, absent.package));
  }
  const std::vector<TradeRun> problem_runs = trade_runs(dial, o.study.limits.child.seconds);
  std::vector<LevelScore> problem_scores = level_scores(problem_runs, o.levels);
  std::vector<TradeRun> scene_runs;
  std::vector<LevelScore> scene_scores;
#ifdef SIGNORINI_HAS_SCENES
  if (scenes) {
    std::vector<SceneTradeRow> rows;
    for (std::size_t i = 0; i + of_problems < jobs.size(); ++i) {
      const tools::JobResult& job = split[static_cast<std::ptrdiff_t>(i)];
      if (job.is_done || !job.reason.empty()) {  // a failed one is a run without an answer
        rows.push_back(scenes->row(i, job));
      }
    }
    scene_runs = trade_runs(rows, o.scenes.seconds);
    scene_scores = level_scores(scene_runs, o.scene_levels);
    remarks.push_back(scenes_remark(rows, o.scenes));
    if (!scenes->without_float().empty()) {
      remarks.push_back("without Bullet float: " + scenes->without_float());
    }
    lcp::write_whole_file(folder / "scenes.csv", scene_trade_csv(rows));
  }
#else
  remarks.emplace_back("without scenes: this build has no validation (SIGNORINI_BUILD_VALIDATION)");
#endif
  const std::string failure = result.first_failure(jobs);
  std::string lacks;
  if (!failure.empty()) lacks = "INCOMPLETE: a job failed: " + failure;
  if (result.is_interrupted) {
    lacks = "PARTIAL: interrupted; the same command goes on where it was";
  }
  if (!lacks.empty()) remarks.push_back(lacks);
  const std::string page = tradeoff_markdown(problem_scores, scene_scores, remarks);
  const std::string tables = (lacks.empty() ? "" : lacks + "\n\n") +
                             recommendations_markdown(problem_scores, scene_scores);
  std::vector<ProfilePanel> panels;
  for (const double level : {1e-4, 1e-8}) {
    add_profiles(scene_runs, level, panels);
    add_profiles(problem_runs, level, panels);
  }
  std::vector<LevelScore> scores = std::move(scene_scores);
  scores.insert(scores.end(), problem_scores.begin(), problem_scores.end());
  std::vector<LevelScore> dots = worst_error_scores(scene_runs);
  dots.insert(dots.end(), problem_scores.begin(), problem_scores.end());
  lcp::write_whole_file(folder / "tradeoff.csv", tradeoff_csv(dial));
  lcp::write_whole_file(folder / "scores.csv", scores_csv(scores));
  lcp::write_whole_file(folder / "tradeoff.md", page);
  lcp::write_whole_file(folder / "recommendations.md", tables);
  lcp::write_whole_file(folder / "pareto.svg", pareto_svg(dots, "Error against time"));
  lcp::write_whole_file(folder / "profiles.svg",
                        performance_profile_svg(panels, "Performance profiles"));
  fmt::print("{}\nwritten: tradeoff.md, recommendations.md, the .csv and .svg in {}\n", page,
             folder.string());
  if (result.is_interrupted) return kStopped;
  if (failure.empty()) tools::forget_finished_jobs(jobs, o.jobs.folder(folder));
  return wrong == 0 && failure.empty() ? kGood : kWrong;
}

}  // namespace signorini::bench
