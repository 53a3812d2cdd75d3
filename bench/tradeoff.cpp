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

/// A solver on a problem, over the dial.
struct Cell {
  std::string problem;
  ProblemClass which;
  std::string solver;
  std::string library;
  bool is_refused = true;
  double limit_seconds = 0.0;
  std::vector<std::pair<double, double>> runs;  ///< error and seconds of each answer

  /// Seconds of the fastest answer that errs at most that; +infinity for none.
  [[nodiscard]] double seconds(double level) const {
    double fastest = kInfinity;
    for (const auto& [error, time] : runs) {
      if (error <= level) fastest = std::min(fastest, time);
    }
    return fastest;
  }
};

/// Problem by problem, solver by solver, in the order in which they appear.
std::vector<Cell> cells_of(std::span<const TradeRun> runs) {
  std::vector<Cell> cells;
  std::map<std::pair<std::string, std::string>, std::size_t> place;
  for (const TradeRun& run : runs) {
    const auto [found, is_new] = place.try_emplace({run.problem, run.solver}, cells.size());
    if (is_new) {
      cells.push_back({.problem = run.problem,
                       .which = run.which,
                       .solver = run.solver,
                       .library = run.library,
                       .limit_seconds = run.limit_seconds,
                       .runs = {}});
    }
    Cell& cell = cells[found->second];
    if (run.is_refused) continue;
    cell.is_refused = false;
    // A NaN error (no answer) is at most nothing.
    if (run.seconds >= 0.0) cell.runs.emplace_back(run.error, run.seconds);
  }
  return cells;
}

struct Sum {
  LevelScore score;
  double logs = 0.0;
};

void add(const Cell& cell, double level, Sum& sum) {
  if (cell.is_refused) {
    ++sum.score.refused;
    return;
  }
  ++sum.score.problems;
  const double seconds = cell.seconds(level);
  const bool is_solved = seconds < kInfinity;
  if (is_solved) ++sum.score.solved;
  sum.logs += std::log((is_solved ? seconds : cell.limit_seconds) + kShiftSeconds);
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
    return a.form < b.form || (a.form == b.form && a.size < b.size);
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

/// The smallest level at which the solver of this score solves the whole class.
double finest_level(std::span<const LevelScore> scores, const LevelScore& of) {
  double finest = of.level;
  for (const LevelScore& score : scores) {
    if (score.which == of.which && score.solver == of.solver && solved_all(score)) {
      finest = std::min(finest, score.level);
    }
  }
  return finest;
}

/// Of ours that solve everything and take at most kAsFast times the fastest's time, the most
/// accurate, of equally accurate ones the fastest; null for none.
const LevelScore* recommended(std::span<const LevelScore> scores, const ProblemClass& which,
                              double level) {
  constexpr double kAsFast = 1.1;
  const LevelScore* best = fastest(scores, which, level, true);
  if (best == nullptr) return nullptr;
  const double most_seconds = kAsFast * best->mean_seconds;
  for (const LevelScore& score : scores) {
    if (score.which != which || score.level != level || !solved_all(score)) continue;
    if (score.library != "Signorini" || score.mean_seconds > most_seconds) continue;
    const double finest = finest_level(scores, score);
    const double so_far = finest_level(scores, *best);
    if (finest < so_far || (finest == so_far && score.mean_seconds < best->mean_seconds)) {
      best = &score;
    }
  }
  return best;
}

/// Of a class and level the solver, of ours or of others, that solves most, then the fastest; null
/// for none.
const LevelScore* most_solved(std::span<const LevelScore> scores, const ProblemClass& which,
                              double level, bool ours) {
  const LevelScore* best = nullptr;
  for (const LevelScore& score : scores) {
    if (score.which != which || score.level != level) continue;
    if (ours != (score.library == "Signorini")) continue;
    if (best == nullptr || score.solved > best->solved ||
        (score.solved == best->solved && score.mean_seconds < best->mean_seconds)) {
      best = &score;
    }
  }
  return best;
}

/// "ODE ode-dantzig", "Bullet SI50".
std::string full_name(const LevelScore& score) {
  return score.solver.starts_with(score.library) ? score.solver
                                                 : score.library + " " + score.solver;
}

std::string recommendation_without_all(std::span<const LevelScore> scores,
                                       const ProblemClass& which, double level) {
  const LevelScore* ours = most_solved(scores, which, level, true);
  const LevelScore* theirs = most_solved(scores, which, level, false);
  const auto count = [](const LevelScore& score) {
    return fmt::format("{} of {}", score.solved, score.problems + score.refused);
  };
  std::string text =
      ours == nullptr || ours->solved == 0
          ? "nothing of ours"
          : fmt::format("none of ours solves all; `{}` {}", ours->solver, count(*ours));
  if (theirs != nullptr && theirs->solved > (ours == nullptr ? 0 : ours->solved)) {
    text += fmt::format(" ({}: {})", full_name(*theirs), count(*theirs));
  }
  return text;
}

std::string recommendation(std::span<const LevelScore> scores, const ProblemClass& which,
                           double level) {
  const LevelScore* ours = recommended(scores, which, level);
  if (ours == nullptr) return recommendation_without_all(scores, which, level);
  std::string text = fmt::format("`{}` {}", ours->solver, short_time(ours->mean_seconds));
  const LevelScore* all = fastest(scores, which, level, false);
  if (all->library != "Signorini") {
    text += fmt::format(" ({} is faster: {})", full_name(*all), short_time(all->mean_seconds));
  }
  return text;
}

std::string recommendation_table(std::span<const LevelScore> scores) {
  const std::vector<double> levels = levels_of(scores);
  const bool scenes = !scores.empty() && scores.front().which.is_scene();
  std::string text = scenes ? "| scenes | bodies up to |" : "| problems | rows up to |";
  std::string rule = "|---|---|";
  for (const double level : levels) {
    text += fmt::format(" error {:g} |", level);
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const ProblemClass& which : classes_of(scores)) {
    text += fmt::format("| {} | {} |", which.form, which.size);
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
    text += fmt::format("- {}, up to {} {}:", which.form, which.size, which.unit);
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
      "| what | size up to | error | solver | solved | shifted geometric mean |\n"
      "|---|---|---|---|---|---|\n";
  for (const LevelScore& score : scores) {
    text += fmt::format("| {} | {} {} | {:g} | `{}` | {} of {}{} | {} |\n", score.which.form,
                        score.which.size, score.which.unit, score.level, score.solver, score.solved,
                        score.problems,
                        score.refused > 0 ? fmt::format(", {} refused", score.refused) : "",
                        short_time(score.mean_seconds));
  }
  return text;
}

}  // namespace

int class_size(int count) {
  int bound = 16;
  while (bound < count) bound *= 4;
  return bound;
}

std::vector<TradeRun> trade_runs(std::span<const DialRuns> dial, double limit_seconds) {
  std::vector<TradeRun> runs;
  for (const DialRuns& position : dial) {
    for (const PeersRow& row : position.result.rows) {
      runs.push_back({.problem = row.problem + "/" + row.form,
                      .which = {row.form, class_size(row.n)},
                      .solver = row.solver,
                      .library = row.library,
                      .is_refused = row.run.verdict == Verdict::kRefused,
                      .error = row.run.certificate.natural_residual,
                      .seconds = row.run.seconds,
                      .limit_seconds = limit_seconds});
    }
  }
  return runs;
}

std::vector<LevelScore> level_scores(std::span<const TradeRun> runs,
                                     std::span<const double> levels) {
  const std::vector<Cell> cells = cells_of(runs);
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
      add(cell, level, *found);
    }
    for (Sum& sum : sums) {
      if (sum.score.problems == 0) continue;
      sum.score.mean_seconds = std::exp(sum.logs / sum.score.problems) - kShiftSeconds;
      scores.push_back(std::move(sum.score));
    }
  }
  return scores;
}

std::vector<LevelScore> worst_error_scores(std::span<const TradeRun> runs) {
  std::vector<Sum> sums;
  for (const TradeRun& run : runs) {
    auto found = std::find_if(sums.begin(), sums.end(), [&](const Sum& sum) {
      return sum.score.which == run.which && sum.score.solver == run.solver;
    });
    if (found == sums.end()) {
      sums.push_back({{.which = run.which,
                       .level = kLeastError,
                       .solver = run.solver,
                       .library = run.library}});
      found = sums.end() - 1;
    }
    ++found->score.problems;
    if (!(run.error < kInfinity) || run.seconds < 0.0) continue;
    ++found->score.solved;
    found->score.level = std::max(found->score.level, run.error);
    found->logs += std::log(run.seconds + kShiftSeconds);
  }
  std::vector<LevelScore> scores;
  for (Sum& sum : sums) {
    if (!solved_all(sum.score)) continue;
    sum.score.mean_seconds = std::exp(sum.logs / sum.score.problems) - kShiftSeconds;
    scores.push_back(std::move(sum.score));
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

std::vector<ProfilePanel> level_profiles(std::span<const TradeRun> runs, double level) {
  std::vector<ProfilePanel> panels;
  std::map<std::pair<std::string, std::string>, bool> takes;  // form and solver: any problem at all
  std::vector<Cell> cells = cells_of(runs);
  for (const Cell& cell : cells) takes[{cell.which.form, cell.solver}] |= !cell.is_refused;
  std::erase_if(cells, [&](const Cell& cell) { return !takes[{cell.which.form, cell.solver}]; });
  // Of a partial study the problems on which not everybody has been are left out.
  std::map<std::string, int> solvers_of_form;
  std::map<std::string, int> solvers_of_problem;
  for (const auto& [key, any] : takes) solvers_of_form[key.first] += any ? 1 : 0;
  for (const Cell& cell : cells) ++solvers_of_problem[cell.problem];
  for (const Cell& cell : cells) {
    if (solvers_of_problem[cell.problem] < solvers_of_form[cell.which.form]) continue;
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
  for (ProfilePanel& panel : panels) panel.title += fmt::format(", error {:g}", level);
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
      "what,size_up_to,unit,level,solver,library,problems,solved,refused,shifted_geometric_mean_"
      "s\n";
  for (const LevelScore& score : scores) {
    text +=
        fmt::format("{},{},{},{:g},\"{}\",{},{},{},{},{:.6g}\n", score.which.form, score.which.size,
                    score.which.unit, score.level, score.solver, score.library, score.problems,
                    score.solved, score.refused, score.mean_seconds);
  }
  return text;
}

namespace {

std::string chapter(std::span<const LevelScore> scores) {
  return fmt::format(
      "{}\n### Pareto fronts\n\nNothing is both more accurate and faster.\n\n{}\n### Success "
      "rates and mean times\n\n{}\n",
      recommendation_table(scores), fronts_text(scores), rates_table(scores));
}

}  // namespace

std::string tradeoff_markdown(std::span<const LevelScore> problems,
                              std::span<const LevelScore> scenes,
                              const std::vector<std::string>& remarks) {
  std::string text = "# The trade: error against time\n\n";
  for (const std::string& remark : remarks) text += "- " + remark + "\n";
  text += fmt::format(
      "\nFor this error, at this size, use this: of ours that solve every problem or "
      "scene of the class the fastest, or what is more accurate and at most a tenth slower; a "
      "faster peer is named. Times are shifted geometric means over "
      "the class (shift {:g} s). All that was measured is in tradeoff.csv and scenes.csv, the "
      "scores in scores.csv.\n",
      kShiftSeconds);
  if (!scenes.empty()) {
    text +=
        "\n## Scenes\n\nError: that of the scene's file (closed form or conservation law), over "
        "the size that is wholly wrong; time: of whole steps with collision detection, for one "
        "simulated second. `step/4`: a quarter of the scene's step.\n\n" +
        chapter(scenes);
  }
  if (!problems.empty()) {
    text +=
        "\n## Contact problems\n\nError: the natural residual max|min(z, w)| / (1 + |q|) of the "
        "answer, judged on the problem's data; time: of the fastest dial position whose answer is "
        "good enough.\n\n" +
        chapter(problems);
  }
  return text;
}

std::string recommendations_markdown(std::span<const LevelScore> problems,
                                     std::span<const LevelScore> scenes) {
  std::string text;
  if (!scenes.empty()) text += recommendation_table(scenes);
  if (!problems.empty()) text += (text.empty() ? "" : "\n") + recommendation_table(problems);
  return text;
}

}  // namespace signorini::bench
