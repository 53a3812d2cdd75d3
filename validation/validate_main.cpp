// signorini-validate: scenes in, both engines run, checks judged, the report written.

#include <signorini/lcp/solve_recorder.h>
#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/bullet_file.h>
#include <signorini/validation/bullet_runner.h>
#include <signorini/validation/drop_in.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/report_bytes.h>
#include <signorini/validation/report_repeat.h>
#include <signorini/validation/sdf_reader.h>

#ifdef SIGNORINI_HAS_IO
#include <signorini/lcp/io/dump_recorder.h>
#endif

#include "tools/file_state.h"
#include "tools/job_list.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

using namespace signorini::validation;

enum Exit {
  kGood = 0,
  kCheckFailed = 1,
  kUsage = 64,
  kBadInput = 65,
  kInternal = 70,
  kStopped = 130
};

StopFlag stop_requested{false};
static_assert(StopFlag::is_always_lock_free, "a signal handler sets it");

extern "C" void request_stop(int) {
  stop_requested.store(true);
}

struct Arguments {
  std::vector<std::string> scenes;
  RunArguments run;
  std::string out = "signorini-report";
  int processes = 1;
  bool no_trade = false;
  bool list = false;
  std::string verify;  ///< a report's folder; empty: run scenes
};

/// A built-in scene, one of Bullet's examples, or one read from a file.
struct Job {
  std::string name;
  const BuiltinScene* builtin = nullptr;
  const DropInScene* drop_in = nullptr;
  Scene scene = {};
};

void declare(CLI::App& app, Arguments& arguments) {
  app.add_option(
      "SCENE", arguments.scenes,
      "SDFormat, URDF or .bullet files, or names of built-in scenes; default: all built-in ones");
  app.add_option("--engine", arguments.run.engine, "signorini, bullet or both")
      ->check(CLI::IsMember({"signorini", "bullet", "both"}))
      ->capture_default_str();
  app.add_option("--duration", arguments.run.duration,
                 "seconds to run; default: the scene's own, or 5")
      ->check(CLI::PositiveNumber);
  app.add_option("--out", arguments.out, "folder of the report")->capture_default_str();
  app.add_option("--bullet-profile", arguments.run.bullet_profile,
                 "neutral (exact restitution, 50 iterations) or default (Bullet's own)")
      ->check(CLI::IsMember({"neutral", "default"}))
      ->capture_default_str();
  app.add_flag("--skip-unsupported", arguments.run.skip_unsupported,
               "leave out shapes and joints that are not supported, with a notice each");
  app.add_option("--ground", arguments.run.ground,
                 "add a fixed half-space z <= this height (m) to scenes read from files");
  app.add_flag("--no-trade", arguments.no_trade,
               "leave out the further runs that show error against cost");
  app.add_option(
         "--verify", arguments.verify,
         "run the scenes of a report's folder again, from the files in it, and compare every "
         "number with its report.json")
      ->check(CLI::ExistingDirectory);
  app.add_option("--jobs", arguments.processes,
                 "scenes at once, each in a process; started by mpirun or srun, the ranks take "
                 "their place. Finished scenes are kept in the folder's jobs/ until all are done: "
                 "a killed run goes on where it was. Times are then of a shared machine")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_flag("--list", arguments.list, "list the built-in scenes and end");
}

SceneReport validate(Job& job, const RunOptions& options) {
  if (job.drop_in != nullptr) return validate_drop_in(*job.drop_in, options);
  return job.builtin != nullptr ? validate_builtin(*job.builtin, options)
                                : validate_scene(std::move(job.scene), options);
}

void list_builtin_scenes() {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    fmt::print("{:<28}{}\n", builtin.name, load_builtin_scene(builtin).title);
  }
  for (const DropInScene& drop_in : drop_in_scenes()) {
    fmt::print("{:<28}{}\n", drop_in.name, drop_in.title);
  }
}

std::vector<Job> load_jobs(const Arguments& arguments) {
  std::vector<Job> jobs;
  if (arguments.scenes.empty()) {
    for (const BuiltinScene& builtin : builtin_scenes()) {
      jobs.push_back({.name = std::string(builtin.name), .builtin = &builtin});
    }
    for (const DropInScene& drop_in : drop_in_scenes()) {
      jobs.push_back({.name = std::string(drop_in.name), .drop_in = &drop_in});
    }
  }
  const ReadOptions options{arguments.run.skip_unsupported, arguments.run.ground};
  for (const std::string& name : arguments.scenes) {
    const bool is_file = std::filesystem::exists(name);
    const BuiltinScene* builtin = is_file ? nullptr : find_builtin_scene(name);
    const DropInScene* drop_in = is_file ? nullptr : find_drop_in_scene(name);
    jobs.push_back({.name = name, .builtin = builtin, .drop_in = drop_in});
    if (builtin == nullptr && drop_in == nullptr) {
      const bool terminal = isatty(STDOUT_FILENO) != 0 && signorini::tools::is_first_rank();
      if (terminal) fmt::print("reading {} ...", name);
      std::fflush(stdout);
      jobs.back().scene = read_any_scene_file(name, options);
      if (terminal) fmt::print("\r\x1b[K");
    }
  }
  return jobs;
}

RunOptions run_options(const Arguments& arguments, signorini::lcp::SolveRecorder* recorder) {
  RunOptions options = options_of(arguments.run);
  options.recorder = recorder;
  options.stop = &stop_requested;
  return options;
}

/// The command that repeats one scene.
std::string command_for(const Arguments& arguments, const std::string& scene) {
  std::string command = "signorini-validate " + scene;
  if (arguments.run.engine != "both") command += " --engine " + arguments.run.engine;
  if (arguments.run.duration) command += fmt::format(" --duration {}", *arguments.run.duration);
  if (arguments.run.bullet_profile != "neutral") {
    command += " --bullet-profile " + arguments.run.bullet_profile;
  }
  if (arguments.run.skip_unsupported) command += " --skip-unsupported";
  if (!arguments.run.trade) command += " --no-trade";
  if (arguments.run.ground) command += fmt::format(" --ground {}", *arguments.run.ground);
  return command;
}

std::string joined(int argc, char** argv) {
  std::string line = "signorini-validate";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

/// On a terminal one line that is written over: what runs, how far it is, the time left of this
/// engine's run. Everywhere one line a finished scene.
class Progress {
 public:
  explicit Progress(std::size_t count) : count_(count), terminal_(isatty(STDOUT_FILENO) != 0) {}

  void start(std::size_t index, const std::string& name) {
    scene_ = fmt::format("[{}/{}] {}", index + 1, count_, name);
    engine_.clear();
    show("");
  }
  void step(const std::string& engine, long step, long steps) {
    if (!terminal_) return;
    const Clock::time_point now = Clock::now();
    if (engine != engine_ || step <= 1) {
      engine_ = engine;
      engine_start_ = now;
      shown_ = now;
      return;
    }
    if (now - shown_ < std::chrono::milliseconds(200)) return;
    shown_ = now;
    const double spent = std::chrono::duration<double>(now - engine_start_).count();
    const double left = spent * static_cast<double>(steps - step) / static_cast<double>(step - 1);
    show(fmt::format(": {} {} of {} steps, {} left", engine, step, steps, duration_text(left)));
  }
  void finish(std::size_t index, const SceneReport& report) {
    int failed = 0;
    for (const Check& check : report.checks) failed += check.judged() == Verdict::kFail ? 1 : 0;
    fmt::print("{}[{}/{}] {:<28}{:<12}{} checks{}\n", terminal_ ? "\r\x1b[K" : "", index + 1,
               count_, report.name, to_string(report.verdict()), report.checks.size(),
               failed > 0 ? fmt::format(", {} failed", failed) : "");
    for (const Check& check : report.checks) {
      if (check.judged() != Verdict::kFail) continue;
      fmt::print("      failed: {} ({}): {:.9g} {}, expected {:.9g}, {} error {:.3g} > {:.3g}\n",
                 check.name, check.engine, check.value, check.unit, check.expected,
                 check.error_kind, check.error, check.tolerance);
    }
    std::fflush(stdout);
  }
  void interrupted() { fmt::print("{}stopped\n", terminal_ ? "\r\x1b[K" : ""); }

 private:
  using Clock = std::chrono::steady_clock;

  static std::string duration_text(double seconds) {
    if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400.0) return fmt::format("{:.0f} min", seconds / 60.0);
    return fmt::format("{:.1f} h", seconds / 3600.0);
  }
  void show(const std::string& what) const {
    if (!terminal_) return;
    fmt::print("\r\x1b[K{}{} ...", scene_, what);
    std::fflush(stdout);
  }

  std::size_t count_;
  bool terminal_;
  std::string scene_;
  std::string engine_;
  Clock::time_point engine_start_;
  Clock::time_point shown_;
};

Report empty_report(const Arguments& arguments) {
  Report report;
  report.version = SIGNORINI_VERSION;
  report.arguments = arguments.run;
  report.engines = fmt::format("Bullet {} (double precision), libsdformat {}", bullet_version(),
                               sdformat_version());
  return report;
}

Report run_jobs(std::vector<Job> jobs, const Arguments& arguments,
                signorini::lcp::SolveRecorder* recorder) {
  RunOptions options = run_options(arguments, recorder);
  Report report = empty_report(arguments);
  Progress progress(jobs.size());
  options.watch = [&progress](const std::string& engine, long step, long steps) {
    progress.step(engine, step, steps);
  };
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    Job& job = jobs[i];
    progress.start(i, job.name);
    try {
      SceneReport scene = validate(job, options);
      scene.command = command_for(arguments, job.name);
      progress.finish(i, scene);
      report.scenes.push_back(std::move(scene));
      if (stop_requested.load()) {
        report.partial = true;
        break;
      }
    } catch (const RunInterrupted&) {
      progress.interrupted();
      report.partial = true;
      break;
    }
  }
  return report;
}

/// A list of jobs or, with one process, scenes in this one.
bool is_job_list(const Arguments& arguments) {
  return arguments.processes > 1 || signorini::tools::is_under_mpi();
}

/// What of the command line, and of the scenes' files, decides the results.
std::string settings_text(const Arguments& arguments, const std::vector<Job>& jobs) {
  const RunArguments& run = arguments.run;
  std::string text = fmt::format(
      "validate {} {} {} {} {} {}", run.engine, run.duration.value_or(-1.0), run.bullet_profile,
      run.skip_unsupported, run.ground ? fmt::format("{}", *run.ground) : "none", run.trade);
  for (const Job& job : jobs) {
    text += "\n" + job.name + "\n" + job.scene.text;
    for (const std::string& file : job.scene.files) {
      text += "\n" + signorini::tools::file_state(file);
    }
  }
  return text;
}

/// The scenes as jobs, whoever runs them; the report of those that are done.
struct ListedRun {
  Report report;
  std::vector<signorini::tools::Job> list;
  std::filesystem::path folder;  ///< of the finished jobs
  bool is_leader = true;
};

ListedRun run_job_list(std::vector<Job> jobs, const Arguments& arguments) {
  ListedRun run;
  run.folder = std::filesystem::path(arguments.out) / "jobs";
  RunOptions options = run_options(arguments, nullptr);
  options.stop = nullptr;  // jobs are stopped from outside
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    run.list.push_back({fmt::format("{} {}", i + 1, jobs[i].name), [&jobs, &arguments, options, i] {
                          SceneReport scene = validate(jobs[i], options);
                          scene.command = command_for(arguments, jobs[i].name);
                          return scene_report_bytes(scene);
                        }});
  }
  const signorini::tools::JobListResult result = signorini::tools::run_job_list(
      run.list,
      {.processes = arguments.processes,
       .folder = run.folder,
       .settings = settings_text(arguments, jobs),
       .shows_progress = signorini::tools::is_first_rank() && isatty(STDERR_FILENO) != 0});
  run.is_leader = result.is_leader;
  if (!result.is_leader) return run;
  const std::string failure = result.first_failure(run.list);
  if (!failure.empty()) throw std::runtime_error(failure);
  run.report = empty_report(arguments);
  run.report.partial = result.is_interrupted;
  run.report.jobs = result.remark();
  Progress progress(jobs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (!result.jobs[i].is_done) continue;
    SceneReport scene = scene_report_from_bytes(result.jobs[i].bytes);
    progress.finish(i, scene);
    run.report.scenes.push_back(std::move(scene));
  }
  fmt::print("{}\n", run.report.jobs);
  return run;
}

/// Runs a report's scenes again from its folder and prints what differs.
int verify(const std::string& folder) {
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  RepeatedReport result;
  try {
    result = repeat_report(folder, &stop_requested,
                           [&](std::size_t index, std::size_t count, const std::string& name) {
                             if (terminal)
                               fmt::print("\r\x1b[K[{}/{}] {} ...", index + 1, count, name);
                             std::fflush(stdout);
                           });
  } catch (const RunInterrupted&) {
    fmt::print("{}stopped\n", terminal ? "\r\x1b[K" : "");
    return kStopped;
  }
  if (terminal) fmt::print("\r\x1b[K");
  constexpr std::size_t kMostShown = 20;
  for (std::size_t i = 0; i < std::min(kMostShown, result.differences.size()); ++i) {
    fmt::print("differs: {}\n", result.differences[i]);
  }
  fmt::print("{} scenes, {} numbers compared, {} differences\n", result.scenes, result.numbers,
             result.differences.size());
  return result.differences.empty() ? kGood : kCheckFailed;
}

/// Writes the report and says what it came to.
int finish(Report report, const Arguments& arguments, const std::string& command) {
  report.command = command;
  for (const std::string& file : write_report(report, arguments.out)) {
    if (std::filesystem::path(file).parent_path() != std::filesystem::path(arguments.out)) continue;
    fmt::print("wrote {}\n", file);
  }
  if (report.partial) return kStopped;
  for (const SceneReport& scene : report.scenes) {
    if (scene.verdict() == Verdict::kFail) return kCheckFailed;
  }
  return kGood;
}

int run_listed(std::vector<Job> jobs, const Arguments& arguments, const std::string& command) {
  ListedRun run = run_job_list(std::move(jobs), arguments);
  if (!run.is_leader) return kGood;
  const bool is_partial = run.report.partial;
  const int code = finish(std::move(run.report), arguments, command);
  if (!is_partial) signorini::tools::forget_finished_jobs(run.list, run.folder);
  return code;
}

int run(const Arguments& arguments, const std::string& command) {
  if (arguments.list) {
    list_builtin_scenes();
    return kGood;
  }
  std::vector<Job> jobs;
  if (arguments.verify.empty()) jobs = load_jobs(arguments);
  if (arguments.verify.empty() && is_job_list(arguments)) {
    if (std::getenv("SIGNORINI_DUMP") != nullptr) {
      throw std::invalid_argument(
          "SIGNORINI_DUMP: one process must write the problems; start without --jobs and mpirun");
    }
    return run_listed(std::move(jobs), arguments, command);
  }
  // From here a stop leaves a report; before, it just ends the program.
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  if (!arguments.verify.empty()) return verify(arguments.verify);
#ifdef SIGNORINI_HAS_IO
  const auto recorder = signorini::lcp::dump_recorder_from_environment();
  Report report = run_jobs(std::move(jobs), arguments, recorder.get());
  if (recorder != nullptr) fmt::print("{}\n", summary(*recorder));
#else
  Report report = run_jobs(std::move(jobs), arguments, nullptr);
#endif
  return finish(std::move(report), arguments, command);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Runs scenes in Signorini and in Bullet (double precision), compares both with closed forms, "
      "and writes report.html, report.md and report.json.\n"
      "Exit: 0 every check passed (--verify: every number is the same), 1 not, 64 bad usage, 65 "
      "bad or unsupported scene, "
      "130 "
      "stopped (the report written is partial).\n"
      "SIGNORINI_DUMP=DIR[:OPTION,...] in the environment writes the contact problems for a replay "
      "(signorini-solve --help)."};
  Arguments arguments;
  declare(app, arguments);
  app.set_version_flag("--version", SIGNORINI_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kGood : kUsage;
  }
  arguments.run.trade = !arguments.no_trade;
  try {
    return run(arguments, joined(argc, argv));
  } catch (const InputError& error) {
    fmt::print(stderr, "signorini-validate: {}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "signorini-validate: {}\n", error.what());
    return kInternal;
  }
}
