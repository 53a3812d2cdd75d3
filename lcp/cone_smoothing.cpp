#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/cone_smoothing.h>
#include <signorini/lcp/number_text.h>
#include <signorini/lcp/scaled_groups.h>
#include <signorini/lcp/smoothed_cones.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kAlpha = 1e-9;
constexpr double kAlphaRises = 10.0;
constexpr int kMostRises = 6;

}  // namespace

class ConeSmoothing::Workspace {
 public:
  Status solve(const Problem& problem, const ConeSmoothingSettings& settings,
               const Vector* warm_start, const Deadline& deadline, Result& result);

 private:
  double error_of(const Vector& x, const Vector& u, double mu);
  [[nodiscard]] double aim(double mu, double error) const;
  [[nodiscard]] bool find_step(double mu, double next_mu);
  [[nodiscard]] double search(double mu, double next_mu, double error);
  [[nodiscard]] bool look(double tolerance);

  ScaledGroups groups_;
  SmoothedCones cones_;
  BestIterate best_;
  double residual_ = 0.0;  // of the best iterate
  double alpha_ = kAlpha;
  int rises_ = 0;  // of alpha
  int factorizations_ = 0;
  Vector x_, u_, F_, by_mu_, dx_, du_, next_x_, next_u_, z_;
  std::vector<AlartCurnierFunction::Block> A_, B_;
  std::vector<AlartCurnierFunction::Coupling> no_couplings_;
};

/// The root of the mean square of F.
double ConeSmoothing::Workspace::error_of(const Vector& x, const Vector& u, double mu) {
  cones_.evaluate(x, u, mu, F_);
  return F_.norm() / std::sqrt(static_cast<double>(x.size()));
}

/// The mu that a step from (x_, mu) with this error is to come to.
double ConeSmoothing::Workspace::aim(double mu, double error) const {
  constexpr double kOnPath = 0.03;
  constexpr double kFalls = 0.5;
  constexpr double kFallsMost = 0.02;
  constexpr double kNear = 1e-4;
  if (error > kOnPath * mu) {
    return mu;
  }
  return residual_ > kNear ? kFalls * mu
                           : std::max(kFallsMost, kFalls * std::sqrt(error / (kOnPath * mu))) * mu;
}

/// dx_ from (x_, mu) to next_mu. A system that is singular gets a larger alpha. @return false if
/// there is none
bool ConeSmoothing::Workspace::find_step(double mu, double next_mu) {
  cones_.linearise(x_, u_, mu, F_, A_, B_, by_mu_);
  F_ += (next_mu - mu) * by_mu_;
  for (;; ++rises_, alpha_ *= kAlphaRises) {
    ++factorizations_;
    if (groups_.factor(A_, B_, no_couplings_, alpha_) && groups_.solve(F_, dx_)) {
      return true;
    }
    if (rises_ == kMostRises) {
      return false;
    }
  }
}

/// How much of the step is gone, to next_x_ and next_u_.
double ConeSmoothing::Workspace::search(double mu, double next_mu, double error) {
  constexpr double kLeast = 1e-3;
  constexpr double kEnough = 0.1;
  next_x_ = x_ + dx_;
  groups_.multiply(next_x_, next_u_);
  next_u_ += groups_.b();
  du_ = next_u_ - u_;
  for (double t = 1.0;; t *= 0.5) {
    const double reached = mu + t * (next_mu - mu);
    const double after = error_of(next_x_, next_u_, reached);
    if (after <= reached || after <= (1.0 - kEnough * t) * error || t < kLeast) {
      return t;
    }
    next_x_ = x_ + 0.5 * t * dx_;
    next_u_ = u_ + 0.5 * t * du_;
  }
}

/// Offers x_ as an answer. @return whether the best one is solved
bool ConeSmoothing::Workspace::look(double tolerance) {
  groups_.to_caller(x_, z_);
  residual_ = std::min(residual_, BestIterate::merit(best_.offer(z_)));
  return is_solved(judge(best_.certificate(), tolerance, Status::kStalled));
}

Status ConeSmoothing::Workspace::solve(const Problem& problem,
                                       const ConeSmoothingSettings& settings,
                                       const Vector* warm_start, const Deadline& deadline,
                                       Result& result) {
  constexpr double kShort = 0.1;
  constexpr int kMostShort = 5;
  constexpr double kRise = 10.0;
  const int most =
      settings.max_iterations >= 0 ? settings.max_iterations : ConeSmoothingSettings::kDefaultSteps;
  best_.reset(problem, settings.tolerance);
  groups_.set(problem);
  cones_.set(groups_.function().groups(), problem.friction_law);
  alpha_ = kAlpha;
  rises_ = 0;
  factorizations_ = 0;
  residual_ = std::numeric_limits<double>::infinity();
  x_.setZero(problem.size());
  if (warm_start != nullptr) {
    groups_.from_caller(*warm_start, x_);
  }
  groups_.multiply(x_, u_);
  u_ += groups_.b();
  double mu = error_of(x_, u_, 0.0);
  Status ending = Status::kStalled;  // what it is if the certificate does not say solved
  int steps = 0;
  for (int shorts = 0; !look(settings.tolerance); ++steps) {
    if (steps == most || deadline.passed()) {
      ending = steps == most ? Status::kIterationLimit : Status::kTimeLimit;
      break;
    }
    if (mu == 0.0) {  // there is no error to smooth that F could see
      break;
    }
    const double error = error_of(x_, u_, mu);
    const double next_mu = aim(mu, error);
    if (!std::isfinite(error) || !find_step(mu, next_mu)) {
      ending = Status::kNumericalBreakdown;
      break;
    }
    const double t = search(mu, next_mu, error);
    mu += t * (next_mu - mu);
    x_.swap(next_x_);
    if (t == 1.0) {
      u_.swap(next_u_);
    } else {
      groups_.multiply(x_, u_);
      u_ += groups_.b();
    }
    shorts = t < kShort ? shorts + 1 : 0;
    if (shorts == kMostShort) {
      mu *= kRise;
      shorts = 0;
    }
  }
  result.z = best_.z();
  result.statistics = {.iterations = steps,
                       .factorizations = factorizations_,
                       .factor_bytes = groups_.factor_bytes()};
  if (rises_ > 0) {
    result.detail += "regularisation raised to " + number_text(alpha_) +
                     " where a system was singular (it changes the path, not the answer)";
  }
  return ending;
}

ConeSmoothing::ConeSmoothing(const ConeSmoothingSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>()) {
  settings_.validate();
}

ConeSmoothing::~ConeSmoothing() = default;

std::string ConeSmoothing::refuses(const Problem& problem) const {
  return problem.limits.empty() ? ""
                                : "takes no coupled limits; row " +
                                      std::to_string(problem.limits.front().row) + " has one";
}

Status ConeSmoothing::iterate(const Problem& problem, const Vector* warm_start,
                              const Deadline& deadline, Result& result) {
  return workspace_->solve(problem, settings_, warm_start, deadline, result);
}

}  // namespace signorini::lcp
