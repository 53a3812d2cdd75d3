#include <signorini/validation/signorini_runner.h>
#include <signorini/validation/trade_runs.h>

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace signorini::validation {
namespace {

constexpr double kShort = 0.05;  ///< s; shorter runs are repeated
constexpr int kRepeats = 3;

std::vector<TradeWay> ways(const Scene& scene, RunOptions options) {
  options.studies = false;
  std::vector<TradeWay> all;
  for (const double step : {scene.step, scene.step / 4.0}) {
    if (options.signorini) {
      RunOptions ours = options;
      ours.bullet = false;
      const TimeStepSettings settings = step_settings(scene);
      all.push_back(
          {fmt::format("Signorini, {:g}", settings.lcp.tolerance), "signorini", step, ours});
    }
    if (!options.bullet) continue;
    for (const BulletProfile& profile :
         {BulletProfile::neutral(), BulletProfile::bullet_default()}) {
      RunOptions theirs = options;
      theirs.signorini = false;
      theirs.profile = profile;
      all.push_back({fmt::format("Bullet, {}, {} iterations", profile.name, profile.iterations),
                     "bullet", step, theirs});
    }
  }
  return all;
}

const Check* named(const SceneReport& report, const std::string& name, const std::string& engine) {
  const auto found = std::find_if(
      report.checks.begin(), report.checks.end(),
      [&](const Check& check) { return check.name == name && check.engine == engine; });
  return found == report.checks.end() ? nullptr : &*found;
}

}  // namespace

RunFacts run_way(const Scene& scene, const TradeWay& way, const SceneCheck& check,
                 TradePoint& point, Trade& trade) {
  Scene varied = scene;
  varied.step = way.step;
  SceneReport report;
  check(varied, way.options, report);
  const bool ours = way.engine == "signorini";
  const double seconds = ours ? report.signorini_seconds : report.bullet_seconds;
  if (point.whole_seconds < 0.0 || seconds < point.whole_seconds) {
    point.whole_seconds = seconds;
    point.solver_seconds = ours ? report.signorini_solver_seconds : report.bullet_solver_seconds;
  }
  if (const Check* measured = named(report, trade.error, way.engine)) {
    point.error = measured->error;
    trade.unit = measured->unit;
    trade.reference = measured->reference;
  }
  const Check* unsolved = named(report, kUnsolvedSteps, "signorini");
  const Check* broken = named(report, kBrokenRuns, way.engine);
  RunFacts facts{.unsolved_steps = unsolved == nullptr ? 0.0 : unsolved->value,
                 .broke_down = broken != nullptr && broken->value != 0.0};
  if (facts.broke_down) {  // what came before says nothing of the whole run
    point.error = std::numeric_limits<double>::quiet_NaN();
  }
  return facts;
}

void measure_trade(const Scene& scene, const RunOptions& options, const SceneCheck& check,
                   SceneReport& report) {
  if (scene.error.empty()) return;
  Trade trade;
  trade.error = scene.error;
  trade.scale = scene.error_scale;
  trade.duration = scene.duration;
  for (const TradeWay& way : ways(scene, options)) {
    TradePoint point{.solver = way.solver,
                     .engine = way.engine,
                     .step = way.step,
                     .error = std::numeric_limits<double>::quiet_NaN()};
    int repeats = 0;
    do {
      run_way(scene, way, check, point, trade);
    } while (++repeats < kRepeats && point.whole_seconds < kShort);
    trade.points.push_back(std::move(point));
  }
  if (trade.reference.empty()) {
    report.notices.push_back(
        fmt::format("error against cost is not shown: this run has no check '{}'", scene.error));
    return;
  }
  report.trade = std::move(trade);
}

}  // namespace signorini::validation
