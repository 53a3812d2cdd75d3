#include "bench/tradeoff.h"

#include "bench/peers_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace signorini::bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The smallest class that holds so many rows: 16, 64, 256 ...
int class_of(int rows) {
  int bound = 16;
  while (bound < rows) bound *= 4;
  return bound;
}

/// A solver on a problem, over the dial.
struct Cell {
  ProblemClass which;
  std::string solver;
  std::string library;
  bool is_refused = true;
  std::vector<std::pair<double, double>> runs;  ///< natural residual and seconds of each answer

  /// Seconds of the fastest answer that errs at most that; +infinity for none.
  [[nodiscard]] double seconds(double level) const {
    double fastest = kInfinity;
    for (const auto& [residual, time] : runs) {
      if (residual <= level) fastest = std::min(fastest, time);
    }
    return fastest;
  }
};

/// Problem by problem, solver by solver, in the order in which they appear.
std::vector<Cell> cells_of(std::span<const DialRuns> dial) {
  std::vector<Cell> cells;
  std::map<std::pair<std::string, std::string>, std::size_t> place;
  for (const DialRuns& position : dial) {
    for (const PeersRow& row : position.result.rows) {
      const auto [found, is_new] =
          place.try_emplace({row.problem + "/" + row.form, row.solver}, cells.size());
      if (is_new) {
        cells.push_back({{row.form, class_of(row.n)}, row.solver, row.library, true, {}});
      }
      Cell& cell = cells[found->second];
      if (row.run.verdict == Verdict::kRefused) continue;
      cell.is_refused = false;
      // A NaN residual (no answer) is at most nothing.
      if (row.run.seconds >= 0.0) {
        cell.runs.emplace_back(row.run.certificate.natural_residual, row.run.seconds);
      }
    }
  }
  return cells;
}

struct Sum {
  LevelScore score;
  double logs = 0.0;
};

void add(const Cell& cell, double level, double penalty_seconds, Sum& sum) {
  if (cell.is_refused) {
    ++sum.score.refused;
    return;
  }
  ++sum.score.problems;
  const double seconds = cell.seconds(level);
  if (seconds < kInfinity) ++sum.score.solved;
  sum.logs += std::log(std::min(seconds, penalty_seconds) + kShiftSeconds);
}

bool solved_all(const LevelScore& score) {
  return score.problems > 0 && score.solved == score.problems && score.refused == 0;
}

std::vector<ProblemClass> classes_of(std::span<const LevelScore> scores) {
  std::vector<ProblemClass> classes;
  for (const LevelScore& score : scores) {
    if (std::find(classes.begin(), classes.end(), score.which) == classes.end()) {
      classes.push_back(score.which);
    }
  }
  std::stable_sort(classes.begin(), classes.end(), [](const auto& a, const auto& b) {
    return a.form < b.form || (a.form == b.form && a.rows < b.rows);
  });
  return classes;
}

std::vector<double> levels_of(std::span<const LevelScore> scores) {
  std::vector<double> levels;
  for (const LevelScore& score : scores) {
    if (std::find(levels.begin(), levels.end(), score.level) == levels.end()) {
      levels.push_back(score.level);
    }
  }
  std::sort(levels.begin(), levels.end(), std::greater<>());
  return levels;
}

/// The fastest of a class and level that solved everything; null for none.
const LevelScore* fastest(std::span<const LevelScore> scores, const ProblemClass& which,
                          double level, bool ours) {
  const LevelScore* best = nullptr;
  for (const LevelScore& score : scores) {
    if (score.which != which || score.level != level || !solved_all(score)) continue;
    if (ours && score.library != "Signorini") continue;
    if (best == nullptr || score.mean_seconds < best->mean_seconds) best = &score;
  }
  return best;
}

/// Of a class and level the solver of ours that solves most, then the fastest; null for none.
const LevelScore* most_solved(std::span<const LevelScore> scores, const ProblemClass& which,
                              double level) {
  const LevelScore* best = nullptr;
  for (const LevelScore& score : scores) {
    if (score.which != which || score.level != level || score.library != "Signorini") continue;
    if (best == nullptr || score.solved > best->solved ||
        (score.solved == best->solved && score.mean_seconds < best->mean_seconds)) {
      best = &score;
    }
  }
  return best;
}

std::string recommendation(std::span<const LevelScore> scores, const ProblemClass& which,
                           double level) {
  const LevelScore* ours = fastest(scores, which, level, true);
  if (ours == nullptr) {
    const LevelScore* most = most_solved(scores, which, level);
    if (most == nullptr || most->solved == 0) return "nothing of ours";
    return fmt::format("none solves all; `{}` {} of {}", most->solver, most->solved,
                       most->problems + most->refused);
  }
  std::string text = fmt::format("`{}` {}", ours->solver, short_time(ours->mean_seconds));
  const LevelScore* all = fastest(scores, which, level, false);
  if (all != ours) {
    text += fmt::format(" ({} {} is faster: {})", all->library, all->solver,
                        short_time(all->mean_seconds));
  }
  return text;
}

std::string recommendation_table(std::span<const LevelScore> scores) {
  const std::vector<double> levels = levels_of(scores);
  std::string text = "| form | rows up to |";
  std::string rule = "|---|---|";
  for (const double level : levels) {
    text += fmt::format(" error {:g} |", level);
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const ProblemClass& which : classes_of(scores)) {
    text += fmt::format("| {} | {} |", which.form, which.rows);
    for (const double level : levels) {
      text += fmt::format(" {} |", recommendation(scores, which, level));
    }
    text += "\n";
  }
  return text;
}

std::string fronts_text(std::span<const LevelScore> scores) {
  std::string text;
  for (const ProblemClass& which : classes_of(scores)) {
    text += fmt::format("- {}, up to {} rows:", which.form, which.rows);
    const std::vector<LevelScore> front = pareto_front(scores, which);
    for (const LevelScore& score : front) {
      text += fmt::format(" {:g} in {} (`{}`){}", score.level, short_time(score.mean_seconds),
                          score.solver, &score == &front.back() ? "" : ";");
    }
    text += front.empty() ? " nobody solves all of them at any level\n" : "\n";
  }
  return text;
}

std::string rates_table(std::span<const LevelScore> scores) {
  std::string text =
      "| form | rows up to | error | solver | solved | shifted geometric mean |\n"
      "|---|---|---|---|---|---|\n";
  for (const LevelScore& score : scores) {
    text += fmt::format("| {} | {} | {:g} | `{}` | {} of {}{} | {} |\n", score.which.form,
                        score.which.rows, score.level, score.solver, score.solved, score.problems,
                        score.refused > 0 ? fmt::format(", {} refused", score.refused) : "",
                        short_time(score.mean_seconds));
  }
  return text;
}

}  // namespace

std::vector<LevelScore> level_scores(std::span<const DialRuns> dial, std::span<const double> levels,
                                     double penalty_seconds) {
  const std::vector<Cell> cells = cells_of(dial);
  std::vector<LevelScore> scores;
  for (const double level : levels) {
    std::vector<Sum> sums;
    for (const Cell& cell : cells) {
      auto found = std::find_if(sums.begin(), sums.end(), [&](const Sum& sum) {
        return sum.score.which == cell.which && sum.score.solver == cell.solver;
      });
      if (found == sums.end()) {
        sums.push_back({{.which = cell.which,
                         .level = level,
                         .solver = cell.solver,
                         .library = cell.library}});
        found = sums.end() - 1;
      }
      add(cell, level, penalty_seconds, *found);
    }
    for (Sum& sum : sums) {
      if (sum.score.problems == 0) continue;
      sum.score.mean_seconds = std::exp(sum.logs / sum.score.problems) - kShiftSeconds;
      scores.push_back(std::move(sum.score));
    }
  }
  return scores;
}

std::vector<LevelScore> pareto_front(std::span<const LevelScore> scores,
                                     const ProblemClass& which) {
  std::vector<LevelScore> front;
  for (const LevelScore& score : scores) {
    if (score.which != which || !solved_all(score)) continue;
    const bool is_beaten = std::any_of(scores.begin(), scores.end(), [&](const LevelScore& other) {
      const bool is_no_worse =
          other.level <= score.level && other.mean_seconds <= score.mean_seconds;
      const bool is_better = other.level < score.level || other.mean_seconds < score.mean_seconds;
      return other.which == which && solved_all(other) && is_no_worse && is_better;
    });
    if (!is_beaten) front.push_back(score);
  }
  std::stable_sort(front.begin(), front.end(),
                   [](const LevelScore& a, const LevelScore& b) { return a.level > b.level; });
  return front;
}

std::vector<ProfilePanel> level_profiles(std::span<const DialRuns> dial, double level) {
  std::vector<ProfilePanel> panels;
  std::map<std::pair<std::string, std::string>, bool> takes;  // form and solver: any problem at all
  const std::vector<Cell> cells = cells_of(dial);
  for (const Cell& cell : cells) takes[{cell.which.form, cell.solver}] |= !cell.is_refused;
  for (const Cell& cell : cells) {
    if (!takes[{cell.which.form, cell.solver}]) continue;
    auto panel = std::find_if(panels.begin(), panels.end(),
                              [&](const ProfilePanel& p) { return p.title == cell.which.form; });
    if (panel == panels.end()) {
      panels.push_back({cell.which.form, {}});
      panel = panels.end() - 1;
    }
    auto series = std::find_if(panel->series.begin(), panel->series.end(),
                               [&](const ProfileSeries& s) { return s.name == cell.solver; });
    if (series == panel->series.end()) {
      panel->series.push_back({cell.solver, cell.library, {}});
      series = panel->series.end() - 1;
    }
    series->seconds.push_back(cell.seconds(level));
  }
  for (ProfilePanel& panel : panels) panel.title += fmt::format(", natural residual {:g}", level);
  return panels;
}

std::string tradeoff_csv(std::span<const DialRuns> dial) {
  std::string text =
      "asked_tolerance,problem,form,family,rows,solver,library,verdict,natural_residual,"
      "unit_free_residual,seconds,iterations,pivots,factorizations\n";
  const auto count = [](int value) { return value < 0 ? std::string() : std::to_string(value); };
  for (const DialRuns& position : dial) {
    for (const PeersRow& row : position.result.rows) {
      text += fmt::format(
          "{:g},{},{},{},{},{},{},{},{:.6g},{:.6g},{},{},{},{}\n", position.tolerance, row.problem,
          row.form, row.family, row.n, row.solver, row.library, to_string(row.run.verdict),
          row.run.certificate.natural_residual, row.run.certificate.unit_free_residual,
          row.run.seconds < 0.0 ? "" : fmt::format("{:.6g}", row.run.seconds),
          count(row.run.iterations), count(row.run.pivots), count(row.run.factorizations));
    }
  }
  return text;
}

std::string scores_csv(std::span<const LevelScore> scores) {
  std::string text =
      "form,rows_up_to,level,solver,library,problems,solved,refused,shifted_geometric_mean_s\n";
  for (const LevelScore& score : scores) {
    text += fmt::format("{},{},{:g},{},{},{},{},{},{:.6g}\n", score.which.form, score.which.rows,
                        score.level, score.solver, score.library, score.problems, score.solved,
                        score.refused, score.mean_seconds);
  }
  return text;
}

std::string tradeoff_markdown(std::span<const LevelScore> scores,
                              const std::vector<std::string>& remarks) {
  std::string text = "# The trade: error against time\n\n";
  for (const std::string& remark : remarks) text += "- " + remark + "\n";
  text += fmt::format(
      "\nError: the natural residual max|min(z, w)| / (1 + |q|) of the answer, judged on the "
      "problem's data. Time: the shifted geometric mean over the problems of a class (shift {:g} "
      "s), of each the fastest dial position whose answer is good enough.\n\n"
      "## For this error, at this size, use this\n\nThe fastest of ours that solves every problem "
      "of the class.\n\n{}\n## Pareto fronts\n\nNothing is both more accurate and "
      "faster.\n\n{}\n## Success rates and mean times\n\n{}",
      kShiftSeconds, recommendation_table(scores), fronts_text(scores), rates_table(scores));
  return text;
}

}  // namespace signorini::bench
