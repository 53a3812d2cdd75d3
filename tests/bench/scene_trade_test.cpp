#include "bench/scene_trade_jobs.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>
#include <stdexcept>

namespace signorini::bench {
namespace {

const SceneSetting& setting(const std::vector<SceneSetting>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(),
                       [&](const SceneSetting& one) { return one.name == name; });
}

TEST(SceneTrade, KindsAndSizes) {
  EXPECT_EQ(trade_scene("stack-of-5").scene.kind, "stands");
  EXPECT_EQ(trade_scene("rolling-sphere").scene.kind, "slides");
  EXPECT_EQ(trade_scene("wedge").scene.kind, "bounces");
  EXPECT_EQ(trade_scene("free-flight").scene.kind, "free");
  std::set<int> classes;
  for (const TradeScene& trade : trade_scenes("1/60 s")) {
    EXPECT_EQ(trade.scene.kind, "stands");
    classes.insert(class_size(static_cast<int>(trade.scene.bodies.size()) - 1));
  }
  EXPECT_EQ(classes, (std::set<int>{16, 64, 256, 1024}));
}

TEST(SceneTrade, TheFinerStepErrsLessAndCostsMore) {
  const std::vector<SceneSetting> settings = scene_settings();
  const TradeScene rolls = trade_scene("rolling-sphere");
  const SceneOutcome coarse = run_trade_scene(rolls, setting(settings, "game"), 1);
  const SceneOutcome fine = run_trade_scene(rolls, setting(settings, "game"), 4);
  EXPECT_GT(coarse.error, 0.0);
  EXPECT_LT(fine.error, 0.5 * coarse.error);
  EXPECT_LT(coarse.error, 1e-2);
  EXPECT_EQ(coarse.unsolved_steps, 0.0);
  EXPECT_GT(coarse.whole_seconds, 0.0);
  EXPECT_GT(coarse.solver_seconds, 0.0);
}

TEST(SceneTrade, AStackStandsAndBulletsSinks) {
  const std::vector<SceneSetting> settings = scene_settings();
  const TradeScene stack = trade_scene("stack of 20, 1/60 s");
  EXPECT_LT(run_trade_scene(stack, setting(settings, "preview"), 1).error, 1e-8);
  const SceneOutcome bullet = run_trade_scene(stack, setting(settings, "Bullet SI50"), 1);
  EXPECT_GT(bullet.error, 1e-3);
  EXPECT_GT(bullet.solver_seconds, 0.0);
  EXPECT_LT(bullet.solver_seconds, 1.5 * bullet.whole_seconds);
}

TEST(SceneTrade, JobsBringEveryRunHome) {
  SceneTradeOptions options;
  options.scene = "rolling-sphere";
  options.divisors = {1};
  const SceneTrade trade(options);
  const std::vector<tools::Job> jobs = trade.jobs();
  const tools::JobListResult result = tools::run_job_list(jobs, {.processes = 2});
  std::vector<SceneTradeRow> rows;
  for (std::size_t i = 0; i < jobs.size(); ++i) rows.push_back(trade.row(i, result.jobs[i]));
  ASSERT_EQ(rows.size(), trade.without_float().empty() ? 14U : 9U);
  for (const SceneTradeRow& row : rows) {
    EXPECT_TRUE(row.outcome.said.empty()) << row.setting << ": " << row.outcome.said;
    EXPECT_LT(row.outcome.error, 1.0) << row.setting;
    EXPECT_EQ(row.kind, "slides");
  }
  const std::vector<TradeRun> runs = trade_runs(rows, 30.0);
  EXPECT_EQ(runs[0].which, (ProblemClass{"slides", 16, "bodies"}));
  EXPECT_NE(scene_trade_csv(rows).find("\"rolling-sphere\",slides,1,\"preview\",Signorini"),
            std::string::npos);
}

TEST(SceneTrade, ScenesAreFoundByName) {
  ASSERT_EQ(trade_scenes("pyramid of 10").size(), 1U);
  EXPECT_EQ(trade_scenes("pyramid of 10")[0].scene.bodies.size(), 56U);
  EXPECT_THROW((void)trade_scene("castle"), std::invalid_argument);
}

TEST(SceneTrade, OutOfTimeIsNoAnswer) {
  SceneTradeOptions options;
  options.scene = "rolling-sphere";
  options.divisors = {1024};
  options.seconds = 0.01;
  const SceneTrade trade(options);
  std::vector<tools::Job> jobs = trade.jobs();
  jobs.resize(1);
  const tools::JobListResult result = tools::run_job_list(jobs, {});
  const SceneTradeRow row = trade.row(0, result.jobs[0]);
  EXPECT_EQ(row.outcome.said, "time limit");
  EXPECT_LT(trade_runs({row}, 0.01)[0].seconds, 0.0);
  // Seconds are for one simulated second, the limit too.
  EXPECT_DOUBLE_EQ(trade_runs({row}, 0.01)[0].limit_seconds, 0.01 / row.duration);
  EXPECT_EQ(row.duration, trade_scene("rolling-sphere").scene.duration);
}

}  // namespace
}  // namespace signorini::bench
