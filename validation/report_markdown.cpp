#include <signorini/validation/report_markdown.h>
#include <signorini/validation/worst_check.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <optional>
#include <utility>

namespace signorini::validation {
namespace {

using Out = std::back_insert_iterator<std::string>;

/// Failures first, then the order of the report.
constexpr Verdict kOrder[] = {Verdict::kFail, Verdict::kPass, Verdict::kInformation};

std::string_view word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass: return "pass";
    case Verdict::kFail: return "**FAIL**";
    case Verdict::kInformation: return "info";
  }
  return "";
}

std::string duration(double seconds) {
  return seconds < 0.0 ? "not run" : fmt::format("{:.3g} s", seconds);
}

std::string with_unit(double value, const std::string& unit) {
  return unit.empty() || unit == "1" ? fmt::format("{:.7g}", value)
                                     : fmt::format("{:.7g} {}", value, markdown_escaped(unit));
}

/// What is not judged owes no tolerance: its columns stay empty.
std::string judged_number(const Check& check, double value) {
  return check.judged() == Verdict::kInformation ? "" : fmt::format("{:.3g}", value);
}

void write_front(const Report& report, std::string_view no_page_because, Out out) {
  fmt::format_to(out, "# Signorini: validation report\n\n0 ≤ f ⊥ d ≥ 0\n\n");
  if (report.partial) {
    fmt::format_to(out, "**PARTIAL: the run was interrupted. Scenes are missing.**\n\n");
  }
  const auto count = [&report](Verdict verdict) {
    return std::count_if(report.scenes.begin(), report.scenes.end(),
                         [verdict](const auto& scene) { return scene.verdict() == verdict; });
  };
  fmt::format_to(out, "{} scenes: **{} failed**, {} passed, {} for information only.\n\n",
                 report.scenes.size(), count(Verdict::kFail), count(Verdict::kPass),
                 count(Verdict::kInformation));
  fmt::format_to(out, "- signorini {}\n- beside it: {}\n- command:\n\n{}\n",
                 markdown_escaped(report.version), markdown_escaped(report.engines),
                 markdown_fenced(report.command));
  if (!report.jobs.empty()) fmt::format_to(out, "{}.\n\n", markdown_escaped(report.jobs));
  if (no_page_because.empty()) {
    fmt::format_to(out, "Plots: report.html. All numbers: report.json.\n\n");
  } else {
    fmt::format_to(out,
                   "**report.html was not made: {}. A report.html in this folder is from another "
                   "run.** All numbers, those of the plots too: report.json.\n\n",
                   no_page_because);
  }
}

void write_verdict_row(const SceneReport& scene, Out out) {
  const Check* worst = worst_check(scene);
  if (worst == nullptr) {
    fmt::format_to(out, "| {} | {} | no check | | | | |\n", word(scene.verdict()),
                   markdown_escaped(scene.name));
    return;
  }
  const Check* bullets = bullets_counterpart(scene, *worst);
  fmt::format_to(out, "| {} | {} | {} ({}, {}) | {:.3g} | {} | {} | {} |\n", word(scene.verdict()),
                 markdown_escaped(scene.name), markdown_escaped(worst->name),
                 markdown_escaped(worst->engine), markdown_escaped(worst->reference), worst->error,
                 judged_number(*worst, worst->tolerance),
                 judged_number(*worst, tolerance_ratio(*worst)),
                 bullets == nullptr ? "" : fmt::format("{:.3g}", bullets->error));
}

void write_verdict_table(const Report& report, Out out) {
  fmt::format_to(out,
                 "| verdict | scene | worst check | error | tolerance | error / tolerance | "
                 "Bullet's error |\n|---|---|---|---|---|---|---|\n");
  for (const Verdict verdict : kOrder) {
    for (const SceneReport& scene : report.scenes) {
      if (scene.verdict() == verdict) write_verdict_row(scene, out);
    }
  }
  fmt::format_to(out, "\n");
}

void write_checks(const SceneReport& scene, Out out) {
  if (scene.checks.empty()) return;
  fmt::format_to(
      out,
      "| verdict | check | engine | value | expected | error | tolerance | against | why "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Verdict verdict : kOrder) {
    for (const Check& check : scene.checks) {
      if (check.judged() != verdict) continue;
      fmt::format_to(out, "| {} | {} | {} | {} | {} | {:.3g} {} | {} | {} | {} |\n", word(verdict),
                     markdown_escaped(check.name), markdown_escaped(check.engine),
                     with_unit(check.value, check.unit), with_unit(check.expected, check.unit),
                     check.error, markdown_escaped(check.error_kind),
                     judged_number(check, check.tolerance), markdown_escaped(check.reference),
                     markdown_escaped(check.reason));
    }
  }
  fmt::format_to(out, "\n");
}

std::string way_text(const TradePoint& point) {
  return fmt::format("{}, step {:g} s", point.solver, point.step);
}

void write_losses(const Report& report, Out out) {
  fmt::format_to(out,
                 "## Where we lose\n\nScenes where another engine is faster at equal error "
                 "(errors below {:g} of the scene's scale count as equal).\n\n",
                 kEqualErrors);
  bool any = false;
  for (const SceneReport& scene : report.scenes) {
    const std::vector<Loss> lost = scene.trade ? losses(*scene.trade) : std::vector<Loss>{};
    if (lost.empty()) continue;
    if (!any) {
      fmt::format_to(out,
                     "| scene | error | whose | theirs | time | ours at that error | our time / "
                     "theirs |\n|---|---|---|---|---|---|---|\n");
    }
    any = true;
    const Trade& trade = *scene.trade;
    const TradePoint& theirs = trade.points[lost.front().theirs];
    const std::string ours = lost.front().reached
                                 ? markdown_escaped(way_text(trade.points[lost.front().ours]))
                                 : "not reached by any run";
    fmt::format_to(out, "| {} | {} | {:.3g} {} | {} | {} | {} | {:.3g} |\n",
                   markdown_escaped(scene.name), markdown_escaped(trade.error), theirs.error,
                   markdown_escaped(trade.unit), markdown_escaped(way_text(theirs)),
                   duration(theirs.whole_seconds), ours, lost.front().factor);
  }
  fmt::format_to(out, "{}\n", any ? "" : "None in this run.\n");
}

std::optional<std::pair<double, double>> finite_range(const std::vector<double>& values) {
  std::optional<std::pair<double, double>> range;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (!range) range = {value, value};
    range = {std::min(range->first, value), std::max(range->second, value)};
  }
  return range;
}

void write_plots(const SceneReport& scene, Out out) {
  for (const Plot& plot : scene.plots) {
    fmt::format_to(out, "Plot: {} ({} over {})\n\n", markdown_escaped(plot.title),
                   markdown_escaped(plot.y_label), markdown_escaped(plot.x_label));
    for (const Series& series : plot.series) {
      const auto range = finite_range(series.y);
      fmt::format_to(
          out, "- {} ({}): {} points{}\n", markdown_escaped(series.name),
          markdown_escaped(series.engine), series.y.size(),
          range ? fmt::format(", {:.4g} to {:.4g}", range->first, range->second) : ", none finite");
    }
    fmt::format_to(out, "\n");
  }
}

void write_row(const std::vector<std::string>& cells, Out out) {
  for (const std::string& cell : cells) fmt::format_to(out, "| {} ", markdown_escaped(cell));
  fmt::format_to(out, "|\n");
}

void write_tables(const SceneReport& scene, Out out) {
  for (const Table& table : scene.tables) {
    fmt::format_to(out, "**{}**\n\n", markdown_escaped(table.title));
    if (table.header.empty()) continue;
    write_row(table.header, out);
    for (std::size_t column = 0; column < table.header.size(); ++column) {
      fmt::format_to(out, "|---");
    }
    fmt::format_to(out, "|\n");
    for (const auto& row : table.rows) write_row(row, out);
    fmt::format_to(out, "\n");
  }
}

void write_lines(std::string_view title, const std::vector<std::string>& lines, Out out) {
  if (lines.empty()) return;
  fmt::format_to(out, "{}:\n\n", title);
  for (const std::string& line : lines) fmt::format_to(out, "- {}\n", markdown_escaped(line));
  fmt::format_to(out, "\n");
}

void write_scene(const SceneReport& scene, Out out) {
  fmt::format_to(out, "## {}\n\n", markdown_escaped(scene.title));
  fmt::format_to(out, "{}: {}. {}\n\n", markdown_escaped(scene.name), word(scene.verdict()),
                 markdown_escaped(scene.description));
  write_lines("Notices", scene.notices, out);
  write_checks(scene, out);
  write_tables(scene, out);
  write_plots(scene, out);
  write_lines("Settings", scene.settings, out);
  fmt::format_to(out, "Wall time: signorini {}, Bullet {}. Scene: {}. To repeat it:\n\n{}\n",
                 duration(scene.signorini_seconds), duration(scene.bullet_seconds),
                 markdown_escaped(scene.source), markdown_fenced(scene.command));
}

}  // namespace

std::string markdown_escaped(std::string_view text) {
  constexpr std::string_view kSpecial = R"(|\`*_[]<>#~&$)";
  std::string result;
  for (const char character : text) {
    if (character == '\n' || character == '\r') {
      result += ' ';
      continue;
    }
    if (kSpecial.find(character) != std::string_view::npos) result += '\\';
    result += character;
  }
  return result;
}

std::string markdown_fenced(std::string_view text) {
  std::size_t longest = 2, run = 0;
  for (const char character : text) {
    run = character == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  const std::string fence(longest + 1, '`');
  return fmt::format("{}\n{}\n{}\n", fence, text, fence);
}

std::string report_markdown(const Report& report, std::string_view no_page_because) {
  std::string result;
  const Out out = std::back_inserter(result);
  write_front(report, no_page_because, out);
  write_verdict_table(report, out);
  write_losses(report, out);
  for (const SceneReport& scene : report.scenes) write_scene(scene, out);
  return result;
}

}  // namespace signorini::validation
