// signorini-solve: reads a problem, solves it, says how good the answer is.

#include <signorini/lcp/io/dump_recorder.h>
#include <signorini/lcp/io/recorded_solve.h>
#include <signorini/lcp/io/result_text.h>
#include <signorini/lcp/io/result_writer.h>
#include <signorini/lcp/solver.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

namespace signorini::lcp {
namespace {

enum ExitCode {
  kSolved = 0,
  kNotSolved = 2,
  kBadUsage = 64,
  kBadInput = 65,
  kSoftware = 70,
  kCannotWrite = 73,
};

/// Above this size `all` leaves out the rational solver unless a time limit is set: numbers grow
/// with every pivot, and a few hundred rows take hours.
constexpr Index kExactRowsInAll = 60;

constexpr const char* kFooter =
    "PROBLEM is a folder with problem.txt and W.mtx, q.mtx or a factored form (docs/\n"
    "problem-folders.md), or an FCLIB file (.hdf5), local or global form.\n"
    "--solver auto chooses by size and structure, hands on what a failure reached, and lists what\n"
    "it tried; all runs every solver and prints a table.\n"
    "A problem that was dumped with a warm start is solved with it; --warm-start FILE (one number\n"
    "a line) takes another, --cold none.\n"
    "--output gets z, one number a line, written whole or not at all: of an unsolved problem the\n"
    "best iterate, and the program says so.\n"
    "--islands adds a certificate for every set of rows that nothing connects, measured against\n"
    "its own q, which a larger q elsewhere cannot hide.\n"
    "--dump DIR[:OPTION,...], or the environment variable SIGNORINI_DUMP, writes every solve for "
    "a\n"
    "replay; options: all (default), unsolved; folder (default), hdf5, both; max=N.\n"
    "Exit code: 0 solved or solved to rounding, 2 not solved (the status is printed), 64 bad "
    "usage,\n"
    "65 bad input (file, line and what was expected), 73 the output cannot be written.";

struct Options {
  std::string problem;
  std::string solver = "auto";
  SolverSettings settings;
  std::string output;
  std::string friction_law;  // empty: the problem's own
  std::string warm_start;    // a file; empty: the problem's own
  bool cold = false;
  std::string dump;
  bool json = false;
};

/// What is solved, and from where.
struct Task {
  RecordedSolve recorded;
  std::string start;  // where the warm start is from, for people; empty: cold
  [[nodiscard]] const Problem& problem() const { return recorded.problem; }
  [[nodiscard]] const Vector* warm_start() const {
    return start.empty() ? nullptr : &recorded.warm_start;
  }
};

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) {
    throw OutputError("standard output: not written");
  }
}

/// To standard error; if that fails, too, there is nobody to tell.
void print_error(const std::string& line) {
  std::fputs((line + "\n").c_str(), stderr);
}

/// One line on standard error while something takes long, if a person is looking.
void show_progress(const std::string& text) {
  if (::isatty(STDERR_FILENO) != 0) {
    print_error(text);
  }
}

void check_solver_name(const std::string& name) {
  const auto known = solver_names();
  if (name != "all" && std::ranges::find(known, name) == known.end()) {
    throw UsageError(fmt::format("--solver: no solver is called '{}'; known: {}, all", name,
                                 fmt::join(known, ", ")));
  }
}

void check_output(const std::string& output) {
  if (output.empty()) {
    return;
  }
  const std::filesystem::path path(output);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw UsageError(fmt::format("--output: {} is not a folder", folder.string()));
  }
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    throw UsageError(fmt::format("--output: {} exists and is not a regular file", output));
  }
}

Result solve_with(std::string_view name, const Problem& problem, SolverSettings settings,
                  const Vector* warm_start = nullptr) {
  show_progress(fmt::format("{}: solving, n = {} ...", name, problem.size()));
  Result result;
  make_solver(name, settings)->solve(problem, result, warm_start);
  return result;
}

/// Endings that another solver cannot improve on.
bool is_final(Status status) {
  return is_solved(status) || status == Status::kInfeasible || status == Status::kInvalidInput;
}

/// The answer; else what a ray proves; else the iterate with the smallest unit-free residual. The
/// first of equals.
std::size_t best_of(const std::vector<Result>& results) {
  const auto rank = [](const Result& result) {
    const double residual = result.certificate.unit_free_residual;
    return std::pair(is_final(result.status)                     ? 0
                     : result.status == Status::kNoSolutionBelow ? 1
                                                                 : 2,
                     residual >= 0.0 ? residual : std::numeric_limits<double>::infinity());
  };
  const auto best = std::ranges::min_element(results, {}, rank);
  return static_cast<std::size_t>(best - results.begin());
}

struct AllResults {
  std::vector<Result> results;
  std::vector<std::string> left_out;  // solver and why
};

AllResults solve_all(const Task& task, const SolverSettings& settings) {
  const Problem& problem = task.problem();
  AllResults all;
  for (const std::string_view name : solver_names()) {
    std::string why = make_solver(name)->refuses(problem);
    if (name == "exact" && problem.size() > kExactRowsInAll &&
        !std::isfinite(settings.time_limit)) {
      why = fmt::format("n = {} > {} (set --time-limit, or ask for it alone)", problem.size(),
                        kExactRowsInAll);
    }
    if (why.empty()) {
      all.results.push_back(solve_with(name, problem, settings, task.warm_start()));
    } else {
      all.left_out.push_back(fmt::format("{}: {}", name, why));
    }
  }
  return all;
}

void write_output(const Options& options, const Result& result) {
  if (options.output.empty()) {
    return;
  }
  if (!result.z.allFinite()) {
    print_error(fmt::format("{}: not written: there is no z ({})", options.output,
                            to_string(result.status)));
    return;
  }
  try {
    write_vector(options.output, result.z);
  } catch (const std::runtime_error& error) {
    throw OutputError(error.what());
  }
  if (!options.json || !is_solved(result.status)) {
    print_error(fmt::format(
        "{}: written ({})", options.output,
        is_solved(result.status) ? "the solution" : "the best iterate, NOT a solution"));
  }
}

int exit_code(const Result& result) {
  if (is_solved(result.status)) {
    return kSolved;
  }
  return result.status == Status::kInvalidInput ? kBadInput : kNotSolved;
}

/// The friction law of a problem with cones, else empty.
std::string_view law_text(const Problem& problem) {
  return problem.cones.empty() ? std::string_view() : to_string(problem.friction_law);
}

int run_all(const Options& options, const Task& task) {
  const AllResults all = solve_all(task, options.settings);
  if (options.json) {
    print(results_json(all.results, options.settings.tolerance, all.left_out,
                       law_text(task.problem())));
  } else {
    print(results_table(all.results));
    for (const std::string& line : all.left_out) {
      print(fmt::format("left out    {}\n", line));
    }
  }
  if (all.results.empty()) {
    return kNotSolved;
  }
  const Result& best = all.results[best_of(all.results)];
  write_output(options, best);
  return exit_code(best);
}

int run_one(const Options& options, const Task& task) {
  if (const std::string why = make_solver(options.solver)->refuses(task.problem()); !why.empty()) {
    throw UsageError(fmt::format("--solver {}: {}", options.solver, why));
  }
  const Result result =
      solve_with(options.solver, task.problem(), options.settings, task.warm_start());
  if (options.json) {
    print(result_json(result, options.settings.tolerance, law_text(task.problem())));
  } else {
    print(result_text(result, options.settings.tolerance));
  }
  write_output(options, result);
  return exit_code(result);
}

FrictionLaw law_of(const std::string& name) {
  if (name != "coulomb" && name != "associated") {
    throw UsageError(
        fmt::format("--friction-law: expected coulomb or associated, found '{}'", name));
  }
  return name == "coulomb" ? FrictionLaw::kCoulomb : FrictionLaw::kAssociated;
}

Task read_task(const Options& options) {
  Task task;
  RecordedSolve& recorded = task.recorded;
  recorded = read_recorded_solve(options.problem);
  if (!options.friction_law.empty()) {
    recorded.problem.friction_law = law_of(options.friction_law);
  }
  if (!options.warm_start.empty()) {
    recorded.warm_start = read_numbers(options.warm_start, recorded.problem.size());
    task.start = options.warm_start;
  } else if (!options.cold && recorded.warm_start.size() > 0) {
    task.start = "recorded with the problem";
  }
  return task;
}

void print_task(const Options& options, const Task& task) {
  print(fmt::format("problem     {}: {}\n", options.problem, problem_text(task.problem())));
  for (const std::string& note : task.recorded.notes) {
    print(fmt::format("read        {}\n", note));
  }
  if (!task.start.empty()) {
    print(fmt::format("warm start  {}\n", task.start));
  }
  const RecordedSolve& recorded = task.recorded;
  if (!recorded.solver.empty()) {
    print(fmt::format("recorded    {}: {}, {} pivots/iterations, {:.3g} s, tolerance {:.1e}\n",
                      recorded.solver, recorded.status, recorded.work, recorded.seconds,
                      recorded.settings.tolerance));
  }
}

std::unique_ptr<DumpRecorder> make_recorder(const Options& options) {
  try {
    return options.dump.empty() ? dump_recorder_from_environment()
                                : std::make_unique<DumpRecorder>(DumpSettings::parse(options.dump));
  } catch (const std::invalid_argument& error) {
    throw UsageError(options.dump.empty() ? error.what() : fmt::format("--dump: {}", error.what()));
  } catch (const std::exception& error) {
    throw OutputError(error.what());
  }
}

void check_options(const Options& options) {
  check_solver_name(options.solver);
  if (options.cold && !options.warm_start.empty()) {
    throw UsageError("--cold and --warm-start exclude each other");
  }
  if (!options.friction_law.empty()) {
    (void)law_of(options.friction_law);
  }
  try {
    options.settings.validate();
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  check_output(options.output);
}

int run(Options& options) {
  check_options(options);
  const std::unique_ptr<DumpRecorder> recorder = make_recorder(options);
  options.settings.recorder = recorder.get();
  show_progress(fmt::format("reading {} ...", options.problem));
  const Task task = read_task(options);
  if (!options.json) {
    print_task(options, task);
  }
  const int code = options.solver == "all" ? run_all(options, task) : run_one(options, task);
  if (recorder != nullptr) {
    print_error(summary(*recorder));
  }
  if (std::fflush(stdout) != 0) {
    throw OutputError("standard output: not written");
  }
  return code;
}

int complain(int code, std::string_view what) {
  print_error(fmt::format("signorini-solve: {}", what));
  return code;
}

}  // namespace
}  // namespace signorini::lcp

int main(int argc, char** argv) {
  using namespace signorini::lcp;
  Options options;
  CLI::App app(
      "Solves a linear complementarity problem w = M z + q, 0 <= z, 0 <= w, z.w = 0, also with "
      "free "
      "rows, bounds and friction cones, and certifies the answer.",
      "signorini-solve");
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("signorini-solve ") + SIGNORINI_VERSION);
  app.add_option("PROBLEM", options.problem, "a problem folder or an FCLIB .hdf5 file")->required();
  app.add_option("--solver", options.solver,
                 fmt::format("{} or all", fmt::join(solver_names(), ", ")))
      ->capture_default_str();
  app.add_option("--tolerance", options.settings.tolerance,
                 "what both residuals must be at most, > 0")
      ->capture_default_str();
  app.add_option("--max-iterations", options.settings.max_iterations,
                 "pivots, sweeps or iterations; -1: the solver's own default")
      ->capture_default_str();
  app.add_option("--time-limit", options.settings.time_limit, "seconds, > 0 (default: none)");
  app.add_option("--friction-law", options.friction_law,
                 "of friction cones: coulomb or associated (default: the problem's own)");
  app.add_option("--warm-start", options.warm_start, "file to start from, one number a line");
  app.add_flag("--cold", options.cold, "do not use the warm start that was recorded");
  app.add_flag("--islands", options.settings.certify_islands,
               "certify every island (rows that nothing connects) by itself, too");
  app.add_option("--output", options.output, "file for z");
  app.add_option("--dump", options.dump, "write every solve: DIR[:OPTION,...]");
  app.add_flag("--json", options.json, "print the result as JSON");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kSolved : kBadUsage;
  }
  try {
    return run(options);
  } catch (const UsageError& error) {
    return complain(kBadUsage, error.what());
  } catch (const InputError& error) {
    return complain(kBadInput, error.what());
  } catch (const OutputError& error) {
    return complain(kCannotWrite, error.what());
  } catch (const std::exception& error) {
    return complain(kSoftware, error.what());
  }
}
