#include "bench/peers_study.h"

#include "bench/factorization_floor.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <ostream>
#include <span>
#include <stdexcept>

namespace signorini::bench {
namespace {

/// The problem in the forms that the solvers are given.
struct GivenProblem {
  lcp::Problem judged;
  lcp::Problem regularised;  // made when first asked for
  bool has_regularised = false;

  const lcp::Problem& to(const PeersContestant& contestant) {
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

PeersRow row_of(const PeerProblem& problem, const PeersContestant& contestant,
                const lcp::Problem& judged) {
  PeersRow row;
  row.problem = problem.name;
  row.form = problem.form;
  row.family = problem.family;
  row.column = problem.column;
  row.n = static_cast<int>(judged.size());
  row.mass_ratio = problem.mass_ratio;
  row.at_rest = problem.at_rest;
  row.solver = contestant.name();
  row.library = contestant.entry.library;
  return row;
}

/// @param is_too_slow the solver has run out of time on a problem of this series
PeerRun run_one(const PeersContestant& contestant, GivenProblem& given, const PeersOptions& options,
                bool& is_too_slow) {
  if (is_too_slow) {
    return not_asked(Verdict::kTimedOut, "not asked: out of time on a smaller one");
  }
  if (contestant.entry.needs_dense && given.judged.size() > options.most_dense) {
    return not_asked(Verdict::kRefused,
                     fmt::format("not asked: more than {} rows", options.most_dense));
  }
  PeerRun run = run_peer(contestant.entry, given.to(contestant), given.judged, options.settings,
                         options.limits);
  is_too_slow = run.verdict == Verdict::kTimedOut;
  return run;
}

class Study {
 public:
  Study(const PeersOptions& options, std::size_t problem_count, std::ostream* progress)
      : options_(options), problem_count_(problem_count), progress_(progress) {}

  void run(const PeerProblem& problem, const std::vector<PeersContestant>& all,
           PeersResult& result) {
    ++problem_number_;
    GivenProblem given{.judged = problem.make(), .regularised = {}};
    for (const PeersContestant& contestant : all) {
      PeersRow row = row_of(problem, contestant, given.judged);
      show(fmt::format("{} of {}: {} ({} rows): {}", problem_number_, problem_count_, problem.name,
                       row.n, row.solver));
      row.run = run_one(contestant, given, options_, too_slow_[{problem.series, row.solver}]);
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
  const PeersOptions& options_;
  std::size_t problem_count_;
  std::size_t problem_number_ = 0;
  std::ostream* progress_;
  std::map<std::pair<std::string, std::string>, bool> too_slow_;  // series and solver
};

}  // namespace

int PeersResult::wrong_of_ours() const {
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const PeersRow& row) {
    return row.library == "Signorini" &&
           (row.run.verdict == Verdict::kWrong || row.run.verdict == Verdict::kCrashed);
  }));
}

std::vector<PeersContestant> peers_contestants(const std::vector<PeerEntry>& entries,
                                               const PeersOptions& options) {
  std::vector<PeersContestant> all;
  for (const PeerEntry& entry : entries) {
    all.push_back({entry, false});
    if (options.regularised && entry.may_be_regularised) {
      all.push_back({entry, true});
    }
  }
  if (options.solvers.empty()) {
    return all;
  }
  std::vector<PeersContestant> chosen;
  for (const std::string& name : options.solvers) {
    const auto is_it = [&](const PeersContestant& one) { return one.name() == name; };
    const auto found = std::find_if(all.begin(), all.end(), is_it);
    if (found == all.end()) {
      std::string known;
      for (const PeersContestant& one : all) {
        known.append(" ").append(one.name());
      }
      throw std::invalid_argument(
          std::string("solver: none is called ").append(name).append("; known:").append(known));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

std::vector<PeersRow> run_peers_series(std::span<const PeerProblem> series,
                                       const PeersContestant& contestant,
                                       const PeersOptions& options) {
  std::vector<PeersRow> rows;
  bool is_too_slow = false;
  for (const PeerProblem& problem : series) {
    GivenProblem given{.judged = problem.make(), .regularised = {}};
    rows.push_back(row_of(problem, contestant, given.judged));
    rows.back().run = run_one(contestant, given, options, is_too_slow);
    rows.back().run.z.resize(0);
  }
  return rows;
}

PeersResult run_peers_study(const std::vector<PeerProblem>& problems,
                            const std::vector<PeerEntry>& entries, const PeersOptions& options,
                            std::ostream* progress) {
  const std::vector<PeersContestant> all = peers_contestants(entries, options);
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
