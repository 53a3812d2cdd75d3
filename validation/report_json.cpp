#include <signorini/validation/playback_json.h>
#include <signorini/validation/report_json.h>
#include <signorini/validation/series_thinning.h>
#include <signorini/validation/worst_check.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>

namespace signorini::validation {
namespace {

using Json = nlohmann::ordered_json;
/// The lines of a plot, whole or as the page wants them.
using LinesToJson = std::function<Json(const std::vector<Series>&)>;

constexpr std::size_t kMaxPointsOnPage = 900;

/// JSON has no NaN and no infinity: they are strings that JavaScript's Number() and Python's
/// float() read.
Json number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0.0 ? "Infinity" : "-Infinity";
  return value;
}

Json numbers(const std::vector<double>& values) {
  Json result = Json::array();
  for (const double value : values) result.push_back(number(value));
  return result;
}

Json seconds(double value) {
  return value < 0.0 ? Json(nullptr) : number(value);
}

double rounded_to_7_digits(double value) {
  return std::isfinite(value) ? std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr) : value;
}

Json series_json(const Series& series) {
  return {{"name", series.name},
          {"engine", series.engine},
          {"x", numbers(series.x)},
          {"y", numbers(series.y)}};
}

Json whole_lines(const std::vector<Series>& lines) {
  Json result = Json::array();
  for (const Series& line : lines) result.push_back(series_json(line));
  return result;
}

Json page_lines(const std::vector<Series>& lines) {
  Json result = Json::array();
  for (Series& line : thinned(lines, kMaxPointsOnPage)) {
    std::transform(line.x.begin(), line.x.end(), line.x.begin(), rounded_to_7_digits);
    std::transform(line.y.begin(), line.y.end(), line.y.begin(), rounded_to_7_digits);
    result.push_back(series_json(line));
    result.back()["points"] = lines[result.size() - 1].x.size();
  }
  return result;
}

Json check_json(const Check& check) {
  return {{"name", check.name},
          {"engine", check.engine},
          {"reference", check.reference},
          {"unit", check.unit},
          {"value", number(check.value)},
          {"expected", number(check.expected)},
          {"error", number(check.error)},
          {"tolerance", number(check.tolerance)},
          {"error_kind", check.error_kind},
          {"reason", check.reason},
          {"verdict", to_string(check.judged())}};
}

Json plot_json(const Plot& plot, const LinesToJson& lines_json) {
  return {{"title", plot.title},
          {"x_label", plot.x_label},
          {"y_label", plot.y_label},
          {"log_y", plot.log_y},
          {"series", lines_json(plot.series)}};
}

Json table_json(const Table& table) {
  return {{"title", table.title}, {"header", table.header}, {"rows", table.rows}};
}

Json point_json(const TradePoint& point) {
  return {{"solver", point.solver},
          {"engine", point.engine},
          {"step", number(point.step)},
          {"error", number(point.error)},
          {"whole_seconds", seconds(point.whole_seconds)},
          {"solver_seconds", seconds(point.solver_seconds)}};
}

Json trade_json(const Trade& trade) {
  Json result = {{"error", trade.error},
                 {"unit", trade.unit},
                 {"reference", trade.reference},
                 {"scale", number(trade.scale)},
                 {"duration", number(trade.duration)},
                 {"points", Json::array()},
                 {"losses", Json::array()}};
  for (const TradePoint& point : trade.points) result["points"].push_back(point_json(point));
  for (const Loss& loss : losses(trade)) {
    result["losses"].push_back({{"theirs", loss.theirs},
                                {"ours", loss.reached ? Json(loss.ours) : Json(nullptr)},
                                {"factor", number(loss.factor)}});
  }
  return result;
}

/// The index of a check of this scene, null for none.
Json check_index(const SceneReport& scene, const Check* check) {
  return check == nullptr ? Json(nullptr) : Json(check - scene.checks.data());
}

Json scene_json(const SceneReport& scene, const LinesToJson& lines_json) {
  const Check* worst = worst_check(scene);
  const Check* bullets = worst == nullptr ? nullptr : bullets_counterpart(scene, *worst);
  Json result = {{"name", scene.name},
                 {"title", scene.title},
                 {"description", scene.description},
                 {"source", scene.source},
                 {"builtin", scene.builtin},
                 {"command", scene.command},
                 {"verdict", to_string(scene.verdict())},
                 {"worst_check", check_index(scene, worst)},
                 {"bullet_beside", check_index(scene, bullets)},
                 {"signorini_seconds", seconds(scene.signorini_seconds)},
                 {"bullet_seconds", seconds(scene.bullet_seconds)},
                 {"signorini_solver_seconds", seconds(scene.signorini_solver_seconds)},
                 {"bullet_solver_seconds", seconds(scene.bullet_solver_seconds)},
                 {"settings", scene.settings},
                 {"notices", scene.notices},
                 {"checks", Json::array()},
                 {"plots", Json::array()},
                 {"tables", Json::array()},
                 {"trade", scene.trade ? trade_json(*scene.trade) : Json(nullptr)}};
  for (const Check& check : scene.checks) result["checks"].push_back(check_json(check));
  for (const Plot& plot : scene.plots) result["plots"].push_back(plot_json(plot, lines_json));
  for (const Table& table : scene.tables) result["tables"].push_back(table_json(table));
  result["playback"] = scene.playback ? playback_json(*scene.playback) : Json(nullptr);
  return result;
}

/// How many scenes have each verdict.
Json summary_json(const Report& report) {
  Json result = {{"scenes", report.scenes.size()}};
  for (const Verdict verdict : {Verdict::kPass, Verdict::kFail, Verdict::kInformation}) {
    result[std::string(to_string(verdict))] =
        std::count_if(report.scenes.begin(), report.scenes.end(),
                      [verdict](const auto& scene) { return scene.verdict() == verdict; });
  }
  return result;
}

Json maybe(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

Json arguments_json(const RunArguments& arguments) {
  return {{"engine", arguments.engine},
          {"duration", maybe(arguments.duration)},
          {"bullet_profile", arguments.bullet_profile},
          {"skip_unsupported", arguments.skip_unsupported},
          {"ground", maybe(arguments.ground)},
          {"trade", arguments.trade}};
}

std::string dump(const Report& report, const LinesToJson& lines_json) {
  Json result = {{"schema", "signorini-report"},    {"schema_version", Report::kSchemaVersion},
                 {"command", report.command},       {"arguments", arguments_json(report.arguments)},
                 {"version", report.version},       {"engines", report.engines},
                 {"partial", report.partial},       {"jobs", report.jobs},
                 {"summary", summary_json(report)}, {"scenes", Json::array()}};
  for (std::size_t i = 0; i < report.scenes.size(); ++i) {
    result["scenes"].push_back(scene_json(report.scenes[i], lines_json));
    result["scenes"].back()["file"] = scene_file_name(report, i);
  }
  return result.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string scene_file_name(const Report& report, std::size_t index) {
  std::string name;
  for (const char character : report.scenes[index].name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(character)) != 0 ||
                       character == '-' || character == '.' || character == '_';
    name += plain ? character : '_';
  }
  const bool is_bullet = report.scenes[index].source.ends_with(".bullet");
  return fmt::format("scenes/{:02}-{}.{}", index + 1, name, is_bullet ? "bullet" : "sdf");
}

std::string report_json(const Report& report) {
  return dump(report, whole_lines) + "\n";
}

std::string report_page_json(const Report& report) {
  std::string result;
  for (const char character : dump(report, page_lines)) {
    if (character == '<') {
      result += "\\u003c";
    } else {
      result += character;
    }
  }
  return result;
}

}  // namespace signorini::validation
