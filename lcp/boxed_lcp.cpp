#include <signorini/lcp/boxed_lcp.h>
#include <signorini/lcp/number_text.h>

#include <algorithm>
#include <utility>

namespace signorini::lcp {
namespace {

constexpr Index kDenseRows = 100;  // beyond, zeros are worth knowing

MatrixForm matrix_form(const Matrix& A) {
  if (A.rows() <= kDenseRows) {
    return A;
  }
  return SparseMatrix(A.sparseView(/*reference=*/1.0, /*epsilon=*/0.0));
}

std::string row(Index i) {
  return "row " + std::to_string(i);
}

}  // namespace

void BoxedLcp::resize(Index n) {
  A.resize(n, n);
  for (Vector* v : {&b, &lower, &upper, &x}) {
    v->resize(n);
  }
  normal_row.resize(static_cast<std::size_t>(n));
}

BoxedLcpSolver::BoxedLcpSolver(const SolverSettings& settings)
    : solver_(make_solver("auto", settings)) {}

/// Fills the problem. @return why the data are none, or empty
std::string BoxedLcpSolver::read(const BoxedLcp& lcp) {
  const Index n = lcp.b.size();
  const auto differs = [n](const Vector& v) { return v.size() != n; };
  if (lcp.A.rows() != n || lcp.A.cols() != n || differs(lcp.lower) || differs(lcp.upper) ||
      differs(lcp.x) || static_cast<Index>(lcp.normal_row.size()) != n) {
    return "A, b, x, the bounds and the normal rows differ in size";
  }
  problem_.M = matrix_form(lcp.A);
  problem_.q = -lcp.b;
  problem_.lower = lcp.lower;
  problem_.upper = lcp.upper;
  problem_.limits.clear();
  for (Index i = 0; i < n; ++i) {
    const int normal = lcp.normal_row[i];
    if (normal < 0) {
      continue;
    }
    if (normal >= n || lcp.normal_row[normal] >= 0) {
      return row(i) + " depends on row " + std::to_string(normal) +
             ", which is none or depends itself";
    }
    if (!(lcp.lower[i] == -lcp.upper[i] && lcp.upper[i] >= 0.0)) {
      return row(i) + ": coupled bounds must be -mu and mu, got " + number_text(lcp.lower[i]) +
             " and " + number_text(lcp.upper[i]);
    }
    problem_.limits.push_back(
        {.row = static_cast<int>(i), .normal_row = normal, .coefficient = lcp.upper[i]});
  }
  return {};
}

bool BoxedLcpSolver::solve(BoxedLcp& lcp) {
  if (std::string bad = read(lcp); !bad.empty()) {
    return refuse(std::move(bad));
  }
  solver_->solve(problem_, result_, lcp.x.isZero(0.0) ? nullptr : &lcp.x);
  lcp.x = result_.z;
  return count();
}

bool BoxedLcpSolver::refuse(std::string why) {
  result_ = {};
  result_.status = Status::kInvalidInput;
  result_.detail = std::move(why);
  return count();
}

/// The last result, into the counters and to the visitor. @return whether it is solved
bool BoxedLcpSolver::count() {
  ++counters_.problems;
  ++counters_.by_status[static_cast<std::size_t>(result_.status)];
  const bool solved = is_solved(result_.status);
  if (!solved && not_solved_) {
    not_solved_(result_);
  }
  return solved;
}

}  // namespace signorini::lcp
