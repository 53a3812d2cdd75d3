#include <signorini/lcp/active_set_newton.h>

#include <algorithm>
#include <cmath>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Proximal weight of the linear solves, of a unit diagonal: they converge by the factor
// delta / (delta + smallest eigenvalue that matters).
constexpr double kProximal = 1e-9;
constexpr int kMostProximalSteps = 12;
constexpr double kFew = 4.0;  // wrong rows are never too many to begin with

}  // namespace

double ActiveSetNewton::improve(ScaledProblem& problem, Vector& x, std::vector<RowState>& state,
                                const Limits& limits, double tolerance) {
  const Index n = problem.size();
  e_.resize(n);
  double residual = kInfinity;
  double most_wrong = limits.wrong_share * static_cast<double>(n) + kFew;
  for (int k = 0; k < limits.factorizations; ++k) {
    for (Index i = 0; i < n; ++i) {
      e_[i] = state[i] == RowState::kBetween ? 0.0 : kInfinity;
    }
    if (!problem.system().factor(e_, kProximal)) {
      return kInfinity;
    }
    solve_on_set(problem, x, state);
    clamped_ = x.cwiseMax(problem.lower()).cwiseMin(problem.upper());
    if (clamped_ != x) {
      problem.gradient(clamped_, h_);
      residual = problem.consider(clamped_, h_);
    } else {
      residual = problem.consider(x, gradient_);
    }
    if (residual <= tolerance) {
      return residual;
    }
    const int wrong = correct_set(problem, x, state);
    if (wrong == 0 || wrong > most_wrong) {
      return residual;  // nothing to correct, or no progress
    }
    most_wrong = std::max(0.75 * wrong, 0.5 * kFew);
  }
  return residual;
}

/// Proximal steps with the factor at hand until the gradient of the rows between their bounds no
/// longer halves. gradient_ is that of x at the end.
void ActiveSetNewton::solve_on_set(ScaledProblem& problem, Vector& x,
                                   const std::vector<RowState>& state) {
  for (Index i = 0; i < x.size(); ++i) {
    if (state[i] != RowState::kBetween) {
      x[i] = state[i] == RowState::kAtLower ? problem.lower()[i] : problem.upper()[i];
    }
  }
  double before = kInfinity;
  for (int step = 0;; ++step) {
    problem.gradient(x, gradient_);
    double most = 0.0;
    h_.resize(x.size());
    for (Index i = 0; i < x.size(); ++i) {
      h_[i] = state[i] == RowState::kBetween ? -gradient_[i] : 0.0;
      most = std::max(most, std::abs(h_[i]));
    }
    if (!(most < 0.5 * before) || most == 0.0 || step == kMostProximalSteps) {
      return;
    }
    before = most;
    problem.system().solve(h_, dx_);
    x += dx_;
  }
}

/// Rows whose sign is wrong change sides. @return how many did
int ActiveSetNewton::correct_set(const ScaledProblem& problem, const Vector& x,
                                 std::vector<RowState>& state) {
  int wrong = 0;
  for (Index i = 0; i < x.size(); ++i) {
    RowState next = state[i];
    switch (state[i]) {
      case RowState::kBetween:
        next = x[i] < problem.lower()[i]   ? RowState::kAtLower
               : x[i] > problem.upper()[i] ? RowState::kAtUpper
                                           : RowState::kBetween;
        break;
      case RowState::kAtLower:
        next = gradient_[i] < 0.0 && problem.lower()[i] < problem.upper()[i] ? RowState::kBetween
                                                                             : state[i];
        break;
      case RowState::kAtUpper:
        next = gradient_[i] > 0.0 && problem.lower()[i] < problem.upper()[i] ? RowState::kBetween
                                                                             : state[i];
        break;
    }
    wrong += next != state[i] ? 1 : 0;
    state[i] = next;
  }
  return wrong;
}

}  // namespace signorini::lcp
