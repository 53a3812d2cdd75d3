#pragma once

#include <signorini/validation/playback.h>
#include <signorini/validation/trade.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace signorini::validation {

/// What is known about a number.
enum class Verdict : unsigned char {
  kPass,
  kFail,
  kInformation,  ///< shown, not judged (what the other engine measures, where no tolerance is owed)
};

/// "pass", "fail" or "information": the words of report.json.
[[nodiscard]] std::string_view to_string(Verdict verdict);

/// kPass if error <= tolerance, else kFail; NaN in either fails. Units: those of the check.
[[nodiscard]] Verdict judge(double error, double tolerance);

/// One comparison of a scene: a value, what it should be, and the tolerance with its reason.
/// Two checks of a scene with the same name and different engines are shown beside each other.
struct Check {
  std::string name;       ///< "apex height after the first bounce"
  std::string engine;     ///< "signorini" or "bullet"
  std::string reference;  ///< "closed form", "bullet", "conservation law", "exact arithmetic"
  std::string unit;       ///< "m", "J", "1" ...
  double value = 0.0;
  double expected = 0.0;
  double error = 0.0;      ///< as the tolerance measures it
  double tolerance = 0.0;  ///< error <= tolerance passes; ignored for kInformation
  std::string error_kind;  ///< "absolute" or "relative"
  std::string reason;      ///< why this tolerance, or where the closed form comes from
  Verdict verdict = Verdict::kInformation;

  /// The verdict, except that a claimed kPass whose error is not <= tolerance is a kFail. This is
  /// what the report shows and what SceneReport::verdict() counts.
  [[nodiscard]] Verdict judged() const;
};

/// One line of a plot. NaN in y is a gap in the line; equal neighbours in x draw a jump.
struct Series {
  std::string name;       ///< "height of the ball"
  std::string engine;     ///< "signorini", "bullet" or "closed form": sets the colour
  std::vector<double> x;  ///< ascending, finite
  std::vector<double> y;  ///< as many as x
};

struct Plot {
  std::string title;
  std::string x_label;  ///< with unit: "time [s]"
  std::string y_label;
  bool log_y = false;
  std::vector<Series> series;
};

/// Free text and numbers, for what is no time series: the wedge's rows, the cradle's laws.
struct Table {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct SceneReport {
  std::string name;  ///< "ball-drop-e0.5"
  std::string title;
  std::string description;  ///< a paragraph: what happens, what is compared, where it comes from
  std::string source;       ///< the scene's file, or "built in code: SDF cannot say it"
  std::string text;      ///< of the scene's file: kept beside the report, to repeat it from there
  bool builtin = false;  ///< judged by checks of this program, not by the generic ones
  std::string command;   ///< repeats this scene
  std::vector<std::string> settings;  ///< how each engine was run; Bullet's profile, printed whole
  std::vector<std::string> notices;   ///< what of the file was ignored, and anything odd
  std::vector<Check> checks;
  std::vector<Plot> plots;
  std::vector<Table> tables;
  std::optional<Trade> trade;       ///< error against cost; none: the scene names no error
  double signorini_seconds = -1.0;  ///< wall time of the steps; -1: not run
  double bullet_seconds = -1.0;
  std::optional<Playback> playback;        ///< none: nothing moved, or a single impact was judged
  double signorini_solver_seconds = -1.0;  ///< of that inside the solver of contacts
  double bullet_solver_seconds = -1.0;

  /// kFail if any check failed, kPass if at least one passed and none failed, else kInformation.
  [[nodiscard]] Verdict verdict() const;
};

/// What of a command line decides the numbers of a report.
struct RunArguments {
  std::string engine = "both";
  std::optional<double> duration;
  std::string bullet_profile = "neutral";
  bool skip_unsupported = false;
  std::optional<double> ground;
  bool trade = true;
};

struct Report {
  static constexpr int kSchemaVersion = 1;
  std::string command;  ///< the whole command line
  RunArguments arguments;
  std::string version;   ///< of signorini
  std::string engines;   ///< versions: Bullet's, libsdformat's
  bool partial = false;  ///< the run was interrupted
  std::string jobs;      ///< how its scenes shared a machine; empty: one after the other
  std::vector<SceneReport> scenes;
};

/// report.json, report.md, the scenes' files (scenes/01-NAME.sdf ...) and (if the build had node)
/// report.html in a folder, which is created if need be. Each file is written whole or not at all:
/// beside its place, then renamed over it. In report.json and report.html, text that is not UTF-8
/// is written with U+FFFD in place of the bad bytes. The fields of report.json are documented in
/// docs/report-schema.md; NaN and infinity are the strings "NaN", "Infinity" and
/// "-Infinity". report.html carries the plots thinned to at most 900 points a line (the lowest and
/// the highest of each stretch are kept) and 7 digits; report.json carries them whole.
///
/// @return the paths of the files written. Without report.html, report.md says why.
/// @throws std::invalid_argument naming scene, plot or table and field, before anything is written:
///   a series whose x and y differ in length, or whose x is not finite and ascending; a table row
///   that is not as long as the header.
/// @throws std::runtime_error naming the file that could not be written, with the system's reason.
///   Files written before it stay; the one named is as it was before the call.
std::vector<std::string> write_report(const Report& report, const std::string& folder);

}  // namespace signorini::validation
