// Siconos numerics: its solvers of LCPs on dense matrices, and of Coulomb friction (fc3d, fc2d) on
// the storage that each of them is made for.

#include "bench/peer.h"

#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <LCP_Solvers.h>
#include <LinearComplementarityProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <NumericsSparseMatrix.h>
#include <NumericsVerbose.h>
#include <SolverOptions.h>
#include <SparseBlockMatrix.h>
#include <algorithm>
#include <lcp_cst.h>
#include <limits>

namespace signorini::bench {
namespace {

constexpr int kManyIterations = 1000000;  // the time limit ends it

struct DeleteOptions {
  void operator()(SolverOptions* options) const { solver_options_delete(options); }
};

/// Siconos measures |z - (z - w)+|_2 / |q|_2, of cones with their projection. This tolerance on it
/// implies the given one on
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

enum class Storage : unsigned char { kDense, kBlocks, kSparse };

struct DeleteMatrix {
  void operator()(NumericsMatrix* matrix) const { NM_free(matrix); }
};
using MatrixPointer = std::unique_ptr<NumericsMatrix, DeleteMatrix>;

MatrixPointer make_sparse(const lcp::Matrix& M) {
  const int n = static_cast<int>(M.rows());
  MatrixPointer sparse(NM_create(NM_SPARSE, n, n));
  NM_triplet_alloc(sparse.get(), (M.array() != 0.0).count());
  sparse->matrix2->origin = NSM_TRIPLET;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      if (M(i, j) != 0.0) {
        NM_entry(sparse.get(), i, j, M(i, j));
      }
    }
  }
  return sparse;
}

/// Siconos's own copy of M. @param block rows of a contact
MatrixPointer make_matrix(const lcp::Matrix& M, Storage storage, int block) {
  const int n = static_cast<int>(M.rows());
  if (storage == Storage::kDense) {
    MatrixPointer dense(NM_create(NM_DENSE, n, n));
    std::copy(M.data(), M.data() + M.size(), dense->matrix0);
    return dense;
  }
  MatrixPointer sparse = make_sparse(M);
  if (storage == Storage::kSparse) {
    return sparse;
  }
  MatrixPointer blocks(NM_create(NM_SPARSE_BLOCK, n, n));
  SBM_from_csparse(block, NM_csc(sparse.get()), blocks->matrix1);
  return blocks;
}

class SiconosFrictionPeer : public Peer {
 public:
  SiconosFrictionPeer(int solver, Storage storage, const PeerSettings& settings)
      : solver_(solver), storage_(storage), tolerance_(settings.tolerance) {
    numerics_set_verbose(0);
  }

  void load(const lcp::Problem& problem) override {
    dense_ = lcp::to_dense(problem.M);
    q_ = problem.q;
    mu_.resize(static_cast<lcp::Index>(problem.cones.size()));
    for (std::size_t c = 0; c < problem.cones.size(); ++c) {
      mu_[static_cast<lcp::Index>(c)] = problem.cones[c].coefficient;
    }
    dimension_ = problem.cones.front().dimension;
    r_.resize(q_.size());
    u_.resize(q_.size());
  }

  void rewind() override {
    M_ = make_matrix(dense_, storage_, dimension_);  // solvers keep factors in it
    options_.reset(solver_options_create(solver_));
    options_->dparam[SICONOS_DPARAM_TOL] = siconos_tolerance(q_, tolerance_);
    options_->iparam[SICONOS_IPARAM_MAX_ITER] = kManyIterations;
    r_.setZero();
    u_.setZero();
    problem_ = {.dimension = dimension_,
                .numberOfContacts = static_cast<int>(mu_.size()),
                .M = M_.get(),
                .q = q_.data(),
                .mu = mu_.data()};
  }

  void solve(PeerAnswer& answer) override {
    const int code = dimension_ == 3 ? fc3d_driver(&problem_, r_.data(), u_.data(), options_.get())
                                     : fc2d_driver(&problem_, r_.data(), u_.data(), options_.get());
    answer.claim = code == 0 ? Claim::kSolved : Claim::kFailed;
    answer.said = "info " + std::to_string(code);
    answer.z = r_;
    answer.iterations = options_->iparam[SICONOS_IPARAM_ITER_DONE];
  }

 private:
  int solver_;
  Storage storage_;
  double tolerance_;
  int dimension_ = 3;
  lcp::Matrix dense_;
  lcp::Vector q_, mu_, r_, u_;
  MatrixPointer M_;
  FrictionContactProblem problem_{};
  std::unique_ptr<SolverOptions, DeleteOptions> options_;
};

/// Contact after contact, every row in a Coulomb cone of this dimension.
std::string refuses_all_but_cones(const lcp::Problem& problem, int dimension) {
  std::string reason = "takes Coulomb cones of " + std::to_string(dimension) + " rows alone";
  if (problem.cones.empty() || problem.friction_law != lcp::FrictionLaw::kCoulomb ||
      problem.size() != static_cast<lcp::Index>(dimension * problem.cones.size())) {
    return reason;
  }
  for (std::size_t c = 0; c < problem.cones.size(); ++c) {
    if (problem.cones[c].dimension != dimension ||
        problem.cones[c].normal_row != dimension * static_cast<int>(c)) {
      return reason;
    }
  }
  return "";
}

void add_friction_peers(std::vector<PeerEntry>& entries) {
  struct Named {
    const char* name;
    int solver;
    int dimension;
    Storage storage;
  };
  for (const Named& named :
       {Named{"siconos-fc3d-nsgs", SICONOS_FRICTION_3D_NSGS, 3, Storage::kBlocks},
        Named{"siconos-fc3d-nsn-ac", SICONOS_FRICTION_3D_NSN_AC, 3, Storage::kSparse},
        Named{"siconos-fc3d-nsn-fb", SICONOS_FRICTION_3D_NSN_FB, 3, Storage::kSparse},
        Named{"siconos-fc3d-prox", SICONOS_FRICTION_3D_PROX, 3, Storage::kSparse},
        Named{"siconos-fc3d-admm", SICONOS_FRICTION_3D_ADMM, 3, Storage::kSparse},
        Named{"siconos-fc3d-vi-eg", SICONOS_FRICTION_3D_VI_EG, 3, Storage::kBlocks},
        Named{"siconos-fc2d-nsgs", SICONOS_FRICTION_2D_NSGS, 2, Storage::kBlocks},
        Named{"siconos-fc2d-lemke", SICONOS_FRICTION_2D_LEMKE, 2, Storage::kDense}}) {
    PeerEntry entry;
    entry.name = named.name;
    entry.library = "Siconos";
    entry.refuses = [dimension = named.dimension](const lcp::Problem& problem) {
      return refuses_all_but_cones(problem, dimension);
    };
    entry.make = [named](const PeerSettings& settings) {
      return std::make_unique<SiconosFrictionPeer>(named.solver, named.storage, settings);
    };
    entries.push_back(entry);
  }
}

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
  add_friction_peers(entries);
}

}  // namespace signorini::bench
