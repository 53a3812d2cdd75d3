#include <signorini/validation/report.h>
#include <signorini/validation/report_json.h>
#include <signorini/validation/report_markdown.h>
#include <signorini/validation/report_page.h>

#include "tools/whole_file.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace signorini::validation {
namespace {

[[noreturn]] void fail(const SceneReport& scene, const std::string& what) {
  throw std::invalid_argument(fmt::format("scene '{}': {}", scene.name, what));
}

void check_series(const SceneReport& scene, const Plot& plot, const Series& series) {
  const std::string where = fmt::format("plot '{}', series '{}'", plot.title, series.name);
  if (series.x.size() != series.y.size()) {
    fail(scene, fmt::format("{}: x has {} points, y has {}; they must be as many", where,
                            series.x.size(), series.y.size()));
  }
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.x[i])) {
      fail(scene, fmt::format("{}: x[{}] = {} must be finite", where, i, series.x[i]));
    }
    if (i > 0 && series.x[i] < series.x[i - 1]) {
      fail(scene, fmt::format("{}: x[{}] = {} must be at least x[{}] = {}", where, i, series.x[i],
                              i - 1, series.x[i - 1]));
    }
  }
}

void check_table(const SceneReport& scene, const Table& table) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].size() != table.header.size()) {
      fail(scene, fmt::format("table '{}': rows[{}] has {} cells, header has {}; they must be as "
                              "many",
                              table.title, i, table.rows[i].size(), table.header.size()));
    }
  }
}

void check_shapes(const Report& report) {
  for (const SceneReport& scene : report.scenes) {
    for (const Plot& plot : scene.plots) {
      for (const Series& series : plot.series) check_series(scene, plot, series);
    }
    for (const Table& table : scene.tables) check_table(scene, table);
  }
}

void create_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("cannot create the folder {}: {}", folder.string(), error.message()));
  }
}

}  // namespace

std::vector<std::string> write_report(const Report& report, const std::string& folder) {
  check_shapes(report);

  // All texts are made before the first is written.
  const std::string_view no_page_because = report_page_absent_because();
  std::vector<std::pair<std::string, std::string>> files = {
      {"report.json", report_json(report)},
      {"report.md", report_markdown(report, no_page_because)}};
  if (no_page_because.empty()) {
    files.emplace_back("report.html",
                       report_page(report_page_template(), report_page_json(report)));
  }

  for (std::size_t i = 0; i < report.scenes.size(); ++i) {
    if (report.scenes[i].text.empty()) continue;
    files.emplace_back(scene_file_name(report, i), report.scenes[i].text);
  }

  create_folder(folder);
  std::vector<std::string> written;
  for (const auto& [name, text] : files) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    create_folder(file.parent_path());
    tools::write_whole_file(file, text);
    written.push_back(file.string());
  }
  return written;
}

}  // namespace signorini::validation
