#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include "bench/peer.h"

namespace signorini::bench {
namespace {

/// One of our solvers. Its time includes the certificate.
class SignoriniPeer : public Peer {
 public:
  SignoriniPeer(std::string_view name, const PeerSettings& settings)
      : solver_(lcp::make_solver(name, {.tolerance = settings.tolerance,
                                        .max_iterations = -1,
                                        .time_limit = settings.time_limit})) {}

  void load(const lcp::Problem& problem) override { problem_ = problem; }

  void solve(PeerAnswer& answer) override {
    solver_->solve(problem_, result_);
    answer.claim = lcp::is_solved(result_.status) ? Claim::kSolved : Claim::kFailed;
    answer.said = lcp::to_string(result_.status);
    answer.z = result_.z;
    answer.iterations = result_.statistics.iterations;
    answer.pivots = result_.statistics.pivots;
    answer.factorizations = result_.statistics.factorizations;
  }

 private:
  std::unique_ptr<lcp::Solver> solver_;
  lcp::Problem problem_;
  lcp::Result result_;
};

}  // namespace

void add_signorini_peers(std::vector<PeerEntry>& entries) {
  for (const std::string_view name : lcp::solver_names()) {
    PeerEntry entry;
    entry.name = name;
    entry.library = "Signorini";
    entry.needs_dense = false;
    entry.refuses = [name](const lcp::Problem& problem) {
      return lcp::make_solver(name)->refuses(problem);
    };
    entry.make = [name](const PeerSettings& settings) {
      return std::make_unique<SignoriniPeer>(name, settings);
    };
    entries.push_back(std::move(entry));
  }
}

}  // namespace signorini::bench
