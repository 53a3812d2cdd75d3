#include "bench/fuzz_study.h"

#include <signorini/lcp/solver.h>

#include "bench/claim_judge.h"
#include "bench/fuzz_problems.h"
#include "bench/rational_judge.h"
#include "tools/child_process.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>

namespace signorini::bench {
namespace {

using lcp::Status;

constexpr std::int64_t kChunk = 2000;
constexpr std::int64_t kHeartbeat = 16;  // problems between two signs of life
constexpr std::size_t kMostComplaints = 20;
constexpr int kMostTruthRows = 12;
constexpr int kMostTruthPivots = 500;

/// The counters that travel from a child to its parent.
constexpr std::array kCounters = {
    &FuzzRow::judged,        &FuzzRow::refused,       &FuzzRow::solved,
    &FuzzRow::proofs,        &FuzzRow::invalid,       &FuzzRow::others,
    &FuzzRow::by_rationals,  &FuzzRow::with_solution, &FuzzRow::without_solution,
    &FuzzRow::sample_solved, &FuzzRow::wrong_solved,  &FuzzRow::wrong_proofs,
    &FuzzRow::wrong_others};

/// What a range of problems came to.
struct Part {
  FuzzRow row;
  std::vector<std::string> complaints;

  void add(const Part& other) {
    for (const auto counter : kCounters) {
      row.*counter += other.row.*counter;
    }
    row.hangs += other.row.hangs;
    row.crashes += other.row.crashes;
    for (const std::string& complaint : other.complaints) {
      complain(complaint);
    }
  }
  void complain(const std::string& text) {
    if (complaints.size() < kMostComplaints) {
      complaints.push_back(text);
    }
  }
};

std::string to_text(const Part& part) {
  std::string text;
  for (const auto counter : kCounters) {
    text += fmt::format("{} ", part.row.*counter);
  }
  text += '\n';
  for (const std::string& complaint : part.complaints) {
    text += complaint + "\n";
  }
  return text;
}

Part from_text(const std::string& text) {
  Part part;
  std::istringstream stream(text);
  for (const auto counter : kCounters) {
    stream >> part.row.*counter;
  }
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    part.complaints.push_back(line);
  }
  return part;
}

/// A number that a child writes and its parent reads, also when the child was killed.
class SharedIndex {
 public:
  SharedIndex()
      : page_(::mmap(nullptr, sizeof(std::int64_t), PROT_READ | PROT_WRITE,
                     MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (page_ == MAP_FAILED) {
      throw std::runtime_error("fuzz: no shared memory");
    }
  }
  ~SharedIndex() { ::munmap(page_, sizeof(std::int64_t)); }
  SharedIndex(const SharedIndex&) = delete;
  SharedIndex& operator=(const SharedIndex&) = delete;
  volatile std::int64_t& value() { return *static_cast<volatile std::int64_t*>(page_); }

 private:
  void* page_;
};

/// One solver on ranges of problems.
class SolverRun {
 public:
  SolverRun(const FuzzOptions& options, const FuzzSolver& solver)
      : options_(options), solver_(solver) {}

  Part run(std::int64_t first, std::int64_t end, volatile std::int64_t& at,
           const std::function<void()>& alive) {
    const auto solver =
        solver_.make({.tolerance = options_.tolerance, .max_iterations = options_.max_iterations});
    Part part;
    for (std::int64_t index = first; index < end; ++index) {
      at = index;
      if (index % kHeartbeat == 0) {
        alive();
      }
      run_problem(index, *solver, part);
    }
    return part;
  }

  /// Runs a range in a child; what hangs or crashes is counted and passed over.
  Part run_in_children(std::int64_t first, std::int64_t end, FuzzCounts& counts) {
    Part sum;
    SharedIndex at;
    const tools::ChildLimits limits{.seconds = options_.hang_seconds,
                                    .loading_seconds = options_.hang_seconds + 60.0};
    while (first < end && !counts.is_interrupted) {
      at.value() = first;
      const tools::ChildAnswer answer = tools::run_in_child(
          [&](const std::function<void()>& alive) {
            alive();
            return to_text(run(first, end, at.value(), alive));
          },
          limits);
      if (answer.end == tools::ChildEnd::kAnswered) {
        sum.add(from_text(answer.answer));
        return sum;
      }
      if (answer.end == tools::ChildEnd::kInterrupted) {
        counts.is_interrupted = true;
        return sum;
      }
      const std::int64_t culprit = at.value();
      count_culprit(culprit, answer, sum);
      if (culprit > first) {
        sum.add(run_in_children(first, culprit, counts));  // what was lost with the child
      }
      first = culprit + 1;
    }
    return sum;
  }

 private:
  void run_problem(std::int64_t index, lcp::Solver& solver, Part& part) {
    const FuzzProblem drawn = draw_fuzz_problem(options_.seed, index);
    if (!solver.refuses(drawn.problem).empty()) {
      ++part.row.refused;
      return;
    }
    solver.solve(drawn.problem, result_);
    judge(index, drawn, "", part);
    if (options_.warm && draw_start(index, drawn.problem.size())) {
      solver.solve(drawn.problem, result_, &start_);
      judge(index, drawn, " --warm", part);
    }
  }

  /// start_: the last answer with noise. @return false if the answer is not there or not finite
  bool draw_start(std::int64_t index, lcp::Index rows) {
    constexpr std::array kNoise = {1e-10, 1e-6, 1e-2, 1.0};
    if (result_.z.size() != rows || rows == 0 || !result_.z.allFinite()) {
      return false;
    }
    std::mt19937_64 random(options_.seed ^ static_cast<std::uint64_t>(index));
    std::normal_distribution<double> normal(0.0, kNoise[index % kNoise.size()]);
    const double size = result_.z.cwiseAbs().maxCoeff();
    start_ = result_.z.unaryExpr([&](double z) {
      const double scaled = z * (1.0 + normal(random));
      const double moved = size * normal(random);
      return random() % 2 == 0 ? scaled + moved : scaled;
    });
    return start_.allFinite();
  }

  void judge(std::int64_t index, const FuzzProblem& drawn, std::string_view option, Part& part) {
    ++part.row.judged;
    count_status(part.row);
    const Verdict verdict = judge_claim(drawn.problem, result_, options_.tolerance);
    part.row.by_rationals += verdict.by_rationals ? 1 : 0;
    std::string wrong = verdict.wrong;
    if (wrong.empty() && index % options_.truth_every == 0) {
      wrong = judge_by_truth(drawn.problem, part.row);
    }
    if (!wrong.empty()) {
      count_wrong(part.row);
      part.complain(where(index, drawn, option) +
                    fmt::format(": says {}: {}", to_string(result_.status), wrong));
    }
  }

  void count_status(FuzzRow& row) const {
    switch (result_.status) {
      case Status::kSolved:
      case Status::kSolvedToRounding: ++row.solved; break;
      case Status::kInfeasible:
      case Status::kNoSolutionBelow: ++row.proofs; break;
      case Status::kInvalidInput: ++row.invalid; break;
      default: ++row.others; break;
    }
  }

  void count_wrong(FuzzRow& row) const {
    switch (result_.status) {
      case Status::kSolved:
      case Status::kSolvedToRounding: ++row.wrong_solved; break;
      case Status::kInfeasible:
      case Status::kNoSolutionBelow: ++row.wrong_proofs; break;
      default: ++row.wrong_others; break;
    }
  }

  /// Exact Lemke's word on whether a solution exists, against what the solver claims.
  std::string judge_by_truth(const lcp::Problem& problem, FuzzRow& row) const {
    if (!problem.is_lcp() || problem.size() > kMostTruthRows ||
        result_.status == Status::kInvalidInput) {
      return {};
    }
    lcp::ExactSolution exact = lcp::solve_exactly(problem, kMostTruthPivots);
    Truth truth;
    if (exact.ending == lcp::ExactEnding::kSolution) {
      truth = {Existence::kSolution, std::move(exact.z), false};
      ++row.with_solution;
      row.sample_solved += is_solved(result_.status) ? 1 : 0;
    } else if (exact.ray_proves_infeasible) {
      truth.existence = Existence::kNone;
      ++row.without_solution;
    }
    const bool is_proof =
        result_.status == Status::kInfeasible || result_.status == Status::kNoSolutionBelow;
    return is_proof
               ? find_wrong_claim(lcp::to_rational(problem), result_, options_.tolerance, truth)
               : "";
  }

  std::string where(std::int64_t index, const FuzzProblem& drawn, std::string_view option) const {
    return fmt::format("--seed {} --solver {} --first {} --problems 1{} ({}, n = {})",
                       options_.seed, solver_.name, index, option, drawn.recipe,
                       drawn.problem.size());
  }

  void count_culprit(std::int64_t index, const tools::ChildAnswer& answer, Part& part) const {
    const bool hangs = answer.end == tools::ChildEnd::kTimedOut;
    (hangs ? part.row.hangs : part.row.crashes) += 1;
    part.complain(
        where(index, draw_fuzz_problem(options_.seed, index), options_.warm ? " --warm" : "") +
        (hangs ? fmt::format(": hangs for {} s", options_.hang_seconds)
               : ": crashes: " + answer.reason));
  }

  FuzzOptions options_;
  FuzzSolver solver_;
  lcp::Result result_;
  lcp::Vector start_;
};

void check(const FuzzOptions& options) {
  const auto refuse = [](const char* name, const char* bound, auto value) {
    throw std::invalid_argument(fmt::format("fuzz: {}: must be {}, got {}", name, bound, value));
  };
  if (options.first < 0) refuse("first", ">= 0", options.first);
  if (options.problems < 0) refuse("problems", ">= 0", options.problems);
  if (options.truth_every < 1) refuse("truth_every", "> 0", options.truth_every);
  if (!(options.hang_seconds > 0.0)) refuse("hang_seconds", "> 0", options.hang_seconds);
}

std::vector<FuzzSolver> chosen(const FuzzOptions& options, const std::vector<FuzzSolver>& solvers) {
  std::vector<FuzzSolver> found;
  std::string known;
  for (const FuzzSolver& solver : solvers) {
    if (options.solver == "all" || options.solver == solver.name) {
      found.push_back(solver);
    }
    known += (known.empty() ? "" : ", ") + solver.name;
  }
  if (found.empty()) {
    throw std::invalid_argument(
        fmt::format("fuzz: no solver is called \"{}\"; known: {}, all", options.solver, known));
  }
  return found;
}

void show_progress(const std::string& solver, std::int64_t done, std::int64_t all) {
  if (isatty(STDERR_FILENO) != 0) {
    fmt::print(stderr, "\r{}: {} of {} problems{}", solver, done, all, done == all ? "\n" : "");
    std::fflush(stderr);
  }
}

Part run_solver(const FuzzOptions& options, const FuzzSolver& solver, FuzzCounts& counts) {
  SolverRun run(options, solver);
  Part sum;
  const std::int64_t end = options.first + options.problems;
  for (std::int64_t first = options.first; first < end && !counts.is_interrupted; first += kChunk) {
    const std::int64_t last = std::min(first + kChunk, end);
    if (options.in_children) {
      sum.add(run.run_in_children(first, last, counts));
    } else {
      volatile std::int64_t at = 0;
      sum.add(run.run(first, last, at, [] {}));
    }
    show_progress(solver.name, last - options.first, options.problems);
  }
  return sum;
}

void print_header(std::ostream& out) {
  fmt::print(out, "{:<20}{:>9}{:>9}{:>9}{:>8}{:>8}{:>9} |{:>7}{:>7}{:>7}{:>6}{:>8} |{:>10}{:>8}\n",
             "solver", "judged", "refused", "solved", "proofs", "invalid", "no claim", "solved",
             "proofs", "other", "hangs", "crashes", "rationals", "s");
  fmt::print(out, "{:<72} | {:<34} |\n", "", "wrong");
}

void print_row(const FuzzRow& row, std::ostream& out) {
  fmt::print(out,
             "{:<20}{:>9}{:>9}{:>9}{:>8}{:>8}{:>9} |{:>7}{:>7}{:>7}{:>6}{:>8} |{:>10}{:>8.1f}\n",
             row.solver, row.judged, row.refused, row.solved, row.proofs, row.invalid, row.others,
             row.wrong_solved, row.wrong_proofs, row.wrong_others, row.hangs, row.crashes,
             row.by_rationals, row.seconds);
  out.flush();
}

void print_samples(const FuzzCounts& counts, std::ostream& out) {
  fmt::print(out, "\nSample solved by exact Lemke:\n");
  for (const FuzzRow& row : counts.rows) {
    fmt::print(out, "{:<20} {} with a solution, {} of them solved; {} proven to have none\n",
               row.solver, row.with_solution, row.sample_solved, row.without_solution);
  }
}

}  // namespace

std::int64_t FuzzCounts::wrong() const {
  std::int64_t sum = 0;
  for (const FuzzRow& row : rows) {
    sum += row.wrong();
  }
  return sum;
}

std::string FuzzCounts::to_csv() const {
  std::string csv =
      "solver,judged,refused,solved,proofs,invalid,no_claim,by_rationals,sample_with_solution,"
      "sample_without_solution,sample_solved,wrong_solved,wrong_proofs,wrong_others,hangs,crashes,"
      "seconds\r\n";
  for (const FuzzRow& row : rows) {
    csv += row.solver;
    for (const auto counter : kCounters) {
      csv += fmt::format(",{}", row.*counter);
    }
    csv += fmt::format(",{},{},{}\r\n", row.hangs, row.crashes, row.seconds);
  }
  return csv;
}

std::vector<FuzzSolver> registered_solvers() {
  std::vector<FuzzSolver> solvers;
  for (const std::string_view name : lcp::solver_names()) {
    solvers.push_back({std::string(name), [name](const lcp::SolverSettings& settings) {
                         return lcp::make_solver(name, settings);
                       }});
  }
  return solvers;
}

FuzzCounts run_fuzz_study(const FuzzOptions& options, std::ostream& out,
                          const std::vector<FuzzSolver>& solvers) {
  check(options);
  FuzzCounts counts;
  print_header(out);
  for (const FuzzSolver& solver : chosen(options, solvers)) {
    if (counts.is_interrupted) {
      break;
    }
    const auto start = std::chrono::steady_clock::now();
    Part part = run_solver(options, solver, counts);
    part.row.solver = solver.name;
    part.row.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    print_row(part.row, out);
    counts.rows.push_back(part.row);
    counts.complaints.insert(counts.complaints.end(), part.complaints.begin(),
                             part.complaints.end());
  }
  print_samples(counts, out);
  for (const std::string& complaint : counts.complaints) {
    fmt::print(out, "WRONG: {}\n", complaint);
  }
  return counts;
}

}  // namespace signorini::bench
