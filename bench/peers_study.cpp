#include "bench/peers_study.h"

#include "bench/factorization_floor.h"

#include <algorithm>
#include <fmt/format.h>
#include <ostream>
#include <set>
#include <span>
#include <stdexcept>

namespace signorini::bench {
namespace {

/// A solver as it takes part: itself, or with A_ii (1 + 1e-10).
struct Contestant {
  PeerEntry entry;
  bool is_regularised = false;
  [[nodiscard]] std::string name() const { return entry.name + (is_regularised ? "+reg" : ""); }
};

std::vector<Contestant> contestants(const std::vector<PeerEntry>& entries,
                                    const PeersOptions& options) {
  std::vector<Contestant> all;
  for (const PeerEntry& entry : entries) {
    all.push_back({entry, false});
    if (options.regularised && entry.may_be_regularised) {
      all.push_back({entry, true});
    }
  }
  if (options.solvers.empty()) {
    return all;
  }
  std::vector<Contestant> chosen;
  for (const std::string& name : options.solvers) {
    const auto is_it = [&](const Contestant& one) { return one.name() == name; };
    const auto found = std::find_if(all.begin(), all.end(), is_it);
    if (found == all.end()) {
      std::string known;
      for (const Contestant& one : all) {
        known.append(" ").append(one.name());
      }
      throw std::invalid_argument(
          std::string("solver: none is called ").append(name).append("; known:").append(known));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

/// The problem in the forms that the solvers are given.
struct GivenProblem {
  lcp::Problem judged;
  lcp::Problem regularised;  // made when first asked for
  bool has_regularised = false;

  const lcp::Problem& to(const Contestant& contestant) {
    if (!contestant.is_regularised) {
      return judged;
    }
    if (!has_regularised) {
      regularised = bench::regularised(judged);
      has_regularised = true;
    }
    return regularised;
  }
};

PeerRun not_asked(Verdict verdict, std::string why) {
  PeerRun run;
  run.verdict = verdict;
  run.said = std::move(why);
  return run;
}

/// Measures the floor with the most accurate of the solutions, and forgets all of them.
void set_floor(const lcp::Problem& problem, std::span<PeersRow> rows) {
  const PeersRow* best = nullptr;
  for (const PeersRow& row : rows) {
    if (row.run.verdict == Verdict::kSolved &&
        (best == nullptr ||
         row.run.certificate.natural_residual < best->run.certificate.natural_residual)) {
      best = &row;
    }
  }
  const auto* A = std::get_if<lcp::FactoredMatrix>(&problem.M);
  double seconds = -1.0;
  if (best != nullptr && A != nullptr && problem.is_lcp() && (best->run.z.array() > 0.0).any()) {
    seconds = measure_factorization_floor(*A, best->run.z, reference_back_end()).seconds;
  }
  for (PeersRow& row : rows) {
    row.floor_seconds = seconds;
    row.run.z.resize(0);
  }
}

class Study {
 public:
  Study(const PeersOptions& options, std::size_t problem_count, std::ostream* progress)
      : options_(options), problem_count_(problem_count), progress_(progress) {}

  void run(const PeerProblem& problem, const std::vector<Contestant>& all, PeersResult& result) {
    ++problem_number_;
    GivenProblem given{.judged = problem.make(), .regularised = {}};
    for (const Contestant& contestant : all) {
      PeersRow row;
      row.problem = problem.name;
      row.form = problem.form;
      row.family = problem.family;
      row.column = problem.column;
      row.n = static_cast<int>(given.judged.size());
      row.mass_ratio = problem.mass_ratio;
      row.at_rest = problem.at_rest;
      row.solver = contestant.name();
      row.library = contestant.entry.library;
      show(fmt::format("{} of {}: {} ({} rows): {}", problem_number_, problem_count_, problem.name,
                       row.n, row.solver));
      row.run = run_one(problem, contestant, given);
      if (row.run.verdict == Verdict::kInterrupted) {
        result.is_interrupted = true;
        return;
      }
      result.rows.push_back(std::move(row));
    }
    show(fmt::format("{}: the floor", problem.name));
    const auto first = result.rows.end() - static_cast<std::ptrdiff_t>(all.size());
    set_floor(given.judged, {first, result.rows.end()});
  }

  void show(const std::string& line) {
    if (progress_ != nullptr) {
      *progress_ << "\r\033[K" << line << std::flush;
    }
  }

 private:
  PeerRun run_one(const PeerProblem& problem, const Contestant& contestant, GivenProblem& given) {
    const auto key = std::pair(problem.series, contestant.name());
    if (too_slow_.count(key) != 0) {
      return not_asked(Verdict::kTimedOut, "not asked: out of time on a smaller one");
    }
    if (contestant.entry.needs_dense && given.judged.size() > options_.most_dense) {
      return not_asked(Verdict::kRefused,
                       fmt::format("not asked: more than {} rows", options_.most_dense));
    }
    PeerRun run = run_peer(contestant.entry, given.to(contestant), given.judged, options_.settings,
                           options_.limits);
    if (run.verdict == Verdict::kTimedOut) {
      too_slow_.insert(key);
    }
    return run;
  }

  const PeersOptions& options_;
  std::size_t problem_count_;
  std::size_t problem_number_ = 0;
  std::ostream* progress_;
  std::set<std::pair<std::string, std::string>> too_slow_;  // series and solver
};

}  // namespace

int PeersResult::wrong_of_ours() const {
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const PeersRow& row) {
    return row.library == "Signorini" &&
           (row.run.verdict == Verdict::kWrong || row.run.verdict == Verdict::kCrashed);
  }));
}

PeersResult run_peers_study(const std::vector<PeerProblem>& problems,
                            const std::vector<PeerEntry>& entries, const PeersOptions& options,
                            std::ostream* progress) {
  const std::vector<Contestant> all = contestants(entries, options);
  PeersResult result;
  Study study(options, problems.size(), progress);
  for (const PeerProblem& problem : problems) {
    study.run(problem, all, result);
    if (result.is_interrupted) {
      break;
    }
  }
  study.show("");
  return result;
}

}  // namespace signorini::bench
