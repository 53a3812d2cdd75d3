// Siconos numerics: its solvers of LCPs, on dense matrices.

#include "bench/peer.h"

#include <LCP_Solvers.h>
#include <LinearComplementarityProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <NumericsVerbose.h>
#include <SolverOptions.h>
#include <algorithm>
#include <lcp_cst.h>
#include <limits>

namespace signorini::bench {
namespace {

constexpr int kManyIterations = 1000000;  // the time limit ends it

struct DeleteOptions {
  void operator()(SolverOptions* options) const { solver_options_delete(options); }
};

/// Siconos measures |z - (z - w)+|_2 / |q|_2. This tolerance on it implies the given one on
/// |.|_inf / (1 + |q|_inf): it is asked for neither more nor less than the others are judged by.
double siconos_tolerance(const lcp::Vector& q, double tolerance) {
  const double norm = q.norm();
  return norm > 0.0 ? tolerance * (1.0 + q.lpNorm<Eigen::Infinity>()) / norm : tolerance;
}

class SiconosLcpPeer : public Peer {
 public:
  SiconosLcpPeer(int solver, const PeerSettings& settings)
      : solver_(solver), tolerance_(settings.tolerance) {
    numerics_set_verbose(0);
  }
  ~SiconosLcpPeer() override {
    if (M_ != nullptr) {
      M_->matrix0 = nullptr;  // ours
      NM_free(M_);
    }
  }

  void load(const lcp::Problem& problem) override {
    dense_ = lcp::to_dense(problem.M);  // column-major, as Siconos wants it
    q_ = problem.q;
    const int n = static_cast<int>(problem.size());
    M_ = NM_create_from_data(NM_DENSE, n, n, dense_.data());
    lcp_ = {.size = n, .M = M_, .q = q_.data()};
    w_.resize(n);
    z_.resize(n);
  }

  void rewind() override {
    options_.reset(solver_options_create(solver_));
    options_->dparam[SICONOS_DPARAM_TOL] = siconos_tolerance(q_, tolerance_);
    options_->iparam[SICONOS_IPARAM_MAX_ITER] = kManyIterations;
    z_.setZero();
    w_.setZero();
  }

  void solve(PeerAnswer& answer) override {
    const int code = linearComplementarity_driver(&lcp_, z_.data(), w_.data(), options_.get());
    answer.claim = code == 0 ? Claim::kSolved : Claim::kFailed;
    answer.said = "info " + std::to_string(code);
    answer.z = z_;
    answer.iterations = options_->iparam[SICONOS_IPARAM_ITER_DONE];
  }

 private:
  int solver_;
  double tolerance_;
  lcp::Matrix dense_;
  lcp::Vector q_, z_, w_;
  NumericsMatrix* M_ = nullptr;
  LinearComplementarityProblem lcp_{};
  std::unique_ptr<SolverOptions, DeleteOptions> options_;
};

}  // namespace

void add_siconos_peers(std::vector<PeerEntry>& entries) {
  struct Named {
    const char* name;
    int solver;
  };
  for (const Named& named :
       {Named{"siconos-lemke", SICONOS_LCP_LEMKE}, Named{"siconos-pivot", SICONOS_LCP_PIVOT},
        Named{"siconos-avi", SICONOS_LCP_AVI_CAOFERRIS},
        Named{"siconos-newton-fb", SICONOS_LCP_NEWTON_FB_FBLSA},
        Named{"siconos-pgs", SICONOS_LCP_PGS}, Named{"siconos-psor", SICONOS_LCP_PSOR}}) {
    PeerEntry entry;
    entry.name = named.name;
    entry.library = "Siconos";
    entry.refuses = &refuses_all_but_lcp;
    entry.make = [solver = named.solver](const PeerSettings& settings) {
      return std::make_unique<SiconosLcpPeer>(solver, settings);
    };
    entries.push_back(entry);
  }
}

}  // namespace signorini::bench
