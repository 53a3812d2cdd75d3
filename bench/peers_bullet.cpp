// Bullet's MLCP solvers, called as btMLCPSolver calls them: A x = b + w with b = -q. Their own
// copies of A are part of their solve. In double precision here, in single in
// bullet_float_peer_main.cpp.

#include "bench/peer.h"

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>
#include <algorithm>
#include <cmath>

namespace signorini::bench {
namespace {

/// Bullet's own upper limit of a contact impulse: its Lemke adds the bounds to q and cannot take
/// infinity.
constexpr double kContactLimit = 1e10;

template <typename Solver>
class BulletPeer : public Peer {
 public:
  explicit BulletPeer(double infinity, Claim claim_of_true = Claim::kSolved)
      : infinity_(infinity), claim_of_true_(claim_of_true) {}

  Solver& solver() { return solver_; }
  void set_sweeps(int sweeps) override { sweeps_ = sweeps; }

  void load(const lcp::Problem& problem) override {
    const lcp::Matrix M = lcp::to_dense(problem.M);
    const int n = static_cast<int>(problem.size());
    A_.resize(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        A_.setElem(i, j, static_cast<btScalar>(M(i, j)));
      }
    }
    const RowBounds bounds = row_bounds(problem);
    for (btVectorXu* vector : {&b_, &x_, &lower_, &upper_}) {
      vector->resize(n);
    }
    normal_rows_.resize(n);
    for (int i = 0; i < n; ++i) {
      b_[i] = static_cast<btScalar>(-problem.q[i]);
      lower_[i] = static_cast<btScalar>(std::max(bounds.lower[i], -infinity_));
      upper_[i] = static_cast<btScalar>(std::min(bounds.upper[i], infinity_));
      normal_rows_[i] = bounds.normal_row[i];
    }
  }

  void rewind() override { x_.setZero(); }

  void solve(PeerAnswer& answer) override {
    const bool ok = solver_.solveMLCP(A_, b_, x_, lower_, upper_, normal_rows_, sweeps_);
    answer.claim = ok ? claim_of_true_ : Claim::kFailed;
    answer.said = ok ? "true" : "false";
    answer.z.resize(x_.rows());
    for (int i = 0; i < x_.rows(); ++i) {
      answer.z[i] = double{x_[i]};
    }
    answer.iterations = claim_of_true_ == Claim::kNothing ? sweeps_ : -1;
  }

 private:
  Solver solver_;
  double infinity_;
  Claim claim_of_true_;
  int sweeps_ = 1;
  btMatrixXu A_;
  btVectorXu b_, x_, lower_, upper_;
  btAlignedObjectArray<int> normal_rows_;
};

constexpr int kPivotsARow = 10;  // Bullet's default of 1000 pivots would end large problems early

/// @param as_lcp Lemke's method on the LCP itself; else, as Bullet calls it, on 2 n rows with the
/// bounds, which inverts A
std::unique_ptr<Peer> make_lemke(bool as_lcp) {
  class LemkePeer : public BulletPeer<btLemkeSolver> {
   public:
    using BulletPeer::BulletPeer;
    void load(const lcp::Problem& problem) override {
      BulletPeer::load(problem);
      solver().m_maxLoops = std::max(1000, kPivotsARow * static_cast<int>(problem.size()));
    }
  };
  auto peer = std::make_unique<LemkePeer>(kContactLimit);
  peer->solver().m_useLoHighBounds = !as_lcp;
  return peer;
}

std::string refuses_for_bounded_lemke(const lcp::Problem& problem) {
  return problem.limits.empty() ? refuses_all_but_boxes(problem)
                                : "ignores the coupling of friction limits";
}

}  // namespace

void add_bullet_peers(std::vector<PeerEntry>& entries) {
  PeerEntry entry;
  entry.library = "Bullet";

  entry.name = "bullet-dantzig";
  entry.may_be_regularised = true;
  entry.refuses = &refuses_all_but_symmetric_boxes;
  entry.make = [](const PeerSettings&) {
    return std::make_unique<BulletPeer<btDantzigSolver>>(double{BT_INFINITY});
  };
  entries.push_back(entry);

  entry.may_be_regularised = false;
  entry.name = "bullet-lemke";
  entry.refuses = &refuses_for_bounded_lemke;
  entry.make = [](const PeerSettings&) { return make_lemke(false); };
  entries.push_back(entry);

  entry.name = "bullet-lemke-lcp";
  entry.refuses = &refuses_all_but_lcp;
  entry.make = [](const PeerSettings&) { return make_lemke(true); };
  entries.push_back(entry);

  entry.name = "bullet-pgs";
  entry.counts_sweeps = true;
  // A zero on the diagonal is left to it: it divides and does not say so.
  entry.refuses = &refuses_cones;
  entry.make = [](const PeerSettings&) {
    return std::make_unique<BulletPeer<btSolveProjectedGaussSeidel>>(double{BT_INFINITY},
                                                                     Claim::kNothing);
  };
  entries.push_back(entry);
}

}  // namespace signorini::bench
