// DART's solvers of boxed LCPs (a branch of ODE's Dantzig, projected Gauss-Seidel) and its Lemke.

#include "bench/peer.h"

#include <cmath>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/lcpsolver/Lemke.hpp>
#include <limits>

namespace signorini::bench {
namespace {

template <typename Solver>
class DartBoxedPeer : public Peer {
 public:
  /// @param gives_up what DART calls early termination: its own constraint solver asks for it; else
  /// the method goes on where a step has failed
  DartBoxedPeer(bool gives_up, bool claims) : gives_up_(gives_up), claims_(claims) {}

  Solver& solver() { return solver_; }

  void load(const lcp::Problem& problem) override {
    n_ = static_cast<int>(problem.size());
    const int stride = n_ > 1 ? (n_ + 3) & ~3 : n_;
    const lcp::Matrix M = lcp::to_dense(problem.M);
    matrix_.assign(static_cast<std::size_t>(n_) * stride, 0.0);
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) {
        matrix_[static_cast<std::size_t>(i) * stride + j] = M(i, j);
      }
    }
    bounds_ = row_bounds(problem);
    b_ = -problem.q;
  }

  void rewind() override {
    work_matrix_ = matrix_;
    work_bounds_ = bounds_;
    work_b_ = b_;
    x_.setZero(n_);
  }

  void solve(PeerAnswer& answer) override {
    const bool ok = solver_.solve(n_, work_matrix_.data(), x_.data(), work_b_.data(), 0,
                                  work_bounds_.lower.data(), work_bounds_.upper.data(),
                                  work_bounds_.normal_row.data(), gives_up_);
    answer.claim = !claims_ ? Claim::kNothing : ok ? Claim::kSolved : Claim::kFailed;
    answer.said = ok ? "true" : "false";
    answer.z = x_;
  }

 private:
  Solver solver_;
  bool gives_up_;
  bool claims_;
  int n_ = 0;
  std::vector<double> matrix_, work_matrix_;
  RowBounds bounds_, work_bounds_;
  lcp::Vector b_, work_b_, x_;
};

#ifndef __SANITIZE_ADDRESS__  // see add_dart_peers()
class DartPgsPeer : public DartBoxedPeer<dart::constraint::PgsBoxedLcpSolver> {
 public:
  DartPgsPeer() : DartBoxedPeer(false, false) {}
  void set_sweeps(int sweeps) override {
    // No thresholds: it sweeps as often as it is told.
    solver().setOption({sweeps, 0.0, 0.0, 1e-300, false});
    sweeps_ = sweeps;
  }
  void solve(PeerAnswer& answer) override {
    DartBoxedPeer::solve(answer);
    answer.iterations = sweeps_;
  }

 private:
  int sweeps_ = 0;
};

class DartLemkePeer : public Peer {
 public:
  void load(const lcp::Problem& problem) override {
    M_ = lcp::to_dense(problem.M);
    q_ = problem.q;
  }
  void solve(PeerAnswer& answer) override {
    const int code = dart::lcpsolver::Lemke(M_, q_, &answer.z);
    answer.claim = code == 0 ? Claim::kSolved : Claim::kFailed;
    answer.said = "code " + std::to_string(code);
  }

 private:
  lcp::Matrix M_;
  lcp::Vector q_;
};

#endif

}  // namespace

void add_dart_peers(std::vector<PeerEntry>& entries) {
  using Dantzig = DartBoxedPeer<dart::constraint::DantzigBoxedLcpSolver>;
  PeerEntry entry;
  entry.library = "DART";

  entry.name = "dart-dantzig";
  entry.may_be_regularised = true;
  entry.refuses = &refuses_all_but_symmetric_boxes;
  entry.make = [](const PeerSettings&) { return std::make_unique<Dantzig>(true, true); };
  entries.push_back(entry);

  entry.name = "dart-dantzig-late";  // the default of its interface: no early termination
  entry.may_be_regularised = false;
  entry.make = [](const PeerSettings&) { return std::make_unique<Dantzig>(false, true); };
  entries.push_back(entry);

  // Eigen allocates in another way under the address sanitizer, and these two let DART's library,
  // which was built without it, allocate what is freed here.
#ifndef __SANITIZE_ADDRESS__
  entry.name = "dart-lemke";
  entry.refuses = &refuses_all_but_lcp;
  entry.make = [](const PeerSettings&) { return std::make_unique<DartLemkePeer>(); };
  entries.push_back(entry);

  entry.name = "dart-pgs";
  entry.counts_sweeps = true;
  entry.refuses = &refuses_all_but_boxes;
  entry.make = [](const PeerSettings&) { return std::make_unique<DartPgsPeer>(); };
  entries.push_back(entry);
#endif
}

}  // namespace signorini::bench
