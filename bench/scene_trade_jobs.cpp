#include "bench/scene_trade_jobs.h"

#include "bench/sibling_program.h"
#include "tools/child_process.h"
#include "tools/file_state.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <stdexcept>

namespace signorini::bench {
namespace {

constexpr const char* kFloat = "Bullet float";

std::filesystem::path float_program() {
  return sibling_program("signorini-bullet-float");
}

/// The run in a child under the limit; what kept it from an answer is said in the outcome.
std::string run_limited(const TradeScene& trade, const SceneSetting& setting, int divisor,
                        double seconds) {
  const tools::ChildLimits limits{.seconds = seconds};
  const tools::ChildAnswer answer =
      setting.library == kFloat
          ? tools::run_program(
                {float_program(), trade.scene.name, setting.name, std::to_string(divisor)}, {},
                limits)
          : tools::run_in_child(
                [&](const std::function<void()>& loaded) {
                  loaded();
                  return tools::to_bytes(run_trade_scene(trade, setting, divisor));
                },
                limits);
  if (answer.end == tools::ChildEnd::kAnswered) {
    return answer.answer;
  }
  if (answer.end == tools::ChildEnd::kCrashed && setting.library == "Signorini") {
    throw std::runtime_error(answer.reason);
  }
  SceneOutcome outcome;
  outcome.said = answer.reason;
  return tools::to_bytes(outcome);
}

int moving_bodies(const validation::Scene& scene) {
  return static_cast<int>(std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                        [](const Body& body) { return body.is_dynamic(); }));
}

std::string setting_with_step(const SceneTradeRow& row) {
  return row.divisor == 1 ? row.setting : fmt::format("{}, step/{}", row.setting, row.divisor);
}

}  // namespace

SceneTrade::SceneTrade(const SceneTradeOptions& options)
    : options_(options), scenes_(trade_scenes(options.scene)), settings_(scene_settings()) {
  if (!std::filesystem::exists(float_program())) {
    without_float_ = "this build did not find Bullet in single precision (libbullet-dev)";
    std::erase_if(settings_, [](const SceneSetting& one) { return one.library == kFloat; });
  }
  for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
    for (const int divisor : options.divisors) {
      for (std::size_t setting = 0; setting < settings_.size(); ++setting) {
        runs_.push_back({scene, setting, divisor});
      }
    }
  }
}

std::string SceneTrade::settings() const {
  return fmt::format("scenes {} {}", options_.seconds, tools::file_state(float_program()));
}

std::vector<tools::Job> SceneTrade::jobs() const {
  std::vector<tools::Job> jobs;
  for (const Run& run : runs_) {
    const TradeScene& trade = scenes_[run.scene];
    const SceneSetting& setting = settings_[run.setting];
    jobs.push_back(
        {fmt::format("scene {}: {}, step/{}", trade.scene.name, setting.name, run.divisor),
         [&trade, &setting, divisor = run.divisor, seconds = options_.seconds] {
           return run_limited(trade, setting, divisor, seconds);
         }});
  }
  return jobs;
}

SceneTradeRow SceneTrade::row(std::size_t job, const tools::JobResult& result) const {
  const Run& run = runs_[job];
  const validation::Scene& scene = scenes_[run.scene].scene;
  SceneTradeRow row{.scene = scene.name,
                    .kind = scene.kind,
                    .bodies = moving_bodies(scene),
                    .step = scene.step / run.divisor,
                    .divisor = run.divisor,
                    .duration = scene.duration,
                    .setting = settings_[run.setting].name,
                    .library = settings_[run.setting].library,
                    .outcome = {}};
  if (result.is_done) {
    row.outcome = tools::from_bytes<SceneOutcome>(result.bytes);
  } else {
    row.outcome.said = result.reason;
  }
  return row;
}

std::vector<TradeRun> trade_runs(const std::vector<SceneTradeRow>& rows, double limit_seconds) {
  std::vector<TradeRun> runs;
  runs.reserve(rows.size());
  for (const SceneTradeRow& row : rows) {
    runs.push_back({.problem = row.scene,
                    .which = {row.kind, class_size(row.bodies), "bodies"},
                    .solver = setting_with_step(row),
                    .library = row.library,
                    .error = row.outcome.error,
                    .seconds = row.outcome.whole_seconds,
                    .limit_seconds = limit_seconds / row.duration});
  }
  return runs;
}

std::string scenes_remark(const std::vector<SceneTradeRow>& rows,
                          const SceneTradeOptions& options) {
  std::set<std::string> scenes;
  std::set<std::string> settings;
  int without = 0;
  for (const SceneTradeRow& row : rows) {
    scenes.insert(row.scene);
    settings.insert(row.setting);
    without += row.outcome.said.empty() ? 0 : 1;
  }
  return fmt::format(
      "{} scenes under {} settings, at their own steps divided by {}; {} runs came to no answer "
      "(limit: {:g} s of CPU time, which is what they count as, over the scene's duration)",
      scenes.size(), settings.size(), fmt::join(options.divisors, ", "), without, options.seconds);
}

std::string scene_trade_csv(const std::vector<SceneTradeRow>& rows) {
  std::string text =
      "scene,kind,bodies,setting,library,step_s,error_of_scale,whole_s_per_simulated_s,"
      "solver_s_per_simulated_s,unsolved_steps,no_answer_because\n";
  const auto seconds = [](double value) {
    return value < 0.0 ? std::string() : fmt::format("{:.6g}", value);
  };
  for (const SceneTradeRow& row : rows) {
    text += fmt::format("\"{}\",{},{},\"{}\",{},{:.9g},{:.9g},{},{},{},\"{}\"\n", row.scene,
                        row.kind, row.bodies, row.setting, row.library, row.step, row.outcome.error,
                        seconds(row.outcome.whole_seconds), seconds(row.outcome.solver_seconds),
                        row.outcome.unsolved_steps, row.outcome.said);
  }
  return text;
}

}  // namespace signorini::bench
