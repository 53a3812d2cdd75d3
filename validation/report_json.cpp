#include <signorini/validation/report_json.h>
#include <signorini/validation/series_thinning.h>
#include <signorini/validation/worst_check.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>

namespace signorini::validation {
namespace {

using Json = nlohmann::ordered_json;
using SeriesToJson = std::function<Json(const Series&)>;

constexpr std::size_t kStretchesOnPage = 300;

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

Json whole_series(const Series& series) {
  return {{"name", series.name},
          {"engine", series.engine},
          {"x", numbers(series.x)},
          {"y", numbers(series.y)}};
}

Json page_series(const Series& series) {
  Series drawn = thinned(series, kStretchesOnPage);
  std::transform(drawn.x.begin(), drawn.x.end(), drawn.x.begin(), rounded_to_7_digits);
  std::transform(drawn.y.begin(), drawn.y.end(), drawn.y.begin(), rounded_to_7_digits);
  Json result = whole_series(drawn);
  result["points"] = series.x.size();
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

Json plot_json(const Plot& plot, const SeriesToJson& series_json) {
  Json result = {{"title", plot.title},
                 {"x_label", plot.x_label},
                 {"y_label", plot.y_label},
                 {"log_y", plot.log_y},
                 {"series", Json::array()}};
  for (const Series& series : plot.series) result["series"].push_back(series_json(series));
  return result;
}

Json table_json(const Table& table) {
  return {{"title", table.title}, {"header", table.header}, {"rows", table.rows}};
}

/// The index of a check of this scene, null for none.
Json check_index(const SceneReport& scene, const Check* check) {
  return check == nullptr ? Json(nullptr) : Json(check - scene.checks.data());
}

Json scene_json(const SceneReport& scene, const SeriesToJson& series_json) {
  const Check* worst = worst_check(scene);
  const Check* bullets = worst == nullptr ? nullptr : bullets_counterpart(scene, *worst);
  Json result = {{"name", scene.name},
                 {"title", scene.title},
                 {"description", scene.description},
                 {"source", scene.source},
                 {"command", scene.command},
                 {"verdict", to_string(scene.verdict())},
                 {"worst_check", check_index(scene, worst)},
                 {"bullet_beside", check_index(scene, bullets)},
                 {"signorini_seconds", seconds(scene.signorini_seconds)},
                 {"bullet_seconds", seconds(scene.bullet_seconds)},
                 {"settings", scene.settings},
                 {"notices", scene.notices},
                 {"checks", Json::array()},
                 {"plots", Json::array()},
                 {"tables", Json::array()}};
  for (const Check& check : scene.checks) result["checks"].push_back(check_json(check));
  for (const Plot& plot : scene.plots) result["plots"].push_back(plot_json(plot, series_json));
  for (const Table& table : scene.tables) result["tables"].push_back(table_json(table));
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

std::string dump(const Report& report, const SeriesToJson& series_json) {
  Json result = {{"schema", "signorini-report"},    {"schema_version", Report::kSchemaVersion},
                 {"command", report.command},       {"version", report.version},
                 {"engines", report.engines},       {"partial", report.partial},
                 {"summary", summary_json(report)}, {"scenes", Json::array()}};
  for (const SceneReport& scene : report.scenes) {
    result["scenes"].push_back(scene_json(scene, series_json));
  }
  return result.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string report_json(const Report& report) {
  return dump(report, whole_series) + "\n";
}

std::string report_page_json(const Report& report) {
  std::string result;
  for (const char character : dump(report, page_series)) {
    if (character == '<') {
      result += "\\u003c";
    } else {
      result += character;
    }
  }
  return result;
}

}  // namespace signorini::validation
