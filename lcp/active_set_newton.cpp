#include <signorini/lcp/active_set_newton.h>

#include <algorithm>
#include <cmath>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Proximal weight of the linear solves, of a unit diagonal: they converge by the factor
// delta / (delta + smallest eigenvalue that matters). Where the set is right and they do not (large
// mass ratios) the weight falls by this factor, once.
constexpr double kProximal = 1e-9;
constexpr double kLeastProximal = 1e-12;
constexpr int kMostProximalSteps = 12;
// What a round of seek_inside() must leave of the largest violation to go on.
constexpr double kHelps = 0.9;
constexpr double kRounding = 1e-14;
// The number of wrong rows must fall from one set to the next; several may grow for once.
constexpr double kMustFall = 0.75;
constexpr double kMayGrow = 1.3;
constexpr int kSeveral = 16;
constexpr double kFew = 4.0;  // wrong rows are never too many to begin with

}  // namespace

double ActiveSetNewton::improve(ScaledProblem& problem, Vector& x, std::vector<RowState>& state,
                                const Limits& limits, double tolerance) {
  const Index n = problem.size();
  e_.resize(n);
  double residual = kInfinity;
  double proximal = kProximal;
  double most_wrong = limits.wrong_share * static_cast<double>(n) + kFew;
  for (int k = 0; k < limits.factorizations; ++k) {
    for (Index i = 0; i < n; ++i) {
      e_[i] = state[i] == RowState::kBetween ? 0.0 : kInfinity;
    }
    if (!problem.system().factor(e_, proximal)) {
      return kInfinity;
    }
    solve_on_set(problem, x, state);
    if (problem.system().is_symmetric()) {
      seek_inside(problem, x, state, limits.rounds, most_wrong);
    }
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
    if (wrong == 0 && proximal > kLeastProximal) {
      proximal = kLeastProximal;
      continue;
    }
    if (wrong == 0 || wrong > most_wrong) {
      return residual;  // nothing to correct, or no progress
    }
    most_wrong = wrong <= kSeveral ? std::max(kMayGrow * wrong, kFew) : kMustFall * wrong;
  }
  return residual;
}

/// h_: minus the gradient of x in the rows between their bounds. @return its largest
double ActiveSetNewton::gradient_on_set(ScaledProblem& problem, const Vector& x,
                                        const std::vector<RowState>& state) {
  problem.gradient(x, gradient_);
  double most = 0.0;
  h_.resize(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    h_[i] = state[i] == RowState::kBetween ? -gradient_[i] : 0.0;
    most = std::max(most, std::abs(h_[i]));
  }
  return most;
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
  const double rounding = 1e-15 * (problem.g().cwiseAbs().maxCoeff() + x.cwiseAbs().maxCoeff());
  double before = kInfinity;
  for (int step = 0;; ++step) {
    const double most = gradient_on_set(problem, x, state);
    if (!(most < 0.5 * before) || most <= rounding || step == kMostProximalSteps) {
      return;
    }
    before = most;
    problem.system().solve(h_, dx_);
    x += dx_;
  }
}

/// Where rows are redundant the solution on the set is not one point but a plane, of which
/// solve_on_set() finds the point next to the start: outside the bounds perhaps, while others are
/// inside. Rows outside are mirrored in their bound and the plane is gone back to, with the factor
/// at hand, which ends inside if the plane has an inside (Motzkin, Schoenberg 1954, relaxation with
/// factor 2). Gives up as soon as it does not help: without redundancy the point comes back. On the
/// way one proximal step is near enough to the plane; the last point is solved for in full.
void ActiveSetNewton::seek_inside(ScaledProblem& problem, Vector& x,
                                  const std::vector<RowState>& state, int rounds,
                                  double most_outside) {
  double before = kInfinity;
  int round = 0;
  for (; round < rounds; ++round) {
    double most = 0.0;
    int outside = 0;
    for (Index i = 0; i < x.size(); ++i) {
      if (state[i] == RowState::kBetween) {
        const double violation = std::max(problem.lower()[i] - x[i], x[i] - problem.upper()[i]);
        outside += violation > 0.0 ? 1 : 0;
        most = std::max(most, violation);
      }
    }
    if (most == 0.0 || most > kHelps * before || outside > most_outside) {
      break;
    }
    before = most;
    for (Index i = 0; i < x.size(); ++i) {
      if (state[i] == RowState::kBetween) {
        const double bound = std::clamp(x[i], problem.lower()[i], problem.upper()[i]);
        x[i] = std::clamp(2.0 * bound - x[i], problem.lower()[i], problem.upper()[i]);
      }
    }
    gradient_on_set(problem, x, state);
    problem.system().solve(h_, dx_);
    x += dx_;
  }
  if (round > 0) {
    solve_on_set(problem, x, state);
  }
}

/// Rows whose sign is wrong by more than rounding change sides. @return how many did
int ActiveSetNewton::correct_set(const ScaledProblem& problem, const Vector& x,
                                 std::vector<RowState>& state) {
  const double rounding = kRounding * (problem.g().cwiseAbs().maxCoeff() + x.cwiseAbs().maxCoeff());
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
        next = gradient_[i] < -rounding && problem.lower()[i] < problem.upper()[i]
                   ? RowState::kBetween
                   : state[i];
        break;
      case RowState::kAtUpper:
        next = gradient_[i] > rounding && problem.lower()[i] < problem.upper()[i]
                   ? RowState::kBetween
                   : state[i];
        break;
    }
    wrong += next != state[i] ? 1 : 0;
    state[i] = next;
  }
  return wrong;
}

}  // namespace signorini::lcp
