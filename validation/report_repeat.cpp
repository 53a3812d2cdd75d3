#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/bullet_file.h>
#include <signorini/validation/drop_in.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/report_json.h>
#include <signorini/validation/report_repeat.h>
#include <signorini/validation/sdf_reader.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

namespace signorini::validation {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 11> kLeftOut = {"signorini_seconds",
                                                       "bullet_seconds",
                                                       "signorini_solver_seconds",
                                                       "bullet_solver_seconds",
                                                       "whole_seconds",
                                                       "solver_seconds",
                                                       "losses",
                                                       "command",
                                                       "jobs",
                                                       "version",
                                                       "engines"};

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw InputError(path.string() + ": cannot be read");
  return text.str();
}

Json read_report(const std::filesystem::path& path) {
  const Json report = Json::parse(read_text(path), nullptr, false);
  if (!report.is_object() || report.value("schema", "") != "signorini-report" ||
      report.value("schema_version", 0) != Report::kSchemaVersion ||
      !report.contains("arguments")) {
    throw InputError(fmt::format("{}: expected a signorini-report of schema version {}",
                                 path.string(), Report::kSchemaVersion));
  }
  return report;
}

std::optional<double> maybe(const Json& value) {
  return value.is_null() ? std::nullopt : std::optional<double>(value.get<double>());
}

RunArguments read_arguments(const Json& json) {
  RunArguments arguments;
  arguments.engine = json.at("engine");
  arguments.duration = maybe(json.at("duration"));
  arguments.bullet_profile = json.at("bullet_profile");
  arguments.skip_unsupported = json.at("skip_unsupported");
  arguments.ground = maybe(json.at("ground"));
  arguments.trade = json.at("trade");
  return arguments;
}

SceneReport repeat_scene(const std::filesystem::path& folder, const Json& json,
                         const RunArguments& arguments, const RunOptions& options) {
  const std::string text = read_text(folder / json.at("file").get<std::string>());
  const std::string source = json.at("source");
  const std::string name = json.at("name");
  if (!json.at("builtin").get<bool>()) {
    Scene scene = read_any_scene_text(text, source, {arguments.skip_unsupported, arguments.ground});
    return validate_scene(std::move(scene), options);
  }
  if (const DropInScene* drop_in = find_drop_in_scene(name)) {
    return validate_drop_in(*drop_in, options);
  }
  const BuiltinScene* builtin = find_builtin_scene(name);
  if (builtin == nullptr)
    throw InputError(name + ": this program has no built-in scene of that name");
  Scene scene = read_scene_text(text, source);
  scene.name = name;
  return validate_builtin(*builtin, std::move(scene), options);
}

/// Walks two values side by side.
class Comparison {
 public:
  explicit Comparison(RepeatedReport& result) : result_(result) {}

  void compare(const Json& a, const Json& b, const std::string& where) {
    if (a.is_object() && b.is_object()) {
      compare_objects(a, b, where);
    } else if (a.is_array() && b.is_array() && a.size() == b.size()) {
      for (std::size_t i = 0; i < a.size(); ++i) {
        compare(a[i], b[i], fmt::format("{}[{}]", where, i));
      }
    } else {
      if (a.is_number()) ++result_.numbers;
      if (a != b) result_.differences.push_back(where + ": " + brief(a) + ", again " + brief(b));
    }
  }

 private:
  void compare_objects(const Json& a, const Json& b, const std::string& where) {
    for (const auto& [key, value] : a.items()) {
      if (std::find(kLeftOut.begin(), kLeftOut.end(), key) != kLeftOut.end()) continue;
      const std::string here = where.empty() ? key : where + "." + key;
      if (b.contains(key)) {
        compare(value, b.at(key), here);
      } else {
        result_.differences.push_back(here + ": missing again");
      }
    }
  }

  static std::string brief(const Json& value) {
    const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() <= 80 ? text : text.substr(0, 77) + "...";
  }

  RepeatedReport& result_;
};

RepeatedReport repeat(
    const std::filesystem::path& path, const Json& before, const StopFlag* stop,
    const std::function<void(std::size_t, std::size_t, const std::string&)>& on_scene) {
  Report report;
  report.arguments = read_arguments(before.at("arguments"));
  report.partial = before.at("partial");
  RunOptions options = options_of(report.arguments);
  options.stop = stop;
  const Json& scenes = before.at("scenes");
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    on_scene(i, scenes.size(), scenes[i].at("name"));
    report.scenes.push_back(repeat_scene(path, scenes[i], report.arguments, options));
  }
  RepeatedReport result;
  result.scenes = scenes.size();
  Comparison(result).compare(before, Json::parse(report_json(report)), "");
  return result;
}

}  // namespace

RepeatedReport repeat_report(
    const std::string& folder, const StopFlag* stop,
    const std::function<void(std::size_t, std::size_t, const std::string&)>& on_scene) {
  const std::filesystem::path path(folder);
  const Json before = read_report(path / "report.json");
  try {
    return repeat(path, before, stop, on_scene);
  } catch (const Json::exception& error) {  // a field that is missing or of another type
    throw InputError((path / "report.json").string() + ": " + error.what());
  }
}

}  // namespace signorini::validation
