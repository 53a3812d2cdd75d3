#include <signorini/integrations/bullet/mlcp_solver.h>

#include <cmath>
#include <limits>
#include <string>

namespace signorini::bullet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBulletInfinity = 1e10;  // the upper bound of Bullet's contacts
constexpr int kDenseRows = 100;           // beyond, zeros are worth knowing

double bound(btScalar limit) {
  return std::abs(double(limit)) >= kBulletInfinity ? std::copysign(kInfinity, double(limit))
                                                    : double(limit);
}

void copy(const btMatrixXu& from, lcp::MatrixForm& to) {
  const int n = from.rows();
  if (n <= kDenseRows) {
    lcp::Matrix M(n, n);
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        M(i, j) = double(from(i, j));
      }
    }
    to = std::move(M);
    return;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (from(i, j) != 0) {
        entries.emplace_back(i, j, double(from(i, j)));
      }
    }
  }
  lcp::SparseMatrix M(n, n);
  M.setFromTriplets(entries.begin(), entries.end());
  to = std::move(M);
}

}  // namespace

MlcpSolver::MlcpSolver(const lcp::SolverSettings& settings)
    : solver_(lcp::make_solver("auto", settings)) {}

/// Fills the problem. @return why Bullet's data are none, or empty
std::string MlcpSolver::read(const btMatrixXu& A, const btVectorXu& b, const btVectorXu& lo,
                             const btVectorXu& hi,
                             const btAlignedObjectArray<int>& limit_dependencies) {
  const int n = b.rows();
  if (A.rows() != n || A.cols() != n || lo.rows() != n || hi.rows() != n ||
      limit_dependencies.size() != n) {
    return "A, b, lo, hi and the limit dependencies differ in size";
  }
  copy(A, problem_.M);
  problem_.q.resize(n);
  problem_.lower.resize(n);
  problem_.upper.resize(n);
  problem_.limits.clear();
  for (int i = 0; i < n; ++i) {
    problem_.q[i] = -double(b[i]);
    problem_.lower[i] = bound(lo[i]);
    problem_.upper[i] = bound(hi[i]);
    const int normal = limit_dependencies[i];
    if (normal < 0) {
      continue;
    }
    if (normal >= n || limit_dependencies[normal] >= 0) {
      return "row " + std::to_string(i) + " depends on row " + std::to_string(normal) +
             ", which is none or depends itself";
    }
    if (!(lo[i] == -hi[i] && hi[i] >= 0)) {
      return "row " + std::to_string(i) + ": coupled bounds must be -mu and mu, got " +
             std::to_string(double(lo[i])) + " and " + std::to_string(double(hi[i]));
    }
    problem_.limits.push_back({.row = i, .normal_row = normal, .coefficient = double(hi[i])});
  }
  return {};
}

bool MlcpSolver::solveMLCP(const btMatrixXu& A, const btVectorXu& b, btVectorXu& x,
                           const btVectorXu& lo, const btVectorXu& hi,
                           const btAlignedObjectArray<int>& limit_dependencies, int, bool) {
  if (std::string bad = read(A, b, lo, hi, limit_dependencies); !bad.empty()) {
    result_ = {};
    result_.status = lcp::Status::kInvalidInput;
    result_.detail = std::move(bad);
  } else {
    const int n = b.rows();
    start_.setZero(n);
    if (x.rows() == n) {
      for (int i = 0; i < n; ++i) {
        start_[i] = double(x[i]);
      }
    } else {
      x.resize(n);
    }
    solver_->solve(problem_, result_, start_.isZero(0.0) ? nullptr : &start_);
    for (int i = 0; i < n; ++i) {
      x[i] = btScalar(result_.z[i]);
    }
  }
  ++counters_.problems;
  ++counters_.by_status[static_cast<std::size_t>(result_.status)];
  const bool is_solved = lcp::is_solved(result_.status);
  if (!is_solved && not_solved_) {
    not_solved_(result_);
  }
  return is_solved;
}

}  // namespace signorini::bullet
