#include <signorini/lcp/proximal_newton.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

/// The rows' answer change_ to the velocity increment u, and phi's gradient u - G^T change.
void ProximalNewton::dual_gradient(const ScaledProblem& problem, const WhitenedRows& rows,
                                   const Vector& u, Vector& gradient) {
  rows.times(u, slack_);
  slack_ += base_slack_;
  change_ =
      (point_ - slack_.cwiseQuotient(weight_)).cwiseMax(problem.lower()).cwiseMin(problem.upper()) -
      point_;
  rows.transpose_times(change_, gradient);
  gradient = u - gradient;
}

/// The exact minimum of phi(velocity_ + t direction_) over t >= 0: the derivative is increasing and
/// piecewise linear, with a break wherever a row reaches or leaves a bound.
/// @pre dual_gradient(velocity_).
double ProximalNewton::line_search(const ScaledProblem& problem, const WhitenedRows& rows) {
  rows.times(direction_, g_direction_);
  double slope = direction_.squaredNorm();
  double derivative = velocity_.dot(direction_) - change_.dot(g_direction_);
  breaks_.clear();
  breaks_.reserve(2 * static_cast<std::size_t>(rows.rows()));
  for (Index i = 0; i < rows.rows(); ++i) {
    const double value = point_[i] - slack_[i] / weight_[i];
    const double rate = -g_direction_[i] / weight_[i];
    const double curvature = weight_[i] * rate * rate;
    const double lower = problem.lower()[i];
    const double upper = problem.upper()[i];
    if (value > lower && value < upper) {
      slope += curvature;
    }
    if (rate == 0.0) {
      continue;
    }
    const double near = rate > 0.0 ? lower : upper;  // bounds in the order they are met
    const double far = rate > 0.0 ? upper : lower;
    if (const double t = (near - value) / rate; t >= 0.0) {
      breaks_.emplace_back(t, curvature);
    }
    if (const double t = (far - value) / rate; t > 0.0 && t < kInfinity) {
      breaks_.emplace_back(t, -curvature);
    }
  }
  // A heap: as a rule few of the breaks are before the minimum.
  std::make_heap(breaks_.begin(), breaks_.end(), std::greater<>());
  double at = 0.0;
  for (auto end = breaks_.end(); end != breaks_.begin(); --end) {
    const auto [t, change] = breaks_.front();
    if (derivative + slope * (t - at) >= 0.0) {
      break;
    }
    derivative += slope * (t - at);
    at = t;
    slope += change;
    std::pop_heap(breaks_.begin(), end, std::greater<>());
  }
  return at - derivative / slope;
}

/// x_ <- the proximal point's answer. @return false if it could not be found.
bool ProximalNewton::step(ScaledProblem& problem, BodySpaceSystem& system, double proximal,
                          int most_factorizations, const Deadline& deadline) {
  constexpr int kMostNewtonSteps = 30;
  constexpr int kMostStale = 4;
  constexpr double kFalls = 0.1;  // what refining an exact step must leave to be worth another
  constexpr double kWholeStep = 1e-6;
  constexpr double kVanished = 1e-10;  // of the first gradient: rounding, and rows on their bounds
  const WhitenedRows& rows = system.rows();
  point_ = x_;
  problem.gradient(x_, base_slack_);
  velocity_.setZero(rows.degrees_of_freedom());
  e_.resize(rows.rows());
  double first = 0.0;
  double least = kInfinity;
  double last = kInfinity;
  bool is_exact = false;  // the last step, but for rounding, if no row reaches or leaves a bound
  int stale = 0;  // steps since the least gradient: phi falls, its gradient may grow for a while
  for (int newton = 0;; ++newton) {
    dual_gradient(problem, rows, velocity_, gradient_);
    const double size = gradient_.size() > 0 ? gradient_.cwiseAbs().maxCoeff() : 0.0;
    const double speed = velocity_.size() > 0 ? velocity_.cwiseAbs().maxCoeff() : 0.0;
    if (!std::isfinite(size)) {
      return false;
    }
    first = newton == 0 ? size : first;
    stale = size < least ? 0 : stale + 1;
    least = std::min(size, least);
    if (size <= 1e-14 * (speed + change_.cwiseAbs().maxCoeff()) || size <= kVanished * first ||
        newton == kMostNewtonSteps || stale == kMostStale ||
        system.factorizations() >= most_factorizations || deadline.passed()) {
      break;
    }
    for (Index i = 0; i < rows.rows(); ++i) {
      const double x = point_[i] + change_[i];
      e_[i] = x > problem.lower()[i] && x < problem.upper()[i] ? 0.0 : kInfinity;
    }
    if (is_exact && e_ == last_e_ && !(size < kFalls * last)) {
      break;
    }
    last_e_ = e_;
    last = size;
    if (!system.factor(e_, proximal)) {
      return false;
    }
    direction_ = -gradient_;
    system.solve_in_body_space(direction_);
    const double t = line_search(problem, rows);
    if (!std::isfinite(t)) {
      return false;
    }
    velocity_ += t * direction_;
    is_exact = std::abs(t - 1.0) < kWholeStep;
  }
  x_ = (point_ + change_).cwiseMax(problem.lower()).cwiseMin(problem.upper());
  return true;
}

void ProximalNewton::improve(ScaledProblem& problem, BodySpaceSystem& system, double proximal,
                             int most_steps, int most_factorizations, double tolerance,
                             const Deadline& deadline) {
  constexpr double kMustFall = 0.5;
  x_ = problem.best();
  double before = problem.best_residual();
  for (int k = 0;
       k < most_steps && system.factorizations() < most_factorizations && !deadline.passed(); ++k) {
    weight_ = system.rows().compliance().array() + proximal;
    if (!step(problem, system, proximal, most_factorizations, deadline)) {
      return;
    }
    problem.gradient(x_, slack_);
    const double after = problem.consider(x_, slack_);
    if (after > kMustFall * before || problem.best_residual() <= 0.1 * tolerance) {
      return;
    }
    before = after;
  }
}

}  // namespace signorini::lcp
