#include "bench/tradeoff.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace signorini::bench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

PeersRow row(const std::string& problem, int n, const std::string& solver, double residual,
             double seconds, Verdict verdict = Verdict::kSolved) {
  PeersRow row;
  row.problem = problem;
  row.form = "lcp";
  row.n = n;
  row.solver = solver;
  row.library = solver == "theirs" ? "ODE" : "Signorini";
  row.run.verdict = verdict;
  row.run.seconds = seconds;
  row.run.certificate.natural_residual = residual;
  return row;
}

/// Two positions of the dial, two problems of one class. "sweep" is fast and coarse, and errs more
/// than it was asked at 1e-8; "newton" is slow and exact; "theirs" fails the second problem.
std::vector<DialRuns> two_positions() {
  DialRuns coarse{.tolerance = 1e-2, .result = {}};
  coarse.result.rows = {
      row("a", 60, "sweep", 5e-3, 1e-4),   row("a", 60, "newton", 1e-12, 1e-2),
      row("a", 60, "theirs", 1e-9, 1e-3),  row("b", 64, "sweep", 9e-3, 4e-4),
      row("b", 64, "newton", 1e-13, 1e-2), row("b", 64, "theirs", kNaN, -1.0, Verdict::kTimedOut)};
  DialRuns fine{.tolerance = 1e-8, .result = {}};
  fine.result.rows = {row("a", 60, "sweep", 1e-5, 2e-3), row("a", 60, "newton", 1e-12, 8e-3),
                      row("b", 64, "sweep", 1e-5, 2e-3), row("b", 64, "newton", 1e-13, 2e-2),
                      row("b", 64, "idle", kNaN, -1.0, Verdict::kRefused)};
  return {coarse, fine};
}

const LevelScore& score(const std::vector<LevelScore>& scores, const std::string& solver,
                        double level) {
  for (const LevelScore& one : scores) {
    if (one.solver == solver && one.level == level) return one;
  }
  throw std::out_of_range(solver);
}

TEST(Tradeoff, AnswersCountByWhatTheyErrNotByWhatWasAsked) {
  const std::vector<double> levels = {1e-2, 1e-4, 1e-8};
  const std::vector<LevelScore> scores = level_scores(trade_runs(two_positions(), 5.0), levels);
  EXPECT_EQ(score(scores, "sweep", 1e-2).solved, 2);
  EXPECT_EQ(score(scores, "sweep", 1e-4).solved, 2);
  EXPECT_EQ(score(scores, "sweep", 1e-8).solved, 0);
  EXPECT_EQ(score(scores, "newton", 1e-8).solved, 2);
  EXPECT_EQ(score(scores, "theirs", 1e-8).solved, 1);
  EXPECT_THROW((void)score(scores, "idle", 1e-8), std::out_of_range) << "refused everything";
  for (const LevelScore& one : scores) EXPECT_EQ(one.which, (ProblemClass{"lcp", 64}));
}

TEST(Tradeoff, MeanIsShiftedGeometricOfTheFastestPositions) {
  const std::vector<double> levels = {1e-4};
  const std::vector<LevelScore> scores = level_scores(trade_runs(two_positions(), 5.0), levels);
  const double s = kShiftSeconds;
  EXPECT_NEAR(score(scores, "newton", 1e-4).mean_seconds, std::sqrt((8e-3 + s) * (1e-2 + s)) - s,
              1e-12);
  EXPECT_NEAR(score(scores, "theirs", 1e-4).mean_seconds, std::sqrt((1e-3 + s) * (5.0 + s)) - s,
              1e-12);
}

TEST(Tradeoff, FrontHoldsWhatNothingBeatsAndOnlyWhoSolvesAll) {
  const std::vector<double> levels = {1e-2, 1e-4, 1e-8};
  const std::vector<LevelScore> scores = level_scores(trade_runs(two_positions(), 5.0), levels);
  const std::vector<LevelScore> front = pareto_front(scores, {"lcp", 64});
  ASSERT_EQ(front.size(), 3u);
  EXPECT_EQ(front[0].solver + front[1].solver + front[2].solver, "sweepsweepnewton");
  EXPECT_TRUE(pareto_front(scores, {"cone", 64}).empty());
}

TEST(Tradeoff, ProfilesTakeUnsolvedAsInfinite) {
  const std::vector<ProfilePanel> panels = level_profiles(trade_runs(two_positions(), 5.0), 1e-8);
  ASSERT_EQ(panels.size(), 1u);
  const std::vector<ProfileCurve> curves = profile_curves(panels[0]);
  ASSERT_EQ(curves.size(), 3u);
  EXPECT_EQ(curves[0].name, "newton");
  EXPECT_EQ(curves[0].solved(), 2);
}

TEST(Tradeoff, PageRecommendsOfOursTheFastestThatSolvesAllAndNamesFasterPeers) {
  const std::vector<double> levels = {1e-2, 1e-8};
  std::vector<DialRuns> dial = two_positions();
  std::vector<LevelScore> scores = level_scores(trade_runs(dial, 5.0), levels);
  std::string page = tradeoff_markdown(scores, {}, {"remark"});
  EXPECT_NE(page.find("| lcp | 64 | `sweep`"), std::string::npos) << page;
  EXPECT_EQ(page.find("is faster"), std::string::npos) << page;

  dial[0].result.rows[5] = row("b", 64, "theirs", 1e-9, 1e-5);
  dial[0].result.rows[2] = row("a", 60, "theirs", 1e-9, 1e-5);
  scores = level_scores(trade_runs(dial, 5.0), levels);
  page = tradeoff_markdown(scores, {}, {});
  EXPECT_NE(page.find("(ODE theirs is faster"), std::string::npos) << page;
  EXPECT_NE(pareto_svg(scores, "t").find("theirs"), std::string::npos);
}

/// Two settings of nearly one time and error on the front.
TEST(Tradeoff, LabelsOfTheFrontDoNotLieOnEachOther) {
  std::vector<LevelScore> scores(3);
  for (std::size_t k = 0; k < scores.size(); ++k) {
    scores[k].which = {.form = "stands", .size = 16, .unit = "bodies"};
    scores[k].solver = std::string(1, static_cast<char>('a' + k));
    scores[k].problems = scores[k].solved = 1;
  }
  scores[0].level = 1e-2, scores[0].mean_seconds = 1.0;
  scores[1].level = 0.99e-2, scores[1].mean_seconds = 1.01;
  scores[2].level = 1e-9, scores[2].mean_seconds = 100.0;
  const std::string svg = pareto_svg(scores, "t");
  const auto base_of = [&svg](const std::string& label) {
    const std::size_t end = svg.find("\" font-size=\"10\">" + label + "<");
    return std::stod(svg.substr(svg.rfind("y=\"", end) + 3));
  };
  EXPECT_GE(base_of("b"), base_of("a") + 10.0);
  EXPECT_GT(base_of("c"), base_of("b") + 100.0);
}

TEST(Tradeoff, AProfileOfAPartialStudyHasTheProblemsThatEverybodyTried) {
  std::vector<TradeRun> runs = trade_runs(two_positions(), 5.0);
  std::erase_if(
      runs, [](const TradeRun& run) { return run.solver == "newton" && run.problem == "a/lcp"; });
  const std::vector<ProfilePanel> panels = level_profiles(runs, 1e-2);
  ASSERT_EQ(panels.size(), 1u);
  for (const ProfileSeries& series : panels[0].series) EXPECT_EQ(series.seconds.size(), 1u);
  EXPECT_EQ(profile_curves(panels[0]).size(), 3u);
}

/// Of one problem.
TradeRun run_of(const std::string& solver, double error, double seconds) {
  return {.problem = "p",
          .which = {"stands", 16, "bodies"},
          .solver = solver,
          .library = "Signorini",
          .error = error,
          .seconds = seconds,
          .limit_seconds = 5.0};
}

TEST(Tradeoff, OfWhatIsAsFastTheMoreAccurateIsRecommended) {
  const std::vector<double> levels = {1e-2, 1e-8};
  const auto table = [&](double reference_seconds) {
    const std::vector<TradeRun> runs = {run_of("game", 1e-3, 1.0),
                                        run_of("reference", 1e-9, reference_seconds)};
    return recommendations_markdown({}, level_scores(runs, levels));
  };
  EXPECT_NE(table(1.05).find("| stands | 16 | `reference` 1.1s | `reference`"), std::string::npos)
      << table(1.05);
  EXPECT_NE(table(1.5).find("| stands | 16 | `game` 1.0s | `reference`"), std::string::npos)
      << table(1.5);
}

TEST(Tradeoff, OfEquallyAccurateOnesTheFastestIsRecommended) {
  // The fastest is coarse; of the two that are as accurate as each other the slower comes first.
  const std::vector<TradeRun> runs = {run_of("coarse", 1e-3, 1.0), run_of("slow", 1e-9, 1.09),
                                      run_of("quick", 1e-9, 1.02)};
  const std::vector<double> levels = {1e-2, 1e-8};
  const std::string table = recommendations_markdown({}, level_scores(runs, levels));
  EXPECT_NE(table.find("| `quick` 1.0s | `quick` 1.0s |"), std::string::npos) << table;
}

TEST(Tradeoff, WhatIsNotSolvedCountsAsTheLimitOfItsRun) {
  const std::vector<double> levels = {1e-2};
  TradeRun run{.problem = "p",
               .which = {"stands", 16, "bodies"},
               .solver = "s",
               .library = "Signorini",
               .error = 1.0,
               .seconds = 1e-3,
               .limit_seconds = 120.0};
  EXPECT_NEAR(level_scores(std::vector{run}, levels).front().mean_seconds, 120.0, 1e-9);
  run.error = 1e-3;  // an answer counts as what it took
  run.seconds = 200.0;
  EXPECT_NEAR(level_scores(std::vector{run}, levels).front().mean_seconds, 200.0, 1e-9);
}

TEST(Tradeoff, PictureShowsTheWorstErrorOfWhoAnswersEverything) {
  std::vector<TradeRun> runs = trade_runs(two_positions(), 5.0);
  std::erase_if(runs, [](const TradeRun& run) { return run.seconds < 0.0 && run.is_refused; });
  const std::vector<LevelScore> scores = worst_error_scores(runs);
  ASSERT_EQ(scores.size(), 2U) << "theirs was out of time once";
  EXPECT_EQ(score(scores, "sweep", 9e-3).problems, 4);
  EXPECT_EQ(score(scores, "newton", 1e-12).solved, 4);
}

TEST(Tradeoff, WhoSolvesMoreThanOursIsNamed) {
  std::vector<DialRuns> dial = two_positions();
  dial[0].result.rows[5] = row("b", 64, "theirs", 1e-9, 1e-5);
  for (DialRuns& position : dial) {
    std::erase_if(position.result.rows, [](const PeersRow& one) { return one.solver == "newton"; });
  }
  const std::vector<double> levels = {1e-8};
  const std::string table =
      recommendations_markdown(level_scores(trade_runs(dial, 5.0), levels), {});
  EXPECT_NE(table.find("nothing of ours (ODE theirs: 2 of 2)"), std::string::npos) << table;
}

TEST(Tradeoff, NothingToCompareIsAnEmptyPage) {
  const std::vector<double> levels = {1e-4};
  EXPECT_TRUE(level_scores({}, levels).empty());
  EXPECT_TRUE(level_profiles({}, 1e-4).empty());
  EXPECT_NE(tradeoff_markdown({}, {}, {}).find("# The trade"), std::string::npos);
  EXPECT_NE(pareto_svg({}, "t").find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace signorini::bench
