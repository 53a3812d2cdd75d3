#include <signorini/lcp/io/dump_recorder.h>
#include <signorini/lcp/io/input_error.h>

#include "bench/fuzz_command.h"
#include "bench/impact_study.h"
#include "bench/laws_study.h"
#include "bench/one_thread.h"
#include "bench/peers_command.h"
#include "bench/row_scaling_study.h"
#include "bench/sequence_command.h"
#include "bench/tradeoff_command.h"
#include "bench/write_csv.h"

#ifdef SIGNORINI_HAS_COLLISION
#include "bench/collision_command.h"
#include "bench/scaling_command.h"
#include "bench/stepping_command.h"
#endif

#ifdef SIGNORINI_HAS_CLP
#include "bench/limit_command.h"
#endif

#ifdef SIGNORINI_HAS_BULLET
#include "bench/bullet_laws.h"
#endif

#ifdef SIGNORINI_HAS_BULLET_DROP_IN
#include "bench/drop_in_command.h"
#endif

#ifdef SIGNORINI_HAS_GMP
#include "bench/exactness_study.h"
#endif

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini::bench {
namespace {

constexpr int kClaimsHold = 0;
constexpr int kWrongClaim = 1;
constexpr int kBadUsage = 64;
constexpr int kBadInput = 65;
constexpr int kFailed = 70;

/// What the command line asks of a study.
struct StudyOptions {
  int count;
  std::uint64_t seed = 1;
  std::string out = {};  // a folder, or empty: print only
};

CLI::App* add_study(CLI::App& app, const std::string& name, const std::string& what,
                    const std::string& counted, StudyOptions& options) {
  CLI::App* study = app.add_subcommand(name, what);
  study->add_option("--" + counted, options.count, "How many " + counted)
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  study->add_option("--seed", options.seed, "Of the random numbers")->capture_default_str();
  study->add_option("--out", options.out,
                    "Folder for " + name + ".csv, made if absent (default: print only)");
  return study;
}

/// The folder is made before the study runs, so that a wrong name does not cost the run.
void make_folder(const StudyOptions& options) {
  if (!options.out.empty()) {
    std::filesystem::create_directories(options.out);
  }
}

/// Dumps a study's solves where SIGNORINI_DUMP asks for it, and says so at the end.
class Dump {
 public:
  Dump() : recorder_(lcp::dump_recorder_from_environment()) {}
  ~Dump() {
    if (recorder_ != nullptr) {
      fmt::print(stderr, "{}\n", summary(*recorder_));
    }
  }
  Dump(const Dump&) = delete;
  Dump& operator=(const Dump&) = delete;
  [[nodiscard]] lcp::SolveRecorder* recorder() const { return recorder_.get(); }

 private:
  std::unique_ptr<lcp::DumpRecorder> recorder_;
};

int run_exactness([[maybe_unused]] const StudyOptions& options) {
#ifdef SIGNORINI_HAS_GMP
  make_folder(options);
  const Dump dump;
  const ExactnessCounts counts = run_exactness_study(
      {.problems = options.count, .seed = options.seed, .recorder = dump.recorder()}, std::cout);
  write_csv(options.out, "exactness", counts.to_csv());
  return counts.wrong() == 0 ? kClaimsHold : kWrongClaim;
#else
  fmt::print(stderr, "signorini-bench exactness: this build has no GMP (SIGNORINI_WITH_GMP=OFF)\n");
  return kFailed;
#endif
}

/// What `impacts` is asked beside StudyOptions.
struct ImpactSetOptions {
  int first = 0;
  RandomImpactOptions impact = {};
  std::vector<std::string> laws = {};  // empty: all
  bool energy_safe_only = false;
};

ImpactLaw simultaneous_law(const std::string& name) {
  for (const ImpactLaw law : ImpactOptions{}.laws) {
    if (name == to_string(law)) {
      return law;
    }
  }
  throw std::invalid_argument("--laws: must be of Newton, notes, Poisson, reflections, got " +
                              name);
}

int run_impacts(const StudyOptions& options, const ImpactSetOptions& set) {
  make_folder(options);
  const Dump dump;
  ImpactOptions study;
  study.impacts = options.count;
  study.seed = options.seed;
  study.recorder = dump.recorder();
  study.first = set.first;
  study.impact = set.impact;
  study.plain_forms = !set.energy_safe_only;
  if (!set.laws.empty()) {
    study.laws.clear();
    for (const std::string& name : set.laws) {
      study.laws.push_back(simultaneous_law(name));
    }
  }
  const ImpactCounts counts = run_impact_study(study, std::cout);
  write_csv(options.out, "impacts", counts.to_csv());
  return counts.passed() ? kClaimsHold : kWrongClaim;
}

int run_laws(const StudyOptions& options) {
  make_folder(options);
  std::vector<LawContestant> laws = our_laws();
#ifdef SIGNORINI_HAS_BULLET
  laws.push_back(bullet_law(10));
  laws.push_back(bullet_law(1000));
#endif
  const std::vector<LawRow> rows =
      run_laws_study({.impacts = options.count, .seed = options.seed}, laws, std::cout);
  write_csv(options.out, "laws", laws_csv(rows));
  return kClaimsHold;
}

int run_row_scaling(const StudyOptions& options) {
  make_folder(options);
  const RowScalingReport report = run_row_scaling_study({.max_rows = options.count}, std::cout);
  write_csv(options.out, "row-scaling", report.to_csv());
  return report.passed() ? kClaimsHold : kWrongClaim;
}

int run(int argc, char** argv) {
  CLI::App app{
      "Long studies of Signorini. Each prints a table and judges every answer it counts.\n"
      "Exit: 0 every claim holds, 1 one was wrong, 2 a problem of a sequence was not solved, 64 "
      "bad\n"
      "usage, 65 bad input, 70 the study could not run, 130 interrupted (what was measured is "
      "written)."};
  app.set_version_flag("--version", SIGNORINI_VERSION);
  app.require_subcommand(1);
  StudyOptions exactness{.count = 100000};
  StudyOptions impacts{.count = 10000};
  const CLI::App* exactness_command =
      add_study(app, "exactness", "Small LCPs with exact data, every claim judged in rationals",
                "problems", exactness);
  ImpactSetOptions impact_set;
  CLI::App* impacts_command =
      add_study(app, "impacts", "Random multi-contact impacts: the kinetic energy each law gains",
                "impacts", impacts);
  impacts_command->add_option("--first", impact_set.first, "Number of the first impact")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  impacts_command
      ->add_option("--mass-ratio", impact_set.impact.mass_ratio, "Heaviest over lightest body")
      ->check(CLI::Range(1.0, 1e12))
      ->capture_default_str();
  impacts_command
      ->add_option("--friction", impact_set.impact.most_friction,
                   "Coulomb's friction, mu up to this (laws Newton and reflections)")
      ->check(CLI::Range(0.0, 1e3))
      ->capture_default_str();
  impacts_command
      ->add_option("--laws", impact_set.laws,
                   "Of Newton, notes, Poisson, reflections (default: all)")
      ->delimiter(',');
  impacts_command->add_flag("--energy-safe", impact_set.energy_safe_only,
                            "The energy-safe forms alone, which take half the time");
  StudyOptions laws{.count = 1000};
  const CLI::App* laws_command =
      add_study(app, "laws", "The five desiderata of an impact law, for each law and for Bullet",
                "impacts", laws);
  StudyOptions row_scaling{.count = 10000};
  CLI::App* row_scaling_command = app.add_subcommand(
      "row-scaling", "The interior point from 1000 rows up, beside the factorisation floor");
  row_scaling_command->add_option("--rows", row_scaling.count, "Rows of the largest problems")
      ->check(CLI::Range(1000, 1000000))
      ->capture_default_str();
  row_scaling_command->add_option("--out", row_scaling.out,
                                  "Folder for row-scaling.csv, made if absent (default: print "
                                  "only)");
  const PeersCommand peers(app);
  const BulletSetsCommand bullet_sets(app);
  const SequenceCommand sequence(app);
  const TradeoffCommand tradeoff(app);
  const FuzzCommand fuzz(app);
#ifdef SIGNORINI_HAS_BULLET_DROP_IN
  const DropInCommand drop_in(app);
#endif
#ifdef SIGNORINI_HAS_COLLISION
  const CollisionCommand collision(app);
  const SteppingCommand stepping(app);
  const ScalingCommand scaling(app);
#endif
#ifdef SIGNORINI_HAS_CLP
  const LimitCommand limit(app);
#endif
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadUsage;
  }
  if (peers.is_asked() || bullet_sets.is_asked()) {
    pin_libraries_to_one_thread(argv);
    return peers.is_asked() ? peers.run() : bullet_sets.run();
  }
  if (tradeoff.is_asked()) {
    pin_libraries_to_one_thread(argv);
    return tradeoff.run();
  }
  if (row_scaling_command->parsed()) {
    pin_libraries_to_one_thread(argv);
    return run_row_scaling(row_scaling);
  }
#ifdef SIGNORINI_HAS_BULLET_DROP_IN
  if (drop_in.is_asked()) {
    return drop_in.run();
  }
#endif
#ifdef SIGNORINI_HAS_COLLISION
  if (scaling.is_asked()) {
    pin_libraries_to_one_thread(argv);
    return scaling.run();
  }
  if (collision.is_asked()) {
    return collision.run();
  }
  if (stepping.is_asked()) {
    return stepping.run();
  }
#endif
#ifdef SIGNORINI_HAS_CLP
  if (limit.is_asked()) {
    return limit.run();
  }
#endif
  if (sequence.is_asked()) {
    return sequence.run();
  }
  if (fuzz.is_asked()) {
    return fuzz.run();
  }
  if (laws_command->parsed()) {
    return run_laws(laws);
  }
  return exactness_command->parsed() ? run_exactness(exactness) : run_impacts(impacts, impact_set);
}

}  // namespace
}  // namespace signorini::bench

int main(int argc, char** argv) {
  try {
    return signorini::bench::run(argc, argv);
  } catch (const signorini::lcp::InputError& error) {
    fmt::print(stderr, "signorini-bench: {}\n", error.what());
    return signorini::bench::kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "signorini-bench: {}\n", error.what());
    return signorini::bench::kFailed;
  }
}
