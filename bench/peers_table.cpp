#include "bench/peers_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace signorini::bench {
namespace {

/// Keys in the order of their first appearance.
template <typename Key>
void add_once(std::vector<Key>& keys, const Key& key) {
  if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
    keys.push_back(key);
  }
}

/// The runs of one form and family, as rows and columns.
struct Grid {
  std::string title;
  std::vector<std::string> solvers;
  std::vector<std::string> problems;
  std::map<std::string, std::string> column_of;
  std::map<std::pair<std::string, std::string>, const PeersRow*> cells;  // solver, problem

  [[nodiscard]] const PeersRow* at(const std::string& solver, const std::string& problem) const {
    const auto found = cells.find({solver, problem});
    return found == cells.end() ? nullptr : found->second;
  }
  /// Seconds of the fastest solver of a problem, infinity if there is none.
  [[nodiscard]] double best(const std::string& problem) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::string& solver : solvers) {
      const PeersRow* row = at(solver, problem);
      if (row != nullptr && row->run.verdict == Verdict::kSolved) {
        least = std::min(least, row->run.seconds);
      }
    }
    return least;
  }
};

constexpr std::size_t kMostColumns = 18;  // three sizes, three mass ratios, moving and at rest
constexpr std::size_t kFewColumns = 8;    // of one piece of a longer table

/// A table of many problems as several of a few.
void split(const Grid& grid, std::vector<Grid>& all) {
  const std::size_t count = grid.problems.size();
  const std::size_t step = count <= kMostColumns ? kMostColumns : kFewColumns;
  for (std::size_t first = 0; first < count; first += step) {
    Grid piece = grid;
    piece.problems.assign(
        grid.problems.begin() + static_cast<std::ptrdiff_t>(first),
        grid.problems.begin() + static_cast<std::ptrdiff_t>(std::min(count, first + step)));
    all.push_back(std::move(piece));
  }
}

std::vector<Grid> grids(const PeersResult& result) {
  std::vector<std::pair<std::string, std::string>> keys;
  std::map<std::pair<std::string, std::string>, Grid> by_key;
  for (const PeersRow& row : result.rows) {
    const std::pair<std::string, std::string> key(row.form, row.family);
    add_once(keys, key);
    Grid& grid = by_key[key];
    grid.title = fmt::format("{}: {}", row.form, row.family);
    add_once(grid.problems, row.problem);
    grid.column_of[row.problem] = row.column;
    if (row.run.verdict != Verdict::kRefused) {
      add_once(grid.solvers, row.solver);
    }
    grid.cells[{row.solver, row.problem}] = &row;
  }
  std::vector<Grid> all;
  for (const auto& key : keys) {
    split(by_key[key], all);
  }
  return all;
}

/// The floor's line and the line of the fastest solver's ratio to it, or nothing if no problem of
/// the table has one: name, then one cell a problem.
std::vector<std::vector<std::string>> floor_lines(const Grid& grid) {
  std::vector<std::string> floors = {"(floor)"};
  std::vector<std::string> ratios = {"(best / floor)"};
  bool has_any = false;
  for (const std::string& problem : grid.problems) {
    double floor = -1.0;
    for (const auto& [key, row] : grid.cells) {
      floor = key.second == problem ? std::max(floor, row->floor_seconds) : floor;
    }
    has_any = has_any || floor > 0.0;
    floors.push_back(floor > 0.0 ? short_time(floor) : "");
    ratios.push_back(floor > 0.0 ? fmt::format("{:.1f}", grid.best(problem) / floor) : "");
  }
  return has_any ? std::vector{floors, ratios} : std::vector<std::vector<std::string>>{};
}

std::string cell(const PeersRow* row) {
  if (row == nullptr) {
    return "";
  }
  const PeerRun& run = row->run;
  switch (run.verdict) {
    case Verdict::kSolved: return short_time(run.seconds);
    case Verdict::kUnsolved: return fmt::format("R={:.0e}", run.certificate.natural_residual);
    default: return std::string(mark(run.verdict));
  }
}

/// A CSV field; quoted where it has to be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char letter : text) {
    quoted.append(letter == '"' ? 2 : 1, letter);
  }
  quoted += '"';
  return quoted;
}

std::string count_field(int count) {
  return count < 0 ? "" : std::to_string(count);
}

std::string seconds_field(double seconds) {
  return seconds < 0.0 ? "" : fmt::format("{:.9g}", seconds);
}

std::string_view claim_text(const PeerRun& run) {
  if (run.seconds < 0.0) {
    return "";
  }
  return run.claim == Claim::kSolved   ? "solved"
         : run.claim == Claim::kFailed ? "failed"
                                       : "nothing";
}

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(width > text.size() ? width - text.size() : 0, ' ');
  return left ? text + blanks : blanks + text;
}

}  // namespace

std::string short_time(double seconds) {
  const auto digits = [](double value, const char* unit) {
    return value < 9.95 ? fmt::format("{:.1f}{}", value, unit)
                        : fmt::format("{:.0f}{}", value, unit);
  };
  if (seconds < 999.5e-6) {
    return digits(seconds * 1e6, "us");
  }
  return seconds < 0.9995 ? digits(seconds * 1e3, "ms") : digits(seconds, "s");
}

std::string peers_csv(const PeersResult& result) {
  std::string csv =
      "problem,form,family,n,mass_ratio,at_rest,solver,library,claim,said,verdict,"
      "natural_residual,unit_free_residual,natural_floor,seconds,first_seconds,repeats,iterations,"
      "pivots,factorizations,floor_seconds,times_floor\n";
  for (const PeersRow& row : result.rows) {
    const PeerRun& run = row.run;
    const bool has_ratio = row.floor_seconds > 0.0 && run.verdict == Verdict::kSolved;
    csv += fmt::format(
        "{},{},{},{},{:g},{},{},{},{},{},{},{:.3e},{:.3e},{:.3e},{},{},{},{},{},{},{},{}\n",
        field(row.problem), row.form, row.family, row.n, row.mass_ratio, row.at_rest ? 1 : 0,
        row.solver, row.library, claim_text(run), field(run.said), to_string(run.verdict),
        run.certificate.natural_residual, run.certificate.unit_free_residual,
        run.certificate.natural_floor, seconds_field(run.seconds), seconds_field(run.first_seconds),
        run.repeats, count_field(run.iterations), count_field(run.pivots),
        count_field(run.factorizations), seconds_field(row.floor_seconds),
        has_ratio ? fmt::format("{:.4g}", run.seconds / row.floor_seconds) : "");
  }
  return csv;
}

std::string peers_text(const PeersResult& result) {
  std::string text;
  for (const Grid& grid : grids(result)) {
    std::size_t name_width = std::max<std::size_t>(grid.title.size(), 14);
    for (const std::string& solver : grid.solvers) {
      name_width = std::max(name_width, solver.size());
    }
    text += fmt::format("\n{}", padded(grid.title, name_width, true));
    std::vector<std::size_t> widths;
    for (const std::string& problem : grid.problems) {
      widths.push_back(std::max<std::size_t>(grid.column_of.at(problem).size(), 7));
      text += fmt::format("  {}", padded(grid.column_of.at(problem), widths.back(), false));
    }
    text += "\n";
    for (const std::string& solver : grid.solvers) {
      text += padded(solver, name_width, true);
      for (std::size_t p = 0; p < grid.problems.size(); ++p) {
        text +=
            fmt::format("  {}", padded(cell(grid.at(solver, grid.problems[p])), widths[p], false));
      }
      text += "\n";
    }
    for (const std::vector<std::string>& line : floor_lines(grid)) {
      text += padded(line[0], name_width, true);
      for (std::size_t p = 0; p < grid.problems.size(); ++p) {
        text += fmt::format("  {}", padded(line[p + 1], widths[p], false));
      }
      text += "\n";
    }
  }
  return text;
}

std::vector<std::string> peers_legend() {
  // NOLINTBEGIN(bugprone-suspicious-missing-comma): lines that are long
  return {
      "time: the fastest of at least five solves in one process, after the library's own data were "
      "made from the problem (not timed); wall time, or CPU time where that is less; solves above "
      "0.1 s are timed once",
      "solved: max|min(z, w)| / (1 + |q|) (of a bounded row: its projection) within the tolerance, "
      "or within four rounding floors; recomputed in long double on the problem given, also where "
      "the solver got A_ii (1 + 1e-10) (+reg)",
      "W: said \"solved\", or returned NaN and said nothing, and it is not; F: says that it "
      "failed; "
      "T: time limit (or out of time on a smaller one of the series); C: crashed",
      "R=: what is left at the sweep limit of a method that says nothing of its answer; such a "
      "method's time is that of the first number of sweeps, doubling from 8, that is enough",
      "-: cannot take the problem",
      "floor: one sparse analyse, factor and solve of the active set, CPU time (CHOLMOD); best / "
      "floor: the fastest solver's time over it"};
  // NOLINTEND(bugprone-suspicious-missing-comma)
}

std::string peers_markdown(const PeersResult& result, const std::vector<std::string>& remarks) {
  std::string text = "# Solvers compared\n\n";
  for (const std::string& remark : remarks) {
    text += fmt::format("- {}\n", remark);
  }
  for (const std::string& line : peers_legend()) {
    text += fmt::format("- {}\n", line);
  }
  if (result.is_interrupted) {
    text += "\n**Interrupted: not all runs were made.**\n";
  }
  for (const Grid& grid : grids(result)) {
    text += fmt::format("\n## {}\n\n| solver |", grid.title);
    std::string rule = "\n|---|";
    for (const std::string& problem : grid.problems) {
      text += fmt::format(" {} |", grid.column_of.at(problem));
      rule += "---:|";
    }
    text += rule + "\n";
    for (const std::string& solver : grid.solvers) {
      text += fmt::format("| {} |", solver);
      for (const std::string& problem : grid.problems) {
        const PeersRow* row = grid.at(solver, problem);
        const bool is_best = row != nullptr && row->run.verdict == Verdict::kSolved &&
                             row->run.seconds <= grid.best(problem);
        text += is_best ? fmt::format(" **{}** |", cell(row)) : fmt::format(" {} |", cell(row));
      }
      text += "\n";
    }
    for (const std::vector<std::string>& line : floor_lines(grid)) {
      text += "|";
      for (const std::string& one : line) {
        text += fmt::format(" {} |", one);
      }
      text += "\n";
    }
  }
  return text;
}

std::vector<ProfilePanel> peers_profiles(const PeersResult& result) {
  std::vector<std::string> forms;
  for (const PeersRow& row : result.rows) {
    add_once(forms, row.form);
  }
  std::vector<ProfilePanel> panels;
  for (const std::string& form : forms) {
    std::vector<std::string> problems;
    std::vector<std::string> solvers;
    std::map<std::pair<std::string, std::string>, const PeersRow*> cells;
    for (const PeersRow& row : result.rows) {
      if (row.form == form) {
        add_once(problems, row.problem);
        cells[{row.solver, row.problem}] = &row;
        if (row.run.verdict != Verdict::kRefused) {
          add_once(solvers, row.solver);
        }
      }
    }
    ProfilePanel panel{form, {}};
    for (const std::string& solver : solvers) {
      ProfileSeries series{solver, "", {}};
      for (const std::string& problem : problems) {
        const auto found = cells.find({solver, problem});
        const PeersRow* row = found == cells.end() ? nullptr : found->second;
        const bool is_solved = row != nullptr && row->run.verdict == Verdict::kSolved;
        series.seconds.push_back(is_solved ? row->run.seconds
                                           : std::numeric_limits<double>::infinity());
        if (row != nullptr) {
          series.library = row->library;
        }
      }
      panel.series.push_back(std::move(series));
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace signorini::bench
