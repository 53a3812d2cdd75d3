#include "bench/performance_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <stdexcept>

namespace signorini::bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The page, in pixels.
constexpr int kWidth = 1080;
constexpr int kPlotLeft = 64;
constexpr int kPlotWidth = 640;
constexpr int kLegendLeft = kPlotLeft + kPlotWidth + 36;
constexpr int kHeading = 64;
constexpr int kPanelTitle = 34;
constexpr int kLeastPlotHeight = 320;
constexpr int kLegendLine = 19;
constexpr int kPanelFoot = 56;

struct LibraryColours {
  const char* library;
  std::array<const char*, 5> shades;
};

constexpr std::array<LibraryColours, 6> kColours = {{
    {"Signorini", {"#0b4f9e", "#1f83e0", "#0a8a8a", "#5b6fd6", "#3aa7c9"}},
    {"Bullet", {"#c2410c", "#ea7c2b", "#8a4b1f", "#f0a35e", "#b5651d"}},
    {"Bullet float", {"#b8860b", "#d4a017", "#8b6914", "#e6c35c", "#6b4f0f"}},
    {"ODE", {"#2e7d32", "#66a83a", "#1b5e20", "#8bc34a", "#33691e"}},
    {"DART", {"#7b1fa2", "#b45bd1", "#4a148c", "#ce93d8", "#6a1b9a"}},
    {"Siconos", {"#b71c1c", "#e0526a", "#7f1d3a", "#f06292", "#ad1457"}},
}};
constexpr std::array<const char*, 5> kGreys = {"#333", "#666", "#888", "#aaa", "#555"};
constexpr std::array<const char*, 4> kDashes = {"", "7 3", "2 3", "9 3 2 3"};

/// Colour, dashes and width of the series-th solver of a library.
std::string stroke(const std::string& library, int series) {
  const char* colour = kGreys[series % 5];
  for (const LibraryColours& colours : kColours) {
    if (library == colours.library) {
      colour = colours.shades[series % 5];
    }
  }
  const char* dashes = kDashes[(series / 5 + series) % 4];
  const double width = library == "Signorini" ? 3.0 : 1.6;  // ours are easy to find
  return fmt::format("stroke=\"{}\" stroke-dasharray=\"{}\" stroke-width=\"{}\"", colour, dashes,
                     width);
}

std::string escape(const std::string& text) {
  std::string escaped;
  for (const char letter : text) {
    switch (letter) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      default: escaped += letter;
    }
  }
  return escaped;
}

/// A panel's axes.
struct Frame {
  double top;
  double height;
  double decades;  // of the abscissa, from tau = 1

  [[nodiscard]] double x(double tau) const {
    return kPlotLeft + kPlotWidth * std::min(std::log10(tau) / decades, 1.0);
  }
  [[nodiscard]] double y(double share) const { return top + height * (1.0 - share); }
};

double decades_of(const std::vector<ProfileCurve>& curves) {
  double most = 1.0;
  for (const ProfileCurve& curve : curves) {
    if (!curve.ratios.empty()) {
      most = std::max(most, curve.ratios.back());
    }
  }
  return std::max(1.0, std::ceil(std::log10(most)));
}

std::string axes(const Frame& frame) {
  std::string svg;
  for (int percent = 0; percent <= 100; percent += 20) {
    const double y = frame.y(percent / 100.0);
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
        "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{} %</text>\n",
        kPlotLeft, kPlotLeft + kPlotWidth, y, y, kPlotLeft - 8, y + 4, percent);
  }
  for (int decade = 0; decade <= static_cast<int>(frame.decades); ++decade) {
    const double x = frame.x(std::pow(10.0, decade));
    const std::string label =
        decade < 4 ? fmt::format("{}", static_cast<int>(std::lround(std::pow(10.0, decade))))
                   : fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{}</tspan>", decade);
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>"
        "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4}</text>\n",
        x, frame.y(1.0), frame.y(0.0), frame.y(0.0) + 18, label);
  }
  svg += fmt::format(
      "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"middle\">time / time of the "
      "fastest solver of the problem</text>\n",
      kPlotLeft + kPlotWidth / 2, frame.y(0.0) + 38);
  return svg;
}

std::string path(const ProfileCurve& curve, const Frame& frame) {
  double share = curve.share(1.0);
  std::string d = fmt::format("M{:.1f} {:.1f}", frame.x(1.0), frame.y(share));
  for (std::size_t i = 0; i < curve.ratios.size(); ++i) {
    if (curve.ratios[i] > 1.0) {
      share = static_cast<double>(i + 1) / curve.problems;
      d += fmt::format("H{:.1f}V{:.1f}", frame.x(curve.ratios[i]), frame.y(share));
    }
  }
  return d + fmt::format("H{}", kPlotLeft + kPlotWidth);
}

std::string panel_svg(const ProfilePanel& panel, double top, double& height) {
  const std::vector<ProfileCurve> curves = profile_curves(panel);
  const int problems = curves.empty() ? 0 : curves.front().problems;
  const double plot_height =
      std::max<double>(kLeastPlotHeight, kLegendLine * (static_cast<double>(curves.size()) + 1.0));
  const Frame frame{.top = top + kPanelTitle, .height = plot_height, .decades = decades_of(curves)};
  height = kPanelTitle + plot_height + kPanelFoot;
  std::string svg =
      fmt::format("<text class=\"panel\" x=\"{}\" y=\"{:.1f}\">{} ({} problems)</text>\n",
                  kPlotLeft, top + 18, escape(panel.title), problems);
  svg += axes(frame);
  svg += fmt::format(
      "<text class=\"head\" x=\"{}\" y=\"{:.1f}\">solver</text>"
      "<text class=\"head\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">solved</text>"
      "<text class=\"head\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">fastest</text>\n",
      kLegendLeft + 42, frame.top + 6, kWidth - 90, frame.top + 6, kWidth - 24, frame.top + 6);
  std::map<std::string, int> seen;
  std::vector<std::string> strokes;
  for (const ProfileSeries& series : panel.series) {  // colours do not depend on the results
    const int number = seen[series.library]++;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      strokes.resize(curves.size());
      if (curves[i].name == series.name) {
        strokes[i] = stroke(series.library, number);
      }
    }
  }
  for (std::size_t i = curves.size(); i-- > 0;) {  // the best on top
    const ProfileCurve& curve = curves[i];
    if (curve.solved() > 0) {
      svg += fmt::format("<path class=\"curve\" d=\"{}\" {}><title>{}</title></path>\n",
                         path(curve, frame), strokes[i], escape(curve.name));
    }
    const double y = frame.top + 6 + kLegendLine * (static_cast<double>(i) + 1.0);
    svg += fmt::format(
        "<line class=\"curve\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" {}/>"
        "<text class=\"name\" x=\"{}\" y=\"{:.1f}\">{}</text>"
        "<text class=\"name\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>"
        "<text class=\"name\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
        kLegendLeft, kLegendLeft + 34, y - 4, y - 4, strokes[i], kLegendLeft + 42, y,
        escape(curve.name), kWidth - 90, y, curve.solved(), kWidth - 24, y, curve.fastest);
  }
  return svg;
}

}  // namespace

double ProfileCurve::share(double tau) const {
  const auto within = std::upper_bound(ratios.begin(), ratios.end(), tau) - ratios.begin();
  return problems > 0 ? static_cast<double>(within) / problems : 0.0;
}

std::vector<ProfileCurve> profile_curves(const ProfilePanel& panel) {
  const std::size_t problems = panel.series.empty() ? 0 : panel.series.front().seconds.size();
  std::vector<double> best(problems, kInfinity);
  for (const ProfileSeries& series : panel.series) {
    if (series.seconds.size() != problems) {
      throw std::invalid_argument("profile: " + series.name + " has another number of problems");
    }
    for (std::size_t p = 0; p < problems; ++p) {
      best[p] = std::min(best[p], series.seconds[p]);
    }
  }
  std::vector<ProfileCurve> curves;
  for (const ProfileSeries& series : panel.series) {
    ProfileCurve curve{series.name, series.library, {}, static_cast<int>(problems), 0};
    for (std::size_t p = 0; p < problems; ++p) {
      if (series.seconds[p] < kInfinity) {
        curve.ratios.push_back(series.seconds[p] / best[p]);
        curve.fastest += series.seconds[p] == best[p] ? 1 : 0;
      }
    }
    std::sort(curve.ratios.begin(), curve.ratios.end());
    curves.push_back(std::move(curve));
  }
  std::stable_sort(curves.begin(), curves.end(),
                   [](const ProfileCurve& one, const ProfileCurve& other) {
                     return one.solved() != other.solved() ? one.solved() > other.solved()
                                                           : one.fastest > other.fastest;
                   });
  return curves;
}

std::string performance_profile_svg(const std::vector<ProfilePanel>& panels,
                                    const std::string& title) {
  std::string body;
  double top = kHeading;
  for (const ProfilePanel& panel : panels) {
    double height = 0.0;
    body += panel_svg(panel, top, height);
    top += height;
  }
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1:.0f}\" width=\"{0}\" "
             "height=\"{1:.0f}\">\n",
             kWidth, top) +
         "<style>text{font-family:system-ui,sans-serif;fill:#222}.title{font-size:18px;"
         "font-weight:600}.sub{font-size:12px;fill:#555}.panel{font-size:15px;font-weight:600}"
         ".tick{font-size:12px;fill:#555}.head{font-size:12px;fill:#555}.name{font-size:13px}"
         ".grid{stroke:#e3e3e3;stroke-width:1}.curve{fill:none}</style>\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
         fmt::format(
             "<text class=\"title\" x=\"{0}\" y=\"28\">{1}</text>\n"
             "<text class=\"sub\" x=\"{0}\" y=\"48\">Share of all problems solved within a "
             "multiple of the fastest time (Dolan and Moré 2002). Problems that nobody "
             "solves count.</text>\n",
             kPlotLeft, escape(title)) +
         body + "</svg>\n";
}

}  // namespace signorini::bench
