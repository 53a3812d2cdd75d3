#pragma once

#include <signorini/core/response/time_stepper.h>
#include <signorini/validation/bullet_profile.h>
#include <signorini/validation/report.h>
#include <signorini/validation/run_control.h>
#include <signorini/validation/scene.h>
#include <signorini/validation/track.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace signorini::validation {

/// What the caller of a validation chose.
struct RunOptions {
  bool signorini = true;
  bool bullet = true;
  std::optional<double> duration;  ///< s; overrides the scene's own
  BulletProfile profile = BulletProfile::neutral();
  /// Of our runs, by the dial; none: step_settings() as they are.
  std::optional<Accuracy> accuracy = std::nullopt;
  /// Of our runs; none: the scene's own, or time stepping where the dial is given.
  std::optional<Stepper> stepper = std::nullopt;
  const StopFlag* stop = nullptr;
  StepWatcher watch = nullptr;  ///< empty: nobody watches
  bool keep_stopped = false;    ///< a run that was stopped is kept, shorter, as it is
  bool studies = true;  ///< what a scene shows beside its stepped runs: laws, orders, convergence
  bool trade = false;   ///< run the scene in further ways for error against cost
  lcp::SolveRecorder* recorder = nullptr;  ///< is told of every contact problem of ours
};

/// The options that the arguments of a report stand for.
/// @throws std::invalid_argument for a profile that there is not
[[nodiscard]] RunOptions options_of(const RunArguments& arguments);

/// The run was stopped, and is not kept: the scene has no report.
struct RunInterrupted {};

/// Both engines' runs of one scene; null where the engine was not asked for.
struct Runs {
  std::optional<Track> signorini;
  std::optional<Track> bullet;

  /// Calls f for each run that exists.
  void for_each(const std::function<void(const Track&)>& f) const {
    if (signorini) f(*signorini);
    if (bullet) f(*bullet);
  }
};

/// The checks that count them.
inline constexpr const char* kUnsolvedSteps = "steps whose contact problem was not solved";

inline constexpr const char* kBrokenRuns = "runs that ended with a number that is not finite";

/// Are unsolved steps of ours a failure of the scene, or what it is there to show?
enum class UnsolvedSteps : unsigned char { kFail, kShow };

/// Runs the scene in the engines chosen. Writes settings, seconds, notices and the playback into
/// the report, and the checks that every scene has: every step of ours solved, every number finite.
/// @throws RunInterrupted
[[nodiscard]] Runs run_engines(const Scene& scene, const RunOptions& options, SceneReport& report,
                               UnsolvedSteps unsolved = UnsolvedSteps::kFail);

/// A run of ours apart from the report's, with the caller's stop flag. @throws RunInterrupted
[[nodiscard]] Track run_ours(const Scene& scene, const TimeStepSettings& settings,
                             const RunOptions& options);
/// @throws RunInterrupted
[[nodiscard]] Track run_theirs(const Scene& scene, const BulletProfile& profile,
                               const RunOptions& options);

/// A number of a track as a function of its sample.
using Measure = std::function<double(const Track&, std::size_t)>;
/// One line an engine, and the closed form (of time) if given.
[[nodiscard]] Plot plot_over_time(const std::string& title, const std::string& y_label,
                                  const Runs& runs, const Measure& measure,
                                  const std::function<double(double)>& closed_form = nullptr);
/// "energy of ..." and "deepest overlap": the plots that every scene has.
void add_energy_and_overlap_plots(const Runs& runs, SceneReport& report);

/// Numbers for tables.
[[nodiscard]] std::string text(double value);
[[nodiscard]] std::string text(const Vec3& value);

}  // namespace signorini::validation
