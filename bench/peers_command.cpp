#include "bench/peers_command.h"

#include <signorini/lcp/io/whole_file.h>

#include "bench/contact_families.h"
#include "bench/peers_study.h"
#include "bench/peers_table.h"
#include "bench/write_csv.h"
#include "tools/child_process.h"

#ifdef SIGNORINI_PEER_BULLET
#include "bench/bullet_sets.h"
#endif

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iostream>
#include <string>
#include <unistd.h>

namespace signorini::bench {
namespace {

constexpr int kClaimsHold = 0;
constexpr int kWrongClaim = 1;
constexpr int kInterrupted = 130;

void on_interrupt(int /*signal*/) {
  tools::stop_children();
}

/// Interrupts end the running child and the study; what was measured is still written.
class StopOnInterrupt {
 public:
  StopOnInterrupt() {
    struct sigaction action = {};
    action.sa_handler = &on_interrupt;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      ::sigaction(signal, &action, nullptr);
    }
  }
};

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.rfind("model name", 0) == 0) {
      return line.substr(line.find(':') + 2);
    }
  }
  return "unknown processor";
}

}  // namespace

struct PeersCommand::Options {
  PeerProblemOptions problems;
  PeersOptions study;
  std::vector<std::string> folders;
  std::string out;
  double memory_gib = 4.0;
  bool list = false;
  bool without_regularised = false;
  bool without_moving = false;
};

PeersCommand::PeersCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  for (const std::string_view family : family_names()) {
    o.problems.families.emplace_back(family);
  }
  command_ = app.add_subcommand(
      "peers", "Our solvers and Bullet's, ODE's, DART's and Siconos's on the same problems");
  command_->add_option("FOLDER", o.folders,
                       "Problem folders, or folders of problem folders (lcp, mlcp, fc3d, fc2d)");
  command_
      ->add_option("--families", o.problems.families,
                   "Contact families, psd, psd-half (rank n/2), murty, fathi; none: folders "
                   "alone")
      ->delimiter(',')
      ->capture_default_str();
  command_
      ->add_option("--forms", o.problems.forms,
                   "Of the contacts: lcp (frictionless), pyramid (nonsymmetric LCP), box "
                   "(coupled limits), cone (Coulomb)")
      ->delimiter(',')
      ->capture_default_str();
  command_->add_option("--sizes", o.problems.sizes, "Rows without friction, about")
      ->delimiter(',')
      ->capture_default_str();
  command_->add_option("--ratios", o.problems.mass_ratios, "Mass ratios")
      ->delimiter(',')
      ->capture_default_str();
  command_->add_flag("--rest", o.problems.at_rest,
                     "Also at rest: free velocities of gravity alone");
  command_->add_flag("--only-rest", o.without_moving, "At rest only");
  command_->add_option("--friction", o.problems.friction, "mu")->capture_default_str();
  command_->add_option("--seed", o.problems.seed, "Of the families")->capture_default_str();
  command_->add_option("--solvers", o.study.solvers, "Names (default: all, see --list)")
      ->delimiter(',');
  command_->add_flag("--no-reg", o.without_regularised, "No Dantzigs with A_ii (1 + 1e-10)");
  command_->add_option("--tolerance", o.study.settings.tolerance, "Natural residual")
      ->check(CLI::Range(1e-15, 0.9))
      ->capture_default_str();
  o.study.limits.child.seconds = 20.0;
  command_
      ->add_option("--time-limit", o.study.limits.child.seconds,
                   "Seconds of CPU time a solver and problem")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_->add_option("--memory", o.memory_gib, "GiB a solver and problem")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_
      ->add_option("--most-dense", o.study.most_dense,
                   "Rows up to which solvers that take n^2 numbers are asked")
      ->capture_default_str();
  command_->add_option("--repeats", o.study.limits.repeats, "Of short solves, at least")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_->add_option("--out", o.out,
                       "Folder for peers.csv, peers.md and peers-profile.svg, made if absent "
                       "(default: print only)");
  command_->add_flag("--list", o.list,
                     "Print the solvers of this build and those it was made "
                     "without");
}

PeersCommand::~PeersCommand() = default;

bool PeersCommand::is_asked() const {
  return command_->parsed();
}

int PeersCommand::run() const {
  Options& o = *options_;
  const std::vector<PeerEntry> entries = all_peers();
  for (const AbsentPeer& absent : absent_peers()) {
    fmt::print("without {}: this build did not find {}\n", absent.library, absent.package);
  }
  if (o.list) {
    for (const PeerEntry& entry : entries) {
      fmt::print("{:<10} {}{}\n", entry.library, entry.name,
                 entry.may_be_regularised ? ", " + entry.name + "+reg" : "");
    }
    return kClaimsHold;
  }
  if (o.problems.families == std::vector<std::string>{"none"}) {
    o.problems.families.clear();
  }
  o.problems.folders.assign(o.folders.begin(), o.folders.end());
  if (o.without_moving) {
    o.problems.moving = false;
    o.problems.at_rest = true;
  }
  o.study.regularised = !o.without_regularised;
  o.study.settings.time_limit = tools::kWallTimes * o.study.limits.child.seconds;
  o.study.limits.child.loading_seconds = o.study.limits.child.seconds + 60.0;
  o.study.limits.child.bytes = static_cast<std::size_t>(o.memory_gib * 1024.0 * 1024.0 * 1024.0);
  const std::vector<PeerProblem> problems = peer_problems(o.problems);
  const std::filesystem::path folder = o.out;
  if (!o.out.empty()) {
    std::filesystem::create_directories(folder);
  }

  const StopOnInterrupt stop;
  const bool is_watched = ::isatty(STDERR_FILENO) != 0;
  const PeersResult result =
      run_peers_study(problems, entries, o.study, is_watched ? &std::cerr : nullptr);
  fmt::print("{}{}\n", peers_text(result),
             result.is_interrupted ? "\ninterrupted: what follows was not run\n" : "");
  for (const std::string& line : peers_legend()) {
    fmt::print("{}\n", line);
  }
  if (!o.out.empty()) {
    const std::vector<std::string> remarks = {
        processor() + ", one thread",
        fmt::format("tolerance {:g}, time limit {:g} s, memory limit {:g} GiB",
                    o.study.settings.tolerance, o.study.limits.child.seconds, o.memory_gib)};
    lcp::write_whole_file(folder / "peers.csv", peers_csv(result));
    lcp::write_whole_file(folder / "peers.md", peers_markdown(result, remarks));
    lcp::write_whole_file(
        folder / "peers-profile.svg",
        performance_profile_svg(peers_profiles(result), "Solvers compared: " + remarks[1]));
    fmt::print("written: peers.csv, peers.md and peers-profile.svg in {}\n", folder.string());
  }
  if (result.is_interrupted) {
    return kInterrupted;
  }
  return result.wrong_of_ours() == 0 ? kClaimsHold : kWrongClaim;
}

#ifdef SIGNORINI_PEER_BULLET
struct BulletSetsCommand::Options {
  BulletSetsOptions study;
  std::string out;
};
#else
struct BulletSetsCommand::Options {};
#endif

BulletSetsCommand::BulletSetsCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  command_ = app.add_subcommand(
      "bullet-sets", "Our solvers and Bullet's on contact sets captured from Bullet's own steps");
#ifdef SIGNORINI_PEER_BULLET
  Options& o = *options_;
  command_->add_option("--sets", o.study.sets, "Which")->delimiter(',')->capture_default_str();
  command_->add_option("--friction", o.study.friction, "mu of every pair; 0: normal rows alone")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command_->add_option("--repeats", o.study.repeats, "Of every solve; the fastest counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command_->add_option("--tolerance", o.study.tolerance, "Asked of our solvers")
      ->check(CLI::Range(1e-15, 0.9))
      ->capture_default_str();
  command_->add_option("--out", o.out,
                       "Folder for bullet-sets.csv, made if absent (default: print only)");
#endif
}

BulletSetsCommand::~BulletSetsCommand() = default;

bool BulletSetsCommand::is_asked() const {
  return command_->parsed();
}

int BulletSetsCommand::run() const {
#ifdef SIGNORINI_PEER_BULLET
  const Options& o = *options_;
  if (!o.out.empty()) {
    std::filesystem::create_directories(o.out);
  }
  const StopOnInterrupt stop;
  const bool is_watched = ::isatty(STDERR_FILENO) != 0;
  const auto runs = run_bullet_sets(o.study, is_watched ? &std::cerr : nullptr);
  fmt::print("{}", bullet_sets_text(runs));
  fmt::print(
      "max|min(f, d'+ + target)| in m/s (with friction |z - P_K(z - w~)|), in long double, of the "
      "impulses that were left / the fastest call in us.\nOurs includes reading Bullet's contacts, "
      "assembly, certificate and "
      "writing back; Bullet's its own setup and (idle) friction rows.\n");
  write_csv(o.out, "bullet-sets", bullet_sets_csv(runs));
  return tools::children_are_stopped() ? kInterrupted : kClaimsHold;
#else
  fmt::print(stderr, "signorini-bench bullet-sets: this build has no Bullet (libbullet-dev)\n");
  return 70;
#endif
}

}  // namespace signorini::bench
