#include "bench/scaling_case.h"

#include <signorini/collision/collision_world.h>
#include <signorini/core/response/time_stepper.h>
#include <signorini/lcp/certificate.h>
#include <signorini/lcp/solve_recorder.h>

#include "bench/factorization_floor.h"
#include "bench/scaling_archive.h"
#include "bench/scaling_scenes.h"
#include "bench/scene_player.h"
#include "bench/thread_time.h"
#include "tests/lcp/allocation_count.h"
#include "tools/child_process.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <malloc.h>
#include <stdexcept>
#include <utility>

namespace signorini::bench {
namespace {

constexpr double kMostDrift = 1e-3;  // m, of a body that should rest, in some steps

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Bytes that malloc has given out, of the main thread; 0 where the sanitizers own it.
double allocated_bytes() {
  const struct mallinfo2 info = ::mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// A line of /proc/self/status in bytes, or NaN.
double memory_line(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(name, 0) == 0) {
      return 1024.0 * std::atof(line.c_str() + name.size());
    }
  }
  return ScalingCosts::kUnknown;
}

/// The most resident memory from here on, on top of what is resident now.
class PeakMemory {
 public:
  PeakMemory() {
    ::malloc_trim(0);
    std::ofstream reset("/proc/self/clear_refs");
    reset << "5" << std::flush;  // proc(5): sets the high-water mark to what is resident
    if (reset.good()) {
      before_ = memory_line("VmRSS:");
    }
  }
  [[nodiscard]] double bytes() const { return memory_line("VmHWM:") - before_; }

 private:
  double before_ = ScalingCosts::kUnknown;
};

/// Passes find() on and adds up its time.
class TimedFinder final : public ContactFinder {
 public:
  explicit TimedFinder(collision::CollisionWorld& world) : world_(world) {}
  void find(const State& state, double margin, ContactSet& contacts) override {
    world_.find(state, margin, contacts);
    const collision::FindSeconds& now = world_.find_seconds();
    seconds_ += now.broad + now.narrow;
    least_ = {std::min(least_.broad, now.broad), std::min(least_.narrow, now.narrow)};
    pairs_asked_ += world_.pairs_asked();
  }
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const> motions,
                                                          double duration,
                                                          RestingPairs resting) override {
    return world_.first_contact(motions, duration, resting);
  }
  /// Of all finds since the last call.
  double take_seconds() { return std::exchange(seconds_, 0.0); }
  /// The least of all finds so far.
  [[nodiscard]] const collision::FindSeconds& least() const { return least_; }
  [[nodiscard]] long pairs_asked() const { return pairs_asked_; }

 private:
  collision::CollisionWorld& world_;
  double seconds_ = 0.0;
  collision::FindSeconds least_{std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::infinity()};
  long pairs_asked_ = 0;
};

/// Certifies every solve anew and counts what it took.
class Auditor final : public lcp::SolveRecorder {
 public:
  std::string record(const lcp::SolveRecord& solve) override {
    const auto add = [](long& sum, int count) { sum += std::max(count, 0); };
    ++counts_.solves;
    add(counts_.iterations, solve.result.statistics.iterations);
    add(counts_.pivots, solve.result.statistics.pivots);
    add(counts_.factorizations, solve.result.statistics.factorizations);
    if (lcp::is_solved(solve.result.status)) {
      const lcp::Certificate certificate = lcp::certify(solve.problem, solve.result.z);
      const lcp::Status status =
          lcp::judge(certificate, solve.settings.tolerance, lcp::Status::kStalled);
      wrong_ += lcp::is_solved(status) ? 0 : 1;
    }
    if (measures_floor_) {
      floor_ += measure_body_space_floor(solve.problem, solve.result.z);
    }
    return {};
  }
  void measure_floor() { measures_floor_ = true; }
  [[nodiscard]] const ScalingCounts& counts() const { return counts_; }
  [[nodiscard]] int wrong() const { return wrong_; }
  [[nodiscard]] double floor() const { return floor_; }

 private:
  ScalingCounts counts_{.solves = 0, .iterations = 0, .pivots = 0, .factorizations = 0};
  int wrong_ = 0;
  bool measures_floor_ = false;
  double floor_ = 0.0;
};

/// A scene and who steps it.
class Stepping {
 public:
  Stepping(const SteppedScene& scene, const std::string& accuracy, int threads,
           lcp::SolveRecorder* recorder)
      : world_(scene.bodies, scene.colliders, PairingRule::kMinimum),
        finder_(world_),
        stepper_(scene.bodies, finder_, settings(scene, accuracy, threads, recorder)),
        state_(scene.state) {}

  void step() { stepper_.step(state_, report_); }
  [[nodiscard]] const StepReport& report() const { return report_; }
  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] TimedFinder& finder() { return finder_; }

 private:
  static TimeStepSettings settings(const SteppedScene& scene, const std::string& accuracy,
                                   int threads, lcp::SolveRecorder* recorder) {
    TimeStepSettings settings;
    settings.step = scene.step;
    settings.gravity = scene.gravity;
    settings.margin = scene.margin;
    settings.touching_tolerance = 1e-4 * scene.margin;
    settings.accuracy = Accuracy::named(accuracy);
    settings.threads = threads;
    settings.lcp.recorder = recorder;
    return settings;
  }

  collision::CollisionWorld world_;
  TimedFinder finder_;
  TimeStepper stepper_;
  State state_;
  StepReport report_;
};

bool same_bits(const State& a, const State& b) {
  return std::ranges::equal(a, b, [](const BodyState& s, const BodyState& t) {
    return s.x == t.x && s.q.coeffs() == t.q.coeffs() && s.p == t.p && s.L == t.L;
  });
}

double farthest_moved(const State& start, const State& end) {
  double farthest = 0.0;
  for (std::size_t k = 0; k < start.size(); ++k) {
    farthest = std::max(farthest, (end[k].x - start[k].x).norm());
  }
  return farthest;
}

double deepest_overlap(const SteppedScene& scene, const State& state) {
  collision::CollisionWorld world(scene.bodies, scene.colliders, PairingRule::kMinimum);
  ContactSet contacts;
  world.find(state, 0.0, contacts);
  double depth = 0.0;
  for (const Contact& contact : contacts) {
    depth = std::max(depth, -contact.gap);
  }
  return depth;
}

double scene_error(const ScalingScene& scaling, const State& end) {
  return scaling.is_at_rest ? farthest_moved(scaling.scene.state, end)
                            : deepest_overlap(scaling.scene, end);
}

/// What a step must read or write once at the very least: bodies and their states twice, contacts
/// twice, and of every row its two blocks of J, q, z and w.
double touched_bytes(const ScalingScene& scaling, const ScalingCounts& counts) {
  const auto bodies = static_cast<double>(scaling.scene.bodies.size());
  constexpr double kRowNumbers = 2.0 * 6.0 + 3.0;
  return bodies * (2.0 * sizeof(BodyState) + sizeof(Body)) +
         2.0 * sizeof(Contact) * static_cast<double>(counts.contacts) +
         sizeof(double) * kRowNumbers * static_cast<double>(counts.rows);
}

/// What the audited run found.
struct Audit {
  std::string failure;
  ScalingCounts counts;
  double residual = 0.0;
  double error = 0.0;
  double floor = 0.0;
  State end;
};

Audit audit(const ScalingScene& scaling, const ScalingRunOptions& options) {
  Auditor auditor;
  Stepping stepping(scaling.scene, options.accuracy, 1, &auditor);
  Audit audit;
  const int last = options.steps + 1;  // the first, those that are timed, that of the allocations
  for (int k = 0; k <= last && audit.failure.empty(); ++k) {
    if (k == last) {
      auditor.measure_floor();
    }
    stepping.step();
    const StepReport& report = stepping.report();
    for (const IslandReport& island : report.islands) {
      audit.residual = std::max(audit.residual, island.residual);
    }
    if (!lcp::is_solved(report.status)) {
      audit.failure = fmt::format("step {}: {}, residual {:.1e} m/s", k,
                                  lcp::to_string(report.status), audit.residual);
    }
  }
  audit.counts = auditor.counts();
  audit.counts.contacts = static_cast<long>(stepping.report().contacts.size());
  audit.counts.rows = stepping.report().rows;
  audit.counts.islands = static_cast<long>(stepping.report().islands.size());
  audit.counts.pairs_asked = stepping.finder().pairs_asked();
  audit.floor = auditor.floor();
  audit.end = stepping.state();
  audit.error = scene_error(scaling, audit.end);
  if (audit.failure.empty() && auditor.wrong() > 0) {
    audit.failure =
        fmt::format("{} solves that the full certificate does not bear out", auditor.wrong());
  }
  if (audit.failure.empty() && scaling.is_at_rest && !(audit.error <= kMostDrift)) {
    audit.failure = fmt::format("a body that should rest moved by {:.1e} m", audit.error);
  }
  return audit;
}

/// The steps that are timed.
class StepTimes {
 public:
  void add(double step, const StageSeconds& stages, double find) {
    const double wall = stages.find + stages.solve + stages.project;
    steps_.push_back({step, wall / step, stages,
                      std::max(0.0, wall - find - stages.assemble - stages.solvers - stages.move)});
  }
  void write(bool with_stages, ScalingCosts& costs) const {
    std::vector<double> seconds;
    for (const Step& step : steps_) {
      seconds.push_back(step.seconds);
    }
    costs.step = median(seconds);
    if (!with_stages) {
      return;
    }
    const Step* chosen = nullptr;
    for (const Step& step : steps_) {
      if (step.seconds >= costs.step && (chosen == nullptr || step.delay < chosen->delay)) {
        chosen = &step;
      }
    }
    costs.rows = chosen->stages.assemble;
    costs.solvers = chosen->stages.solvers;
    costs.move = chosen->stages.move;
    costs.rest = chosen->rest;
  }

 private:
  struct Step {
    double seconds;
    double delay;  // wall over CPU time: how much others had the processor
    StageSeconds stages;
    double rest;
  };
  std::vector<Step> steps_;
};

/// The timed run with so many threads: CPU time on one, wall time on more.
void time_steps(const ScalingScene& scaling, int threads, const Audit& audit, ScalingRow& row) {
  const bool alone = threads == 1;
  const auto now = [&] { return alone ? thread_seconds() : wall_seconds(); };
  const PeakMemory peak;
  const double before = allocated_bytes();
  Stepping stepping(scaling.scene, row.accuracy, threads, nullptr);
  StepTimes times;
  for (int k = 0; k <= row.steps; ++k) {
    const double start = now();
    stepping.step();
    const double spent = now() - start;
    const double find = stepping.finder().take_seconds();
    if (k == 0) {
      row.costs.first_step = spent;
      if (alone) {
        row.costs.broad = stepping.finder().least().broad;
        row.costs.narrow = stepping.finder().least().narrow;
      }
    } else {
      times.add(spent, stepping.report().seconds, find);
    }
  }
  times.write(alone, row.costs);
  if (alone) {
    row.costs.held_bytes = allocated_bytes() - before;
    row.costs.peak_bytes = peak.bytes();
  }
  const lcp::AllocationCount allocations;
  stepping.step();
  if (alone) {
    row.counts.allocations = allocations.count();
    row.counts.back_end_allocations = allocations.back_end_count();
  }
  if (!same_bits(stepping.state(), audit.end)) {
    row.failure = "the timed run ended in other bits than the audited one";
    row.is_wrong = true;
  }
}

std::vector<ScalingRow> run_here(const ScalingCase& what, const ScalingRunOptions& options) {
  ScalingRow row{.scene = what.scene,
                 .bodies = what.bodies,
                 .engine = kOurEngine,
                 .accuracy = options.accuracy,
                 .steps = options.steps};
  const ScalingScene scaling = make_scaling_scene(what.scene, what.bodies);
  const Audit checked = audit(scaling, options);
  row.counts = checked.counts;
  row.costs.residual = checked.residual;
  row.costs.error = checked.error;
  row.costs.floor = checked.floor;
  row.costs.touched_bytes = touched_bytes(scaling, checked.counts);
  row.failure = checked.failure;
  row.is_wrong = !checked.failure.empty();
  if (row.is_wrong) {
    return {row};
  }
  std::vector<ScalingRow> rows;
  for (const int threads : options.threads) {
    rows.push_back(row);
    rows.back().threads = threads;
    time_steps(scaling, threads, checked, rows.back());
  }
  return rows;
}

/// What a child that has no answer leaves.
ScalingRow without_answer(const ScalingCase& what, const std::string& engine,
                          const ScalingRunOptions& options, const tools::ChildAnswer& answer) {
  const bool is_limit =
      answer.end == tools::ChildEnd::kTimedOut || answer.reason == "out of memory";
  return {.scene = what.scene,
          .bodies = what.bodies,
          .engine = engine,
          .accuracy = engine == kOurEngine ? options.accuracy : "",
          .steps = options.steps,
          .failure = answer.reason,
          .is_wrong = !is_limit};
}

tools::ChildLimits limits(const ScalingRunOptions& options) {
  return {.seconds = options.cpu_seconds,
          .loading_seconds = options.cpu_seconds,
          .bytes = options.bytes};
}

}  // namespace

std::vector<ScalingRow> run_scaling_case(const ScalingCase& what,
                                         const ScalingRunOptions& options) {
  const tools::ChildAnswer answer = tools::run_in_child(
      [&](const std::function<void()>&) { return tools::to_bytes(run_here(what, options)); },
      limits(options));
  if (answer.end != tools::ChildEnd::kAnswered) {
    return {without_answer(what, kOurEngine, options, answer)};
  }
  return tools::from_bytes<std::vector<ScalingRow>>(answer.answer);
}

#ifdef SIGNORINI_PEER_BULLET

ScalingRow run_bullet_scaling_case(const ScalingCase& what, int iterations,
                                   const ScalingRunOptions& options) {
  const Contestant bullet = bullet_stepper(iterations);
  const auto run = [&](const std::function<void()>&) {
    ScalingRow row{
        .scene = what.scene, .bodies = what.bodies, .engine = bullet.name, .steps = options.steps};
    const ScalingScene scaling = make_scaling_scene(what.scene, what.bodies);
    const PeakMemory peak;
    const std::unique_ptr<ScenePlayer> player = bullet.start(scaling.scene);
    std::vector<double> times;
    for (int k = 0; k <= options.steps; ++k) {
      const double start = thread_seconds();
      player->step();
      (k == 0 ? row.costs.first_step : times.emplace_back()) = thread_seconds() - start;
    }
    row.costs.step = median(times);
    row.costs.peak_bytes = peak.bytes();
    player->step();  // as ours, that of the allocations
    row.costs.error = scene_error(scaling, player->poses());
    return tools::to_bytes(row);
  };
  const tools::ChildAnswer answer = tools::run_in_child(run, limits(options));
  return answer.end == tools::ChildEnd::kAnswered
             ? tools::from_bytes<ScalingRow>(answer.answer)
             : without_answer(what, bullet.name, options, answer);
}

#endif

}  // namespace signorini::bench
