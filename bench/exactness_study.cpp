#include "bench/exactness_study.h"

#include <signorini/lcp/solver.h>

#include "bench/exactness_families.h"
#include "bench/rational_judge.h"

#include <cstdio>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <map>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <unistd.h>

namespace signorini::bench {
namespace {

using lcp::Status;

constexpr std::size_t kMostComplaints = 20;

/// A problem as C++ initialisers, to be pasted into a test.
std::string written_out(const lcp::ExactProblem& problem) {
  std::string text = "M{";
  for (int i = 0; i < problem.n; ++i) {
    text += i == 0 ? "{" : ", {";
    for (int j = 0; j < problem.n; ++j) {
      text += fmt::format("{}{}", j == 0 ? "" : ", ", problem.at(i, j).get_d());
    }
    text += "}";
  }
  text += "}, q{";
  for (int i = 0; i < problem.n; ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", problem.q[i].get_d());
  }
  return text + "}";
}

/// Everything about one problem that a claim is judged by.
struct Case {
  int index;
  const ExactnessFamily* family;
  lcp::ExactProblem exact;
  Truth truth;
};

bool is_by_sweeps(std::string_view solver) {
  return solver.find("pgs") != solver.npos || solver.starts_with("psor") ||
         solver.starts_with("nncg");
}

class Study {
 public:
  explicit Study(const ExactnessOptions& options) : options_(options) {
    for (const std::string_view name : lcp::solver_names()) {
      lcp::SolverSettings settings;
      settings.tolerance = options.tolerance;
      settings.recorder = options.recorder;
      settings.max_iterations = is_by_sweeps(name) ? options.pgs_sweeps : -1;
      solvers_.push_back(lcp::make_solver(name, settings));
    }
  }

  void run_problem(int index) {
    const auto [family, problem] = draw_exactness_problem(options_.seed, index);
    const lcp::ExactProblem exact = lcp::to_rational(problem);
    const Case drawn{index, family, exact, find_truth(problem, exact)};
    for (std::size_t s = 0; s < solvers_.size(); ++s) {
      if (!solvers_[s]->refuses(problem).empty()) {
        continue;
      }
      solvers_[s]->solve(problem, result_);
      count(drawn, s);
      judge(drawn);
      if (solvers_[s]->name() == "lemke") {
        judge_promise(drawn);
      }
    }
    if (family->promise != Promise::kNothing &&
        (drawn.truth.existence == Existence::kUnknown || drawn.truth.is_by_enumeration)) {
      ++counts_.undecided_promises;
      complain(drawn, "exact Lemke did not decide it");
    }
    ++counts_.problems;
  }

  ExactnessCounts take_counts() {
    for (auto& [key, row] : rows_) {
      counts_.rows.push_back(std::move(row));
    }
    return std::move(counts_);
  }

 private:
  void count(const Case& drawn, std::size_t solver) {
    const auto family = drawn.family - exactness_families().data();
    ExactnessRow& row = rows_[{static_cast<int>(family), static_cast<int>(solver), result_.status}];
    row.family = drawn.family->name;
    row.solver = solvers_[solver]->name();
    row.status = result_.status;
    ++row.count;
    switch (drawn.truth.existence) {
      case Existence::kSolution: ++row.with_solution; break;
      case Existence::kNone: ++row.without_solution; break;
      case Existence::kUnknown: ++row.undecided; break;
    }
  }

  void judge(const Case& drawn) {
    const std::string wrong =
        find_wrong_claim(drawn.exact, result_, options_.tolerance, drawn.truth);
    if (wrong.empty()) {
      return;
    }
    switch (result_.status) {
      case Status::kInfeasible: ++counts_.wrong_infeasible; break;
      case Status::kNoSolutionBelow: ++counts_.wrong_bound; break;
      default: ++counts_.wrong_solved; break;
    }
    complain(drawn, fmt::format("WRONG: {} says {}: {}", result_.solver, to_string(result_.status),
                                wrong));
  }

  /// Lemke's result against what the theory promises for the family.
  void judge_promise(const Case& drawn) {
    const bool is_promised = drawn.family->promise != Promise::kNothing;
    counts_.ray_unproven += result_.status == Status::kRayUnproven ? 1 : 0;
    if (drawn.truth.existence == Existence::kNone && is_promised) {
      counts_.weaker_proofs += result_.status != Status::kInfeasible ? 1 : 0;
    }
    if (drawn.truth.existence != Existence::kSolution || is_solved(result_.status)) {
      return;
    }
    if (!is_promised) {
      ++counts_.missed;
      return;
    }
    ++counts_.broken_promises;
    complain(drawn, fmt::format("not solved: lemke ends in \"{}\" ({}), but a solution exists",
                                to_string(result_.status), result_.detail));
  }

  void complain(const Case& drawn, const std::string& what) {
    if (counts_.complaints.size() < kMostComplaints) {
      counts_.complaints.push_back(fmt::format("problem {} of seed {} ({}): {}\n    {}",
                                               drawn.index, options_.seed, drawn.family->name, what,
                                               written_out(drawn.exact)));
    }
  }

  ExactnessOptions options_;
  std::vector<std::unique_ptr<lcp::Solver>> solvers_;
  lcp::Result result_;
  std::map<std::tuple<int, int, Status>, ExactnessRow> rows_;
  ExactnessCounts counts_;
};

void show_progress(int done, int all) {
  if (isatty(STDERR_FILENO) == 0) {
    return;
  }
  if (done % 1000 == 0 || done == all) {
    fmt::print(stderr, "\rexactness: {} of {} problems{}", done, all, done == all ? "\n" : "");
    std::fflush(stderr);
  }
}

std::string_view to_string(Promise promise) {
  switch (promise) {
    case Promise::kDecided: return "decided";
    case Promise::kSolved: return "solved";
    case Promise::kNothing: return "nothing";
  }
  return "";
}

void print_families(std::ostream& out) {
  fmt::print(out, "{:<18} {:<9} {}\n", "family", "promised", "what");
  for (const ExactnessFamily& family : exactness_families()) {
    fmt::print(out, "{:<18} {:<9} {}\n", family.name, to_string(family.promise), family.what);
  }
}

void print_table(const ExactnessCounts& counts, std::ostream& out) {
  fmt::print(out, "\n{:<18} {:<14} {:<20} {:>8} {:>13} {:>8} {:>10}\n", "family", "solver",
             "status", "count", "with solution", "without", "undecided");
  for (const ExactnessRow& row : counts.rows) {
    fmt::print(out, "{:<18} {:<14} {:<20} {:>8} {:>13} {:>8} {:>10}\n", row.family, row.solver,
               to_string(row.status), row.count, row.with_solution, row.without_solution,
               row.undecided);
  }
}

/// The endings of Lemke on a ray that proves nothing, of all families.
ExactnessRow unproven_rays(const ExactnessCounts& counts) {
  ExactnessRow sum;
  for (const ExactnessRow& row : counts.rows) {
    if (row.solver == "lemke" && row.status == Status::kRayUnproven) {
      sum.with_solution += row.with_solution;
      sum.without_solution += row.without_solution;
      sum.undecided += row.undecided;
    }
  }
  return sum;
}

void print_sums(const ExactnessCounts& counts, std::ostream& out) {
  const ExactnessRow unproven = unproven_rays(counts);
  fmt::print(out,
             "\n{} problems, every claim of every solver judged in rational arithmetic:\n"
             "  wrong `solved`:                               {}\n"
             "  wrong `infeasible`:                           {}\n"
             "  wrong `no solution below Z`:                  {}\n"
             "Exact Lemke:\n"
             "  undecided, though theory promises a decision: {}\n"
             "Lemke in doubles:\n"
             "  has a solution, promised, not solved:         {}\n"
             "  has a solution, not promised, not solved:     {}\n"
             "  has none, promised, not proven exactly:       {}\n"
             "  `ray unproven`:                               {}\n"
             "    of these with a solution {}, proven to have none {}, undecided {} (n > {}).\n"
             "    Outside the promised families the ray of a matrix proves nothing by itself.\n",
             counts.problems, counts.wrong_solved, counts.wrong_infeasible, counts.wrong_bound,
             counts.undecided_promises, counts.broken_promises, counts.missed, counts.weaker_proofs,
             counts.ray_unproven, unproven.with_solution, unproven.without_solution,
             unproven.undecided, kMostRowsEnumerated);
  for (const std::string& complaint : counts.complaints) {
    fmt::print(out, "{}\n", complaint);
  }
}

}  // namespace

std::string ExactnessCounts::to_csv() const {
  std::string csv = "family,solver,status,count,with_solution,without_solution,undecided\r\n";
  for (const ExactnessRow& row : rows) {
    csv += fmt::format("{},{},{},{},{},{},{}\r\n", row.family, row.solver, to_string(row.status),
                       row.count, row.with_solution, row.without_solution, row.undecided);
  }
  return csv;
}

ExactnessCounts run_exactness_study(const ExactnessOptions& options, std::ostream& out) {
  if (options.problems < 0) {
    throw std::invalid_argument(
        fmt::format("exactness: problems: must be >= 0, got {}", options.problems));
  }
  Study study(options);
  print_families(out);
  for (int index = 0; index < options.problems; ++index) {
    study.run_problem(index);
    show_progress(index + 1, options.problems);
  }
  ExactnessCounts counts = study.take_counts();
  print_table(counts, out);
  print_sums(counts, out);
  return counts;
}

}  // namespace signorini::bench
