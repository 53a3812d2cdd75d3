#include <signorini/lcp/scaled_problem.h>

#include <algorithm>
#include <cmath>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void ScaledProblem::set(const Problem& problem, ShiftedSystem& system) {
  problem_ = &problem;
  system_ = &system;
  const Index n = problem.size();
  const Vector& S = system.scale();
  g_ = problem.q.cwiseQuotient(S);
  problem.lower.size() > 0 ? lower_ = problem.lower.cwiseProduct(S) : lower_.setZero(n);
  problem.upper.size() > 0 ? upper_ = problem.upper.cwiseProduct(S)
                           : upper_.setConstant(n, kInfinity);
  is_lcp_ = problem.is_lcp();
  has_upper_ = upper_.minCoeff() < kInfinity;
  const double q_inf = problem.q.cwiseAbs().maxCoeff();
  natural_scale_ = 1.0 + q_inf;
  unit_free_scale_ = q_inf > 0.0 ? q_inf : 1.0;
  best_residual_ = kInfinity;
  best_x_.setZero(n);
  best_x_ = best_x_.cwiseMax(lower_).cwiseMin(upper_);
}

void ScaledProblem::gradient(const Vector& x, Vector& out) {
  system_->multiply(x, out);
  out += g_;
}

double ScaledProblem::consider(const Vector& x, const Vector& gradient) {
  const Vector& S = system_->scale();
  double natural = 0.0;
  double unit_free = 0.0;
  double sum = 0.0;  // not finite if any number is not
  if (is_lcp_) {
    for (Index i = 0; i < x.size(); ++i) {
      unit_free = std::max(unit_free, S[i] * std::abs(std::min(x[i], gradient[i])));
      natural = std::max(natural, std::abs(std::min(x[i] / S[i], S[i] * gradient[i])));
      sum += std::abs(x[i]) + std::abs(gradient[i]);
    }
  } else {
    for (Index i = 0; i < x.size(); ++i) {
      const double s2 = S[i] * S[i];
      const double scaled = x[i] - std::clamp(x[i] - gradient[i], lower_[i], upper_[i]);
      const double plain = x[i] - std::clamp(x[i] - s2 * gradient[i], lower_[i], upper_[i]);
      unit_free = std::max(unit_free, S[i] * std::abs(scaled));
      natural = std::max(natural, std::abs(plain) / S[i]);
      sum += std::abs(x[i]) + std::abs(gradient[i]);
    }
  }
  const double worst = std::max(natural / natural_scale_, unit_free / unit_free_scale_);
  if (!std::isfinite(sum) || !std::isfinite(worst)) {
    return kInfinity;  // a NaN must never look like a small residual
  }
  if (worst < best_residual_) {
    best_residual_ = worst;
    best_x_ = x;
  }
  return worst;
}

void ScaledProblem::best_z(Vector& z) const {
  z = best_x_.cwiseQuotient(system_->scale());
  if (problem_->lower.size() > 0) {
    z = z.cwiseMax(problem_->lower);
  }
  if (problem_->upper.size() > 0) {
    z = z.cwiseMin(problem_->upper);
  }
}

}  // namespace signorini::lcp
