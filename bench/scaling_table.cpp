#include "bench/scaling_scenes.h"
#include "bench/scaling_study.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <ostream>

namespace signorini::bench {
namespace {

std::string number(double value, const char* format = "{:.3g}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

std::string milliseconds(double seconds) {
  return number(1e3 * seconds);
}

/// The row of this scene and size by Bullet, or null.
const ScalingRow* bullet_row(const ScalingReport& report, const ScalingRow& ours) {
  const auto found = std::ranges::find_if(report.rows, [&](const ScalingRow& row) {
    return row.scene == ours.scene && row.bodies == ours.bodies && row.engine != kOurEngine;
  });
  return found == report.rows.end() ? nullptr : &*found;
}

/// "2: 1.8x" for every number of threads above one.
std::string speed_up(const ScalingReport& report, const ScalingRow& ours) {
  std::string text;
  for (const ScalingRow& row : report.rows) {
    if (row.scene == ours.scene && row.bodies == ours.bodies && row.engine == kOurEngine &&
        row.threads > 1) {
      text += fmt::format("{}{}: {}x", text.empty() ? "" : " ", row.threads,
                          number(ours.costs.step / row.costs.step, "{:.2f}"));
    }
  }
  return text;
}

constexpr const char* kHead =
    "{:>7}{:>9}{:>9} |{:>9}{:>9} |{:>9}{:>9}{:>9}{:>9}{:>9}{:>9} |{:>8}{:>7}{:>7} |{:>8}{:>8} | "
    "{:<9} | {}\n";

void print_head(std::ostream& out) {
  out << fmt::format(fmt::runtime(kHead), "bodies", "contacts", "rows", "first", "step", "broad",
                     "narrow", "rows", "solvers", "move", "rest", "us/cont", "kB/c", "peak/c",
                     "floor", "memory", "threads", "Bullet ms, error m");
}

void print_row(const ScalingReport& report, const ScalingRow& row, std::ostream& out) {
  if (!row.failure.empty()) {
    out << fmt::format("{:>7}  {}{}\n", row.bodies,
                       row.is_wrong ? "WRONG: " : "no answer: ", row.failure);
    return;
  }
  const ScalingCosts& c = row.costs;
  const auto contacts = static_cast<double>(std::max(row.counts.contacts, 1L));
  const ScalingRow* bullet = bullet_row(report, row);
  out << fmt::format(fmt::runtime(kHead), row.bodies, row.counts.contacts, row.counts.rows,
                     milliseconds(c.first_step), milliseconds(c.step), milliseconds(c.broad),
                     milliseconds(c.narrow), milliseconds(c.rows), milliseconds(c.solvers),
                     milliseconds(c.move), milliseconds(c.rest), number(1e6 * c.step / contacts),
                     number(1e-3 * c.held_bytes / contacts), number(1e-3 * c.peak_bytes / contacts),
                     number(c.step / c.floor), number(c.step * c.bandwidth / c.touched_bytes),
                     speed_up(report, row),
                     bullet == nullptr ? "-"
                     : bullet->failure.empty()
                         ? fmt::format("{}, {:.0e} (ours {:.0e})", milliseconds(bullet->costs.step),
                                       bullet->costs.error, c.error)
                         : bullet->failure);
}

void print_growth(const ScalingReport& report, const std::string& scene, std::ostream& out) {
  std::string last;
  for (const ScalingGrowth& growth : report.growth()) {
    if (growth.scene != scene) {
      continue;
    }
    if (growth.engine != last) {
      out << (last.empty() ? "" : "\n") << growth.engine << " ~ bodies^k:";
      last = growth.engine;
    }
    out << fmt::format("  {} {:.2f}", growth.cost, growth.exponent);
  }
  out << (last.empty() ? "" : "\n");
}

}  // namespace

void print(const ScalingReport& report, std::ostream& out) {
  out << report.remark << ".\n"
      << "Times of a step in ms, medians: first: without a start; step: those after it (CPU time, "
         "one\nthread); its parts are wall times of the step that was disturbed least, broad and "
         "narrow "
         "phase\nthose of the first (what rests to the bit is not looked for again). kB/c: "
         "allocated by world and stepper, "
         "peak/c: most resident, a contact.\nfloor: step over one sparse factorisation of the "
         "active rows in body space; memory: step over moving\nwhat it must touch at the bandwidth "
         "measured in this run; threads: how much faster than one (wall over\nCPU time). error: "
         "how far what should rest has moved, else the deepest overlap.\n";
  for (const ScalingRow& row : report.rows) {
    if (row.engine == kOurEngine && std::isfinite(row.costs.bandwidth)) {
      out << fmt::format("Memory bandwidth, {} thread{}: {:.3g} GB/s\n", row.threads,
                         row.threads == 1 ? "" : "s", 1e-9 * row.costs.bandwidth);
      if (&row != &report.rows.back() && (&row + 1)->threads <= row.threads) {
        break;
      }
    }
  }
  for (const std::string_view name : scaling_scene_names()) {
    const std::string scene(name);
    bool is_first = true;
    for (const ScalingRow& row : report.rows) {
      if (row.scene != scene || row.engine != kOurEngine || row.threads != 1) {
        continue;
      }
      if (is_first) {
        out << "\n" << scene << "\n";
        print_head(out);
        is_first = false;
      }
      print_row(report, row, out);
    }
    print_growth(report, scene, out);
  }
  if (report.is_interrupted) {
    out << "PARTIAL: interrupted; the same command goes on where it was\n";
  }
  if (!report.failure.empty()) {
    out << "a job failed: " << report.failure << "\n";
  }
}

}  // namespace signorini::bench
