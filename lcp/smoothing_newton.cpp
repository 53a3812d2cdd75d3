#include <signorini/lcp/smooth_clamp.h>
#include <signorini/lcp/smoothing_newton.h>

#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFirstMu = 0.3;  // of the start's error, the root of its mean square
constexpr double kFalls = 0.05;
// Of a unit diagonal. It changes the path and not the answer; far below it rows with x_i > 0 lose
// their digits in the solves, and steps become short where mu is small.
constexpr double kProximal = 1e-9;

/// The root of the mean square of x - p(x - r).
double error_of(const ScaledProblem& problem, const Vector& x, const Vector& r, double mu) {
  double sum = 0.0;
  for (Index i = 0; i < x.size(); ++i) {
    const double error =
        x[i] - SmoothClamp(x[i] - r[i], problem.lower()[i], problem.upper()[i], mu).value;
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(x.size()));
}

}  // namespace

/// e_ and h_ of the step from (x, mu) to next_mu. A row whose bounds are equal has p' = 0, and
/// does not move.
void SmoothingNewton::linearise(const ScaledProblem& problem, const Vector& x, double mu,
                                double next_mu) {
  for (Index i = 0; i < x.size(); ++i) {
    const SmoothClamp p(x[i] - r_[i], problem.lower()[i], problem.upper()[i], mu);
    const bool moves = p.by_y > 0.0;
    e_[i] = moves ? p.rest / p.by_y : kInfinity;
    h_[i] = moves ? (p.value + p.by_mu * (next_mu - mu) - x[i]) / p.by_y : 0.0;
  }
}

/// The first of 1, 1/2, 1/4 and 1/8 of the step that leaves an error within the mu it comes to, or
/// less of it; the last if none does. next_x_, next_r_: in: where the whole step ends; out: where
/// this one does
double SmoothingNewton::search(const ScaledProblem& problem, const Vector& x, double mu,
                               double next_mu) {
  constexpr double kLeast = 0.125;
  constexpr double kEnough = 0.1;  // of what a linear error would fall by
  const double before = error_of(problem, x, r_, mu);
  for (double t = 1.0;; t *= 0.5) {
    const double reached = mu + t * (next_mu - mu);
    const double after = error_of(problem, next_x_, next_r_, reached);
    if (after <= reached || after <= (1.0 - kEnough * t) * before || t <= kLeast) {
      return t;
    }
    next_x_ = x + 0.5 * t * dx_;
    next_r_ = r_ + 0.5 * t * dr_;
  }
}

void SmoothingNewton::reserve(Index rows) {
  for (Vector* vector : {&r_, &e_, &h_, &dx_, &dr_, &next_x_, &next_r_, &inside_}) {
    vector->resize(rows);
  }
}

bool SmoothingNewton::improve(ScaledProblem& problem, Vector& x, int most_steps, double tolerance,
                              const Deadline& deadline) {
  constexpr double kShort = 0.2;
  constexpr int kMostShort = 2;
  reserve(x.size());
  problem.gradient(x, r_);
  double mu = kFirstMu * error_of(problem, x, r_, 0.0);
  int shorts = 0;
  for (int step = 0; step < most_steps && mu > 0.0 && !deadline.passed(); ++step) {
    const double next_mu = kFalls * mu;
    linearise(problem, x, mu, next_mu);
    if (!problem.system().factor(e_, kProximal)) {
      break;
    }
    problem.system().solve(h_, dx_);
    next_x_ = x + dx_;
    problem.gradient(next_x_, next_r_);  // and not A dx: r loses no digits from step to step
    dr_ = next_r_ - r_;
    if (!dr_.allFinite()) {
      break;
    }
    const double t = search(problem, x, mu, next_mu);
    mu += t * (next_mu - mu);
    x.swap(next_x_);
    r_.swap(next_r_);
    inside_ = x.cwiseMax(problem.lower()).cwiseMin(problem.upper());
    problem.gradient(inside_, h_);
    shorts += t < kShort ? 1 : 0;
    if (problem.consider(inside_, h_) <= tolerance || shorts == kMostShort) {
      break;
    }
  }
  return problem.best_residual() <= tolerance;
}

}  // namespace signorini::lcp
