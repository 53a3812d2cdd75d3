#pragma once

#include "bench/peer.h"
#include "bench/peer_problems.h"
#include "bench/peer_runner.h"

#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace signorini::bench {

/// What takes part, and how.
struct PeersOptions {
  std::vector<std::string> solvers;  ///< names; empty: all
  bool regularised = true;           ///< also NAME+reg for every Dantzig, see kRegularisation
  PeerSettings settings;
  RunLimits limits;
  int most_dense = 2500;  ///< rows up to which solvers that take n^2 numbers are asked
};

/// One solver on one problem.
struct PeersRow {
  std::string problem;
  std::string form;
  std::string family;
  std::string column;
  int n = 0;
  double mass_ratio = 1.0;
  bool at_rest = false;
  std::string solver;
  std::string library;
  PeerRun run;
  /// Seconds of one sparse analyse, factor and solve of the problem's active set
  /// (factorization_floor.h); -1: not measured, because nobody solved the problem or it is not an
  /// LCP in factored form.
  double floor_seconds = -1.0;
};

struct PeersResult {
  std::vector<PeersRow> rows;  ///< problem by problem, all solvers of one together
  bool is_interrupted = false;
  /// Runs of our own solvers that ended in kWrong or kCrashed.
  [[nodiscard]] int wrong_of_ours() const;
};

/// A solver as it takes part: itself, or with A_ii (1 + 1e-10).
struct PeersContestant {
  PeerEntry entry;
  bool is_regularised = false;
  [[nodiscard]] std::string name() const { return entry.name + (is_regularised ? "+reg" : ""); }
};

/// Who takes part. @throws std::invalid_argument if options.solvers names an unknown one.
[[nodiscard]] std::vector<PeersContestant> peers_contestants(const std::vector<PeerEntry>& entries,
                                                             const PeersOptions& options);

/// One solver on the problems of one series, smaller ones first: once it is out of time it is not
/// asked for the larger ones, which count as timed out. Without floors.
[[nodiscard]] std::vector<PeersRow> run_peers_series(std::span<const PeerProblem> series,
                                                     const PeersContestant& contestant,
                                                     const PeersOptions& options);

/// Every solver on every problem, each in a child process (peer_runner.h). A solver that ran out of
/// time on a problem is not asked for the larger ones of its series, which count as timed out.
/// @param entries the solvers, all_peers() or others
/// @param progress one line a run, rewritten; null: none
/// @throws std::invalid_argument if options.solvers names an unknown one.
[[nodiscard]] PeersResult run_peers_study(const std::vector<PeerProblem>& problems,
                                          const std::vector<PeerEntry>& entries,
                                          const PeersOptions& options, std::ostream* progress);

}  // namespace signorini::bench
