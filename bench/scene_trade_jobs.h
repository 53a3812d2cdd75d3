#pragma once

#include "bench/scene_trade.h"
#include "bench/tradeoff.h"
#include "tools/job_list.h"

#include <string>
#include <vector>

namespace signorini::bench {

struct SceneTradeOptions {
  std::string scene;                   ///< only scenes whose names contain this; empty: all
  std::vector<int> divisors = {1, 4};  ///< of the scene's step
  double seconds = 30.0;               ///< of CPU time a run, > 0
};

/// One run of the trade: a scene, a setting, a step.
struct SceneTradeRow {
  std::string scene;
  std::string kind;
  int bodies = 0;     ///< that move
  double step = 0.0;  ///< s
  int divisor = 1;
  double duration = 1.0;  ///< simulated, s, > 0
  std::string setting;
  std::string library;
  SceneOutcome outcome;
};

/// Every scene under every setting at every step, a job each, which runs in a child under the
/// limit; Bullet in single precision in a program of its own (signorini-bullet-float), beside this
/// one. It must outlive its jobs.
class SceneTrade {
 public:
  explicit SceneTrade(const SceneTradeOptions& options);
  [[nodiscard]] std::vector<tools::Job> jobs() const;
  /// The row of a job, from what it came to.
  [[nodiscard]] SceneTradeRow row(std::size_t job, const tools::JobResult& result) const;
  /// What decides the results beside the jobs' names and this program: the limit, and the program
  /// of single precision, by size and time.
  [[nodiscard]] std::string settings() const;
  /// Why single precision takes no part; empty: it does.
  [[nodiscard]] const std::string& without_float() const { return without_float_; }

 private:
  struct Run {
    std::size_t scene = 0;
    std::size_t setting = 0;
    int divisor = 1;
  };
  SceneTradeOptions options_;
  std::vector<TradeScene> scenes_;
  std::vector<SceneSetting> settings_;
  std::vector<Run> runs_;
  std::string without_float_;
};

/// The rows as runs of tradeoff.h: form "stands", "slides" ..., size in bodies, the solver with its
/// step, the error of the scene's scale, seconds of whole steps for a simulated second.
/// @param limit_seconds of a run, for its whole duration, > 0
[[nodiscard]] std::vector<TradeRun> trade_runs(const std::vector<SceneTradeRow>& rows,
                                               double limit_seconds);

/// How many scenes and settings, and how often a run came to no answer, for the page.
[[nodiscard]] std::string scenes_remark(const std::vector<SceneTradeRow>& rows,
                                        const SceneTradeOptions& options);

/// One line a run.
[[nodiscard]] std::string scene_trade_csv(const std::vector<SceneTradeRow>& rows);

}  // namespace signorini::bench
