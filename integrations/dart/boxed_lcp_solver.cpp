#include <signorini/integrations/dart/boxed_lcp_solver.h>

#include <Eigen/Core>
#include <algorithm>
#include <limits>

namespace signorini::dartsim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Numbers from one row of A to the next, as ODE has it.
int stride(int n) {
  return n > 1 ? (n + 3) / 4 * 4 : n;
}

}  // namespace

const std::string& BoxedLcpSolver::getStaticType() {
  static const std::string type = "SignoriniBoxedLcpSolver";
  return type;
}

bool BoxedLcpSolver::solve(int n, double* A, double* x, double* b, int nub, double* lo, double* hi,
                           int* findex, bool /*early_termination*/) {
  using PaddedRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  rows_.resize(n);
  rows_.A = Eigen::Map<const PaddedRows, 0, Eigen::OuterStride<>>(A, n, n,
                                                                  Eigen::OuterStride<>(stride(n)));
  rows_.b = Eigen::Map<const lcp::Vector>(b, n);
  rows_.x = Eigen::Map<const lcp::Vector>(x, n);
  rows_.lower = Eigen::Map<const lcp::Vector>(lo, n);
  rows_.upper = Eigen::Map<const lcp::Vector>(hi, n);
  for (int i = 0; i < n; ++i) {
    rows_.normal_row[i] = findex[i] == i ? -1 : std::max(findex[i], -1);
    if (i < nub) {
      rows_.lower[i] = -kInfinity;
      rows_.upper[i] = kInfinity;
      rows_.normal_row[i] = -1;
    }
  }
  const bool is_solved = solver_.solve(rows_);
  const bool is_valid = last_result().status != lcp::Status::kInvalidInput;
  Eigen::Map<lcp::Vector>(x, n) = is_valid ? rows_.x : lcp::Vector(lcp::Vector::Zero(n));
  return is_solved;
}

}  // namespace signorini::dartsim
