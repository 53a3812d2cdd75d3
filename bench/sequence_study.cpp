#include "bench/sequence_study.h"

#include <signorini/lcp/io/recorded_solve.h>

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <map>
#include <memory>
#include <stdexcept>

namespace signorini::bench {
namespace {

using lcp::RecordedSolve;
using lcp::Vector;

class Replay {
 public:
  explicit Replay(const SequenceOptions& options) : options_(options) {}

  SequenceRow run(const std::filesystem::path& path) {
    const RecordedSolve recorded = lcp::read_recorded_solve(path);
    SequenceRow row;
    row.name = path.filename().string();
    row.rows = static_cast<int>(recorded.problem.size());
    row.recorded_status = recorded.status;
    row.recorded_seconds = recorded.seconds;
    row.solver = options_.solver;
    if (options_.solver == "recorded") {
      row.solver = recorded.solver.empty() ? "lemke" : recorded.solver;
    }
    lcp::Solver& solver = solver_called(row.solver);
    row.refused = solver.refuses(recorded.problem);
    if (!row.refused.empty()) {
      previous_.resize(0);
      return row;
    }
    row.cold = solve(solver, recorded.problem, nullptr);
    const Vector cold = result_.z;
    const Vector& start = recorded.warm_start.size() > 0 ? recorded.warm_start : previous_;
    if (start.size() == recorded.problem.size() && start.size() > 0) {
      row.warm = solve(solver, recorded.problem, &start);
    }
    previous_ = cold.allFinite() ? cold : Vector();
    return row;
  }

 private:
  lcp::Solver& solver_called(const std::string& name) {
    std::unique_ptr<lcp::Solver>& solver = solvers_[name];
    if (solver == nullptr) {
      solver = lcp::make_solver(name, options_.lcp);
    }
    return *solver;
  }

  SequenceSolve solve(lcp::Solver& solver, const lcp::Problem& problem, const Vector* start) {
    SequenceSolve solve;
    solve.ran = true;
    for (int k = 0; k < options_.repeats; ++k) {
      solver.solve(problem, result_, start);
      const double seconds = result_.statistics.solve_seconds;
      solve.seconds = k == 0 ? seconds : std::min(solve.seconds, seconds);
    }
    solve.status = result_.status;
    solve.work = std::max(result_.statistics.pivots, result_.statistics.iterations);
    solve.factorizations = result_.statistics.factorizations;
    solve.unit_free_residual = result_.certificate.unit_free_residual;
    return solve;
  }

  SequenceOptions options_;
  std::map<std::string, std::unique_ptr<lcp::Solver>> solvers_;
  lcp::Result result_;
  Vector previous_;
};

std::string text_of(const SequenceSolve& solve) {
  if (!solve.ran) {
    return fmt::format("{:<18} {:>6} {:>4} {:>9} {:>8}", "-", "", "", "", "");
  }
  return fmt::format("{:<18} {:>6} {:>4} {:>9.2e} {:>8.3f}", to_string(solve.status), solve.work,
                     solve.factorizations, solve.unit_free_residual, 1e3 * solve.seconds);
}

void print_header(std::ostream& out) {
  const std::string one =
      fmt::format("{:<18} {:>6} {:>4} {:>9} {:>8}", "status", "work", "fact", "residual", "ms");
  fmt::print(out, "{:<14} {:>6} {:<16} {:<50} {}\n", "", "", "", "cold", "warm");
  fmt::print(out, "{:<14} {:>6} {:<16} {}   {}\n", "problem", "n", "solver", one, one);
}

void print_row(const SequenceRow& row, std::ostream& out) {
  fmt::print(out, "{:<14} {:>6} {:<16} ", row.name, row.rows, row.solver);
  if (row.refused.empty()) {
    fmt::print(out, "{}   {}\n", text_of(row.cold), text_of(row.warm));
  } else {
    fmt::print(out, "refused: {}\n", row.refused);
  }
}

/// Sums over the problems that were solved warm, so that both sums speak of the same ones.
struct Sums {
  int problems = 0;
  long work[2] = {0, 0};
  long factorizations[2] = {0, 0};
  double seconds[2] = {0.0, 0.0};
};

Sums sums_of(const SequenceCounts& counts) {
  Sums sums;
  for (const SequenceRow& row : counts.rows) {
    if (!row.warm.ran) {
      continue;
    }
    ++sums.problems;
    for (const auto& [k, solve] : {std::pair(0, &row.cold), std::pair(1, &row.warm)}) {
      sums.work[k] += std::max(solve->work, 0);
      sums.factorizations[k] += std::max(solve->factorizations, 0);
      sums.seconds[k] += solve->seconds;
    }
  }
  return sums;
}

void print_sums(const SequenceCounts& counts, std::ostream& out) {
  const Sums sums = sums_of(counts);
  double cold_seconds = 0.0;
  for (const SequenceRow& row : counts.rows) {
    cold_seconds += std::max(row.cold.seconds, 0.0);
  }
  fmt::print(out, "\n{} problems, {:.3f} s cold; {} solves not solved\n", counts.rows.size(),
             cold_seconds, counts.unsolved());
  if (sums.problems > 0) {
    fmt::print(out,
               "{} of them also warm: work {} cold, {} warm; factorizations {} cold, {} warm; "
               "{:.3f} s cold, {:.3f} s warm (warm/cold {:.2f})\n",
               sums.problems, sums.work[0], sums.work[1], sums.factorizations[0],
               sums.factorizations[1], sums.seconds[0], sums.seconds[1],
               sums.seconds[1] / sums.seconds[0]);
  }
}

std::string csv_of(const SequenceSolve& solve) {
  return solve.ran ? fmt::format("{},{},{},{},{}", to_string(solve.status), solve.work,
                                 solve.factorizations, solve.unit_free_residual, solve.seconds)
                   : ",,,,";
}

}  // namespace

int SequenceCounts::unsolved() const {
  int count = 0;
  for (const SequenceRow& row : rows) {
    count += row.refused.empty() ? 0 : 1;
    count += row.cold.ran && !is_solved(row.cold.status) ? 1 : 0;
    count += row.warm.ran && !is_solved(row.warm.status) ? 1 : 0;
  }
  return count;
}

std::string SequenceCounts::to_csv() const {
  std::string csv =
      "problem,n,solver,recorded_status,recorded_seconds,cold_status,cold_work,"
      "cold_factorizations,cold_unit_free_residual,cold_seconds,warm_status,warm_work,"
      "warm_factorizations,warm_unit_free_residual,warm_seconds\r\n";
  for (const SequenceRow& row : rows) {
    csv +=
        fmt::format("{},{},{},{},{},{},{}\r\n", row.name, row.rows, row.solver, row.recorded_status,
                    row.recorded_seconds, csv_of(row.cold), csv_of(row.warm));
  }
  return csv;
}

SequenceCounts run_sequence_study(const SequenceOptions& options, std::ostream& out) {
  if (options.repeats < 1) {
    throw std::invalid_argument(
        fmt::format("sequence: repeats: must be >= 1, got {}", options.repeats));
  }
  options.lcp.validate();
  const std::vector<std::filesystem::path> problems = lcp::list_problems(options.folder);
  Replay replay(options);
  SequenceCounts counts;
  print_header(out);
  for (const std::filesystem::path& path : problems) {
    counts.rows.push_back(replay.run(path));
    print_row(counts.rows.back(), out);
  }
  print_sums(counts, out);
  return counts;
}

}  // namespace signorini::bench
