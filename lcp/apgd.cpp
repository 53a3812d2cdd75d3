#include <signorini/lcp/apgd.h>
#include <signorini/lcp/whitened_rows.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

class Apgd::Workspace {
 public:
  Status solve(const Problem& problem, const ApgdSettings& settings, const Vector* warm_start,
               const Deadline& deadline, Result& result) {
    set(problem);
    const Status ending = descend(problem, settings, warm_start, deadline, result);
    result.z = best_x_.cwiseQuotient(rows_.scale()).cwiseMax(lower_z_).cwiseMin(upper_z_);
    return ending;
  }

 private:
  void set(const Problem& problem);
  void gradient(const Vector& x, Vector& out);
  double largest_eigenvalue(int iterations);
  double look(const Problem& problem);
  Status descend(const Problem& problem, const ApgdSettings& settings, const Vector* warm_start,
                 const Deadline& deadline, Result& result);

  WhitenedRows rows_;
  Vector g_, lower_, upper_, lower_z_, upper_z_;
  Vector x_, next_, y_, slope_, u_, best_x_, power_;
  double best_residual_ = kInfinity;
};

void Apgd::Workspace::set(const Problem& problem) {
  rows_.set(std::get<FactoredMatrix>(problem.M));
  const Index n = rows_.rows();
  g_ = problem.q.cwiseQuotient(rows_.scale());
  problem.lower.size() > 0 ? lower_z_ = problem.lower : lower_z_.setZero(n);
  problem.upper.size() > 0 ? upper_z_ = problem.upper : upper_z_.setConstant(n, kInfinity);
  lower_ = lower_z_.cwiseProduct(rows_.scale());
  upper_ = upper_z_.cwiseProduct(rows_.scale());
}

/// out = (G G^T + C) x + g.
void Apgd::Workspace::gradient(const Vector& x, Vector& out) {
  rows_.transpose_times(x, u_);
  rows_.times(u_, out);
  out += rows_.compliance().cwiseProduct(x) + g_;
}

/// A lower estimate of the largest eigenvalue of G G^T + C, by power iteration from a fixed start.
double Apgd::Workspace::largest_eigenvalue(int iterations) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.5, 1.5);
  power_.resize(rows_.rows());
  std::generate(power_.begin(), power_.end(), [&] { return uniform(random); });
  double eigenvalue = 1.0;
  for (int k = 0; k < iterations; ++k) {
    power_.normalize();
    gradient(power_, slope_);
    slope_ -= g_;
    eigenvalue = power_.dot(slope_);
    power_.swap(slope_);
    if (!(power_.norm() > 0.0)) {
      break;  // the zero matrix
    }
  }
  return eigenvalue;
}

/// The larger residual of the certificate at x_, in double. Keeps the best iterate.
double Apgd::Workspace::look(const Problem& problem) {
  gradient(x_, slope_);
  const Vector& s = rows_.scale();
  const double q_inf = problem.q.cwiseAbs().maxCoeff();
  double natural = 0.0;
  double unit_free = 0.0;
  for (Index i = 0; i < x_.size(); ++i) {
    const double scaled = x_[i] - std::clamp(x_[i] - slope_[i], lower_[i], upper_[i]);
    const double z = x_[i] / s[i];
    const double plain = z - std::clamp(z - s[i] * slope_[i], lower_z_[i], upper_z_[i]);
    unit_free = std::max(unit_free, s[i] * std::abs(scaled));
    natural = std::max(natural, std::abs(plain));
  }
  const double worst = std::max(natural / (1.0 + q_inf), unit_free / (q_inf > 0.0 ? q_inf : 1.0));
  if (!x_.allFinite() || !std::isfinite(worst)) {
    return kInfinity;
  }
  if (worst < best_residual_) {
    best_residual_ = worst;
    best_x_ = x_;
  }
  return worst;
}

Status Apgd::Workspace::descend(const Problem& problem, const ApgdSettings& settings,
                                const Vector* warm_start, const Deadline& deadline,
                                Result& result) {
  const Index n = rows_.rows();
  warm_start != nullptr ? x_ = warm_start->cwiseProduct(rows_.scale()) : x_.setZero(n);
  x_ = x_.cwiseMax(lower_).cwiseMin(upper_);
  best_x_ = x_;
  best_residual_ = kInfinity;
  double lipschitz =
      std::max(settings.lipschitz_margin * largest_eigenvalue(settings.power_iterations),
               std::numeric_limits<double>::min());
  y_ = x_;
  double theta = 1.0;
  const int most =
      settings.max_iterations >= 0 ? settings.max_iterations : ApgdSettings::kDefaultIterations;
  for (int done = 0;; ++done) {
    result.statistics.iterations = done;
    if (done % settings.check_period == 0 || done == most) {
      const double residual = look(problem);
      if (residual <= settings.tolerance) {
        return Status::kSolved;
      }
      if (residual == kInfinity) {
        result.detail = "a number overflowed";
        return Status::kNumericalBreakdown;
      }
      if (deadline.passed()) {
        return Status::kTimeLimit;
      }
    }
    if (done == most) {
      return Status::kIterationLimit;
    }
    gradient(y_, slope_);
    next_ = (y_ - slope_ / lipschitz).cwiseMax(lower_).cwiseMin(upper_);
    // With d = next - y, the model f(y) + slope.d + L/2 |d|^2 must not lie below f(next):
    // d.(G G^T + C) d <= L |d|^2.
    y_ = next_ - y_;  // d, from here on
    rows_.transpose_times(y_, u_);
    const double curvature = u_.squaredNorm() + y_.dot(rows_.compliance().cwiseProduct(y_));
    const double length = y_.squaredNorm();
    if (curvature > lipschitz * length) {
      lipschitz *= 2.0;
      y_ = x_;
      theta = 1.0;
      continue;
    }
    const bool uphill = -y_.dot(next_ - x_) > 0.0;  // the generalised gradient is -L d
    if (uphill) {
      theta = 1.0;
      x_.swap(next_);
      y_ = x_;
      continue;
    }
    const double next_theta =
        0.5 * (std::sqrt(theta * theta * (theta * theta + 4.0)) - theta * theta);
    const double momentum = theta * (1.0 - theta) / (theta * theta + next_theta);
    theta = next_theta;
    y_ = next_ + momentum * (next_ - x_);
    x_.swap(next_);
  }
}

void ApgdSettings::validate() const {
  SolverSettings::validate();
  if (power_iterations < 1) {
    throw std::invalid_argument("settings: power_iterations: must be >= 1, got " +
                                std::to_string(power_iterations));
  }
  if (!(lipschitz_margin >= 1.0) || !std::isfinite(lipschitz_margin)) {
    throw std::invalid_argument("settings: lipschitz_margin: must be finite and >= 1, got " +
                                std::to_string(lipschitz_margin));
  }
  if (check_period < 1) {
    throw std::invalid_argument("settings: check_period: must be >= 1, got " +
                                std::to_string(check_period));
  }
}

Apgd::Apgd(const ApgdSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>()) {
  settings_.validate();
}

Apgd::~Apgd() = default;

std::string Apgd::refuses(const Problem& problem) const {
  if (!std::holds_alternative<FactoredMatrix>(problem.M)) {
    return "takes a factored matrix A = J W J^T; this M is given whole";
  }
  if (!problem.cones.empty()) {
    return "takes no friction cones";
  }
  return problem.limits.empty() ? ""
                                : "takes no coupled limits; row " +
                                      std::to_string(problem.limits.front().row) + " has one";
}

Status Apgd::iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                     Result& result) {
  return workspace_->solve(problem, settings_, warm_start, deadline, result);
}

}  // namespace signorini::lcp
