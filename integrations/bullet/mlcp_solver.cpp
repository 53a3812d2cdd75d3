#include <signorini/integrations/bullet/mlcp_solver.h>

#include <cmath>
#include <limits>

namespace signorini::bullet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBulletInfinity = 1e10;  // the upper bound of Bullet's contacts

double bound(btScalar limit) {
  return std::abs(double(limit)) >= kBulletInfinity ? std::copysign(kInfinity, double(limit))
                                                    : double(limit);
}

}  // namespace

bool MlcpSolver::solveMLCP(const btMatrixXu& A, const btVectorXu& b, btVectorXu& x,
                           const btVectorXu& lo, const btVectorXu& hi,
                           const btAlignedObjectArray<int>& limit_dependencies, int, bool) {
  const int n = b.rows();
  if (A.rows() != n || A.cols() != n || lo.rows() != n || hi.rows() != n ||
      limit_dependencies.size() != n) {
    return solver_.refuse("A, b, lo, hi and the limit dependencies differ in size");
  }
  rows_.resize(n);
  const bool has_start = x.rows() == n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      rows_.A(i, j) = double(A(i, j));
    }
    rows_.b[i] = double(b[i]);
    rows_.lower[i] = bound(lo[i]);
    rows_.upper[i] = bound(hi[i]);
    rows_.normal_row[i] = limit_dependencies[i];
    rows_.x[i] = has_start ? double(x[i]) : 0.0;
  }
  const bool is_solved = solver_.solve(rows_);
  if (!has_start) {
    x.resize(n);
  }
  for (int i = 0; i < n; ++i) {
    x[i] = btScalar(rows_.x[i]);
  }
  return is_solved;
}

}  // namespace signorini::bullet
