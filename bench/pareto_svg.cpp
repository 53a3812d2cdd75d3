#include "bench/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace signorini::bench {
namespace {

// A panel, in pixels.
constexpr double kPanelWidth = 760.0;
constexpr double kPanelHeight = 360.0;
constexpr double kLeft = 70.0;
constexpr double kRight = 150.0;
constexpr double kTop = 40.0;
constexpr double kBottom = 50.0;

/// Okabe and Ito's colours, and a shape each: told apart without colour.
struct Look {
  const char* library;
  const char* colour;
  const char* shape;  ///< a path of about 10 x 10 about the origin
};
constexpr Look kLooks[] = {
    {"Signorini", "#0072b2", "M-4.5 0A4.5 4.5 0 1 0 4.5 0A4.5 4.5 0 1 0 -4.5 0Z"},
    {"Bullet", "#d55e00", "M0 -5.5L5.5 0 0 5.5 -5.5 0Z"},
    {"ODE", "#009e73", "M-4.5 -4.5H4.5V4.5H-4.5Z"},
    {"DART", "#cc79a7", "M0 -5L5 4H-5Z"},
    {"Siconos", "#b8860b", "M0 5L5 -4H-5Z"},
    {"Bullet float", "#e69f00", "M0 -5.5L3 0 0 5.5 -3 0Z"},
};

const Look& look_of(const std::string& library) {
  const auto* found = std::find_if(std::begin(kLooks), std::end(kLooks),
                                   [&](const Look& look) { return library == look.library; });
  return found == std::end(kLooks) ? kLooks[0] : *found;
}

/// A decade axis from value to pixel.
struct DecadeAxis {
  int low = 0;
  int high = 1;
  double from = 0.0;
  double to = 1.0;

  DecadeAxis(double least, double most, double from_pixel, double to_pixel)
      : low(static_cast<int>(std::floor(std::log10(least)))),
        high(std::max(low + 1, static_cast<int>(std::ceil(std::log10(most) - 1e-9)))),
        from(from_pixel),
        to(to_pixel) {}
  [[nodiscard]] double at(double value) const {
    return from + (std::log10(value) - low) / (high - low) * (to - from);
  }
};

std::string axes_svg(const DecadeAxis& x, const DecadeAxis& y, bool is_scene) {
  std::string svg;
  for (int e = x.low; e <= x.high; ++e) {
    const double at = x.at(std::pow(10.0, e));
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3:.1f}\" "
        "text-anchor=\"middle\">1e{4}</text>\n",
        at, kTop, kPanelHeight - kBottom, kPanelHeight - kBottom + 16.0, e);
  }
  for (int e = y.low; e <= y.high; ++e) {
    const double at = y.at(std::pow(10.0, e));
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" stroke=\"#ddd\"/><text x=\"{3:.1f}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">1e{5}</text>\n",
        kLeft, at, kPanelWidth - kRight, kLeft - 6.0, at + 4.0, e);
  }
  return svg + fmt::format(
                   "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{} (shifted "
                   "geometric mean)</text><text transform=\"translate(16 {:.1f}) rotate(-90)\" "
                   "text-anchor=\"middle\">{}</text>\n",
                   0.5 * (kLeft + kPanelWidth - kRight), kPanelHeight - 14.0,
                   is_scene ? "seconds a simulated second" : "seconds", 0.5 * kPanelHeight,
                   is_scene ? "worst error / wholly wrong" : "natural residual");
}

std::string panel_svg(std::span<const LevelScore> scores, const ProblemClass& which) {
  std::vector<LevelScore> dots;
  for (const LevelScore& score : scores) {
    const bool solved_all =
        score.problems > 0 && score.refused == 0 && score.solved == score.problems;
    if (score.which == which && solved_all) dots.push_back(score);
  }
  std::string svg =
      fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">{}, up to {} {}{}</text>\n",
                  kLeft, 24.0, which.form, which.size, which.unit,
                  dots.empty() ? ": nobody solves all problems at any level" : "");
  if (dots.empty()) return svg;
  const auto by_time = [](const auto& a, const auto& b) { return a.mean_seconds < b.mean_seconds; };
  const auto by_level = [](const auto& a, const auto& b) { return a.level < b.level; };
  const auto [fast, slow] = std::minmax_element(dots.begin(), dots.end(), by_time);
  const auto [fine, coarse] = std::minmax_element(dots.begin(), dots.end(), by_level);
  const DecadeAxis x(fast->mean_seconds, slow->mean_seconds, kLeft, kPanelWidth - kRight);
  const DecadeAxis y(fine->level, coarse->level, kPanelHeight - kBottom, kTop);
  svg += axes_svg(x, y, which.is_scene());

  const std::vector<LevelScore> front = pareto_front(scores, which);
  std::string line;
  for (const LevelScore& score : front) {
    line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x.at(score.mean_seconds),
                        y.at(score.level));
  }
  svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#444\" stroke-width=\"1.5\"/>\n", line);
  for (const LevelScore& dot : dots) {
    const Look& look = look_of(dot.library);
    svg += fmt::format(
        "<path d=\"{}\" transform=\"translate({:.1f} {:.1f})\" fill=\"{}\" fill-opacity=\"0.75\">"
        "<title>{} ({}): {:g} in {:.3g} s</title></path>\n",
        look.shape, x.at(dot.mean_seconds), y.at(dot.level), look.colour, dot.solver, dot.library,
        dot.level, dot.mean_seconds);
  }
  // The front goes right and down: a label that would lie on the one before goes below it.
  constexpr double kLabelWidth = 130.0;
  constexpr double kLabelHeight = 11.0;
  double last_left = -kLabelWidth;
  double last_base = 0.0;
  for (const LevelScore& score : front) {
    const double left = x.at(score.mean_seconds) + 7.0;
    double base = y.at(score.level) - 6.0;
    if (left < last_left + kLabelWidth) {
      base = std::max(base, last_base + kLabelHeight);
    }
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"10\">{}</text>\n", left, base,
                       score.solver);
    last_left = left;
    last_base = base;
  }
  return svg;
}

std::string legend_svg(std::span<const LevelScore> scores) {
  std::string svg;
  double y = kTop + 10.0;
  for (const Look& look : kLooks) {
    if (std::none_of(scores.begin(), scores.end(),
                     [&](const LevelScore& score) { return score.library == look.library; })) {
      continue;
    }
    svg += fmt::format(
        "<path d=\"{}\" transform=\"translate({:.1f} {:.1f})\" fill=\"{}\"/><text x=\"{:.1f}\" "
        "y=\"{:.1f}\">{}</text>\n",
        look.shape, kPanelWidth - kRight + 24.0, y, look.colour, kPanelWidth - kRight + 36.0,
        y + 4.0, look.library);
    y += 20.0;
  }
  return svg;
}

}  // namespace

std::string pareto_svg(std::span<const LevelScore> scores, const std::string& title) {
  std::vector<ProblemClass> largest;  // of each form of problems; all of scenes
  for (const LevelScore& score : scores) {
    auto found = std::find_if(largest.begin(), largest.end(), [&](const auto& c) {
      return score.which.is_scene() ? c == score.which : c.form == score.which.form;
    });
    if (found == largest.end()) {
      largest.push_back(score.which);
    } else {
      found->size = std::max(found->size, score.which.size);
    }
  }
  std::stable_sort(largest.begin(), largest.end(), [](const auto& a, const auto& b) {
    return a.form < b.form || (a.form == b.form && a.size < b.size);
  });
  const std::size_t rows = (largest.size() + 1) / 2;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<text x=\"{2:.0f}\" y=\"26\" "
      "font-size=\"16\">{3}</text>\n",
      2.0 * kPanelWidth, 40.0 + kPanelHeight * static_cast<double>(rows), kLeft, title);
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const std::size_t row = i / 2;
    svg += fmt::format("<g transform=\"translate({:.0f} {:.0f})\">\n{}{}</g>\n",
                       kPanelWidth * static_cast<double>(i % 2),
                       40.0 + kPanelHeight * static_cast<double>(row),
                       panel_svg(scores, largest[i]), legend_svg(scores));
  }
  return svg + "</svg>\n";
}

}  // namespace signorini::bench
