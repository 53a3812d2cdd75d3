#pragma once

#include "bench/peers_study.h"
#include "bench/performance_profile.h"

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace signorini::bench {

/// The runs of one dial position: every solver on every problem, told this tolerance.
struct DialRuns {
  double tolerance = 1e-8;  ///< natural residual that was asked for
  PeersResult result;
};

/// A problem or a scene, by what decides which solver suits it.
struct ProblemClass {
  std::string form;           ///< "lcp", "pyramid", "box", "cone" ...; "stands", "slides" ...
  int size = 0;               ///< upper bound of the class: class_size()
  std::string unit = "rows";  ///< of the size; "bodies" of scenes
  [[nodiscard]] bool operator==(const ProblemClass&) const = default;
  [[nodiscard]] bool is_scene() const { return unit == "bodies"; }
};

/// The smallest class that holds so many rows or bodies: 16, 64, 256 ...
[[nodiscard]] int class_size(int count);

/// A solver at a position of its dial, on one problem or scene.
struct TradeRun {
  std::string problem;  ///< with its form: unique
  ProblemClass which;
  std::string solver;
  std::string library;
  bool is_refused = false;
  double error = std::numeric_limits<double>::quiet_NaN();  ///< NaN: there is no answer
  double seconds = -1.0;                                    ///< < 0: there is no answer
  /// What counts where no answer is good enough, in the unit of `seconds` (of a scene for one
  /// simulated second, as they are): the limit of the run; > 0, the same of all runs of a problem.
  double limit_seconds = 0.0;
};

/// The runs of solvers on problems: their error is the natural residual of the certificate.
/// @param limit_seconds of each run
[[nodiscard]] std::vector<TradeRun> trade_runs(std::span<const DialRuns> dial,
                                               double limit_seconds);

/// A solver over the problems of a class at a level of error. What an answer errs is judged by the
/// runner, of a problem on the caller's data, of a scene by its closed form; what was asked for
/// does not count. Of the dial's positions the fastest whose answer is good enough counts.
struct LevelScore {
  ProblemClass which;
  double level = 1e-8;  ///< of the error
  std::string solver;
  std::string library;
  int problems = 0;  ///< of the class that the solver did not refuse
  int solved = 0;
  int refused = 0;
  /// Shifted geometric mean exp(mean(log(t + s))) - s of the seconds, s = kShiftSeconds, what was
  /// not solved counting as the run's limit (Mittelmann's benchmarks); s.
  double mean_seconds = 0.0;
};

inline constexpr double kShiftSeconds = 1e-4;

/// All classes, levels and solvers, in the order in which they first appear; solvers that refused
/// every problem of a class are left out.
[[nodiscard]] std::vector<LevelScore> level_scores(std::span<const TradeRun> runs,
                                                   std::span<const double> levels);

/// One score a solver and class: its level is the worst error of its runs there (at least
/// kLeastError), and it is left out where a run came to no answer. For pictures.
[[nodiscard]] std::vector<LevelScore> worst_error_scores(std::span<const TradeRun> runs);
inline constexpr double kLeastError = 1e-16;

/// The scores that no other of the same class beats in level and mean time: error against time.
/// Only scores that solved all problems of the class, refused ones included.
[[nodiscard]] std::vector<LevelScore> pareto_front(std::span<const LevelScore> scores,
                                                   const ProblemClass& which);

/// Performance profiles at a level, one panel a form, over the problems on which all its solvers
/// have been.
[[nodiscard]] std::vector<ProfilePanel> level_profiles(std::span<const TradeRun> runs,
                                                       double level);

/// One line a run and dial position: what was asked, what the answer errs, seconds.
[[nodiscard]] std::string tradeoff_csv(std::span<const DialRuns> dial);
/// One line a score.
[[nodiscard]] std::string scores_csv(std::span<const LevelScore> scores);

/// The page: remarks, and of scenes and of problems (where there are any) the recommendation table
/// (for this error, at this size, use this: of our solvers that solved all problems of the class
/// the fastest, or a more accurate one that takes at most a tenth more; where a peer is faster, or
/// solves more, the peer as well), the Pareto fronts, success rates with
/// mean times.
[[nodiscard]] std::string tradeoff_markdown(std::span<const LevelScore> problems,
                                            std::span<const LevelScore> scenes,
                                            const std::vector<std::string>& remarks);
/// The recommendation tables alone.
[[nodiscard]] std::string recommendations_markdown(std::span<const LevelScore> problems,
                                                   std::span<const LevelScore> scenes);

/// Error against time as an SVG file, two panels a row, one a form of problems at its largest class
/// and one each class of scenes: a dot a
/// solver and level that solved everything, the Pareto front as a line.
[[nodiscard]] std::string pareto_svg(std::span<const LevelScore> scores, const std::string& title);

}  // namespace signorini::bench
