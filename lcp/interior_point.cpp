#include <signorini/lcp/interior_point.h>
#include <signorini/lcp/sparse_cholesky.h>
#include <signorini/lcp/whitened_rows.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The largest step in [0, 1] that keeps v + step dv >= 0.
double step_to_boundary(const Vector& v, const Vector& dv) {
  double step = 1.0;
  for (Index i = 0; i < v.size(); ++i) {
    if (dv[i] < 0.0) {
      step = std::min(step, -v[i] / dv[i]);
    }
  }
  return step;
}

}  // namespace

/// The problem in whitened coordinates and everything that changes during a solve.
class InteriorPoint::Workspace {
 public:
  explicit Workspace(const InteriorPointSettings& settings) : settings_(settings) {}

  Status solve(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
               Result& result) {
    problem_ = &problem;
    deadline_ = &deadline;
    statistics_ = &result.statistics;
    *statistics_ = {.iterations = 0, .factorizations = 0};
    rows_.set(std::get<FactoredMatrix>(problem.M));
    g_ = problem.q.cwiseQuotient(rows_.scale());
    set_tolerances(problem);
    d_.setZero(rows_.rows());
    cholesky_->analyse(rows_.body_space_matrix(d_));
    best_residual_ = kInfinity;
    start(warm_start);
    Status ending = interior_point();
    polish(ending);
    result.z = best_x_.cwiseQuotient(rows_.scale());
    return ending;
  }

 private:
  void set_tolerances(const Problem& problem);
  void start(const Vector* warm_start);
  Status interior_point();
  [[nodiscard]] bool newton_direction(const Vector& target);
  void polish(Status& ending);
  [[nodiscard]] bool proximal_step(Vector& x);
  void dual_gradient(const Vector& u, Vector& gradient);
  double line_search(const Vector& direction);
  double consider(const Vector& x);
  [[nodiscard]] bool factor();

  InteriorPointSettings settings_;
  const Problem* problem_ = nullptr;
  const Deadline* deadline_ = nullptr;
  Statistics* statistics_ = nullptr;
  std::unique_ptr<SparseCholesky> cholesky_ = make_sparse_cholesky();
  WhitenedRows rows_;
  double natural_scale_ = 1.0;
  double unit_free_scale_ = 1.0;

  Vector g_, x_, y_, r_;  // the problem, the iterate, r = A x + g - y
  Vector d_, h_, u_, dx_, dy_, gdu_;
  Vector dx_affine_, dy_affine_;
  Vector best_x_;
  double best_residual_ = kInfinity;
  // polish
  Vector point_, base_slack_, weight_, velocity_, slack_, change_, gradient_, direction_,
      g_direction_;
  std::vector<std::pair<double, Index>> breaks_;
};

void InteriorPoint::Workspace::set_tolerances(const Problem& problem) {
  const double q_inf = problem.q.cwiseAbs().maxCoeff();
  natural_scale_ = 1.0 + q_inf;
  unit_free_scale_ = q_inf > 0.0 ? q_inf : 1.0;
}

void InteriorPoint::Workspace::start(const Vector* warm_start) {
  const Index n = rows_.rows();
  const double size = std::max(g_.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  if (warm_start == nullptr) {
    x_ = (-g_).cwiseMax(0.0).array() + 0.1 * size;
    y_ = g_.cwiseMax(0.1 * size);
    return;
  }
  x_ = warm_start->cwiseProduct(rows_.scale()).cwiseMax(0.0);
  consider(x_);
  rows_.transpose_times(x_, u_);
  rows_.times(u_, y_);
  y_ += rows_.compliance().cwiseProduct(x_) + g_;
  const double rms = std::sqrt(x_.cwiseMin(y_).squaredNorm() / static_cast<double>(n));
  const double floor = std::max(rms, 1e-10 * size);
  x_ = x_.cwiseMax(floor);
  y_ = y_.cwiseMax(floor);
}

/// The residuals of x in the certificate's terms, in double: the larger one. Keeps the best
/// iterate.
double InteriorPoint::Workspace::consider(const Vector& x) {
  rows_.transpose_times(x, velocity_);
  rows_.times(velocity_, slack_);
  slack_ += rows_.compliance().cwiseProduct(x) + g_;
  const Vector& s = rows_.scale();
  double natural = 0.0;
  double unit_free = 0.0;
  for (Index i = 0; i < x.size(); ++i) {
    unit_free = std::max(unit_free, s[i] * std::abs(std::min(x[i], slack_[i])));
    natural = std::max(natural, std::abs(std::min(x[i] / s[i], s[i] * slack_[i])));
  }
  const double worst = std::max(natural / natural_scale_, unit_free / unit_free_scale_);
  if (!(x.allFinite() && std::isfinite(worst))) {
    return kInfinity;  // a NaN must never look like a small residual
  }
  if (worst < best_residual_) {
    best_residual_ = worst;
    best_x_ = x;
  }
  return worst;
}

bool InteriorPoint::Workspace::factor() {
  ++statistics_->factorizations;
  return cholesky_->factor(rows_.body_space_matrix(d_));
}

/// dx, dy of (A + Y/X) dx = -r + target / x, y dx + x dy = target, with the factor of H(d_).
bool InteriorPoint::Workspace::newton_direction(const Vector& target) {
  h_ = target.cwiseQuotient(x_) - r_;
  gdu_ = d_.cwiseProduct(h_);
  rows_.transpose_times(gdu_, u_);
  cholesky_->solve(u_);
  rows_.times(u_, gdu_);
  dx_ = d_.cwiseProduct(h_ - gdu_);
  dy_ = (target - y_.cwiseProduct(dx_)).cwiseQuotient(x_);
  return dx_.allFinite() && dy_.allFinite();
}

Status InteriorPoint::Workspace::interior_point() {
  const double n = static_cast<double>(rows_.rows());
  const int most = settings_.max_iterations >= 0 ? settings_.max_iterations
                                                 : InteriorPointSettings::kDefaultIterations;
  // The polish gains from any start that is a little better than this.
  const double good_enough = std::max(settings_.tolerance, 1e-9);
  double least_mu = kInfinity;
  double least_infeasibility = kInfinity;
  constexpr int kMostWithoutProgress = 25;  // far starts rise before they fall
  int without_progress = 0;
  if (best_x_.size() != x_.size()) {
    best_x_.setZero(x_.size());
  }
  consider(Vector::Zero(x_.size()));
  for (;; ++statistics_->iterations) {
    const double residual = consider(x_);
    if (best_residual_ <= good_enough && residual <= good_enough) {
      return Status::kSolved;
    }
    if (statistics_->iterations == most) {
      return Status::kIterationLimit;
    }
    if (deadline_->passed()) {
      return Status::kTimeLimit;
    }
    const double mu = x_.dot(y_) / n;
    r_ = slack_ - y_;
    const double infeasibility = r_.cwiseAbs().maxCoeff();
    const bool progress = mu < 0.9 * least_mu || infeasibility < 0.9 * least_infeasibility;
    without_progress = progress ? 0 : without_progress + 1;
    least_mu = std::min(mu, least_mu);
    least_infeasibility = std::min(infeasibility, least_infeasibility);
    if (without_progress > kMostWithoutProgress || !(mu > 0.0)) {
      return Status::kStalled;
    }
    d_ = x_.cwiseQuotient(
        y_ + (rows_.compliance().array() + settings_.proximal).matrix().cwiseProduct(x_));
    if (!factor() || !newton_direction(-x_.cwiseProduct(y_))) {
      return Status::kNumericalBreakdown;
    }
    dx_affine_ = dx_;
    dy_affine_ = dy_;
    const double affine = std::min(step_to_boundary(x_, dx_), step_to_boundary(y_, dy_));
    const double mu_affine = (x_ + affine * dx_).dot(y_ + affine * dy_) / n;
    const double sigma = std::pow(mu_affine / mu, 3);
    const Vector target =
        (-x_.array() * y_.array() - dx_affine_.array() * dy_affine_.array() + sigma * mu).matrix();
    if (!newton_direction(target)) {
      return Status::kNumericalBreakdown;
    }
    const double step =
        settings_.step_fraction * std::min(step_to_boundary(x_, dx_), step_to_boundary(y_, dy_));
    x_ += step * dx_;
    y_ += step * dy_;
  }
}

/// The rows' answer change_ to the velocity increment u, and phi's gradient u - G^T change.
/// Everything is an increment to point_, whose slack is base_slack_: nothing large cancels.
void InteriorPoint::Workspace::dual_gradient(const Vector& u, Vector& gradient) {
  rows_.times(u, slack_);
  slack_ += base_slack_;
  change_ = (-slack_.array() / weight_.array()).max(-point_.array());
  rows_.transpose_times(change_, gradient);
  gradient = u - gradient;
}

/// The exact minimum of phi(velocity_ + t direction) over t >= 0: the derivative is increasing and
/// piecewise linear, with a break wherever a row enters or leaves. @pre dual_gradient(velocity_).
double InteriorPoint::Workspace::line_search(const Vector& direction) {
  rows_.times(direction, g_direction_);
  double slope = direction.squaredNorm();
  double derivative = velocity_.dot(direction) - change_.dot(g_direction_);
  breaks_.clear();
  for (Index i = 0; i < rows_.rows(); ++i) {
    const double value = point_[i] - slack_[i] / weight_[i];
    const double rate = -g_direction_[i] / weight_[i];
    if (value > 0.0) {
      slope += weight_[i] * rate * rate;
    }
    if ((value > 0.0 && rate < 0.0) || (value <= 0.0 && rate > 0.0)) {
      breaks_.emplace_back(-value / rate, i);
    }
  }
  std::sort(breaks_.begin(), breaks_.end());
  double at = 0.0;
  for (const auto& [t, i] : breaks_) {
    if (derivative + slope * (t - at) >= 0.0) {
      break;
    }
    derivative += slope * (t - at);
    at = t;
    const double rate = -g_direction_[i] / weight_[i];
    slope += rate > 0.0 ? weight_[i] * rate * rate : -weight_[i] * rate * rate;
  }
  return at - derivative / slope;
}

/// x <- the proximal point's answer. @return false if it could not be found.
bool InteriorPoint::Workspace::proximal_step(Vector& x) {
  constexpr int kMostNewtonSteps = 30;
  point_ = x;
  rows_.transpose_times(x, velocity_);
  rows_.times(velocity_, base_slack_);
  base_slack_ += rows_.compliance().cwiseProduct(x) + g_;
  velocity_.setZero();
  double last = kInfinity;
  for (int step = 0;; ++step) {
    dual_gradient(velocity_, gradient_);
    const double size = gradient_.cwiseAbs().maxCoeff();
    const double enough = 1e-14 * (velocity_.cwiseAbs().maxCoeff() + change_.cwiseAbs().maxCoeff());
    if (!std::isfinite(size)) {
      return false;
    }
    if (size <= enough || step == kMostNewtonSteps || (step > 3 && size >= last)) {
      break;
    }
    last = size;
    for (Index i = 0; i < rows_.rows(); ++i) {
      d_[i] = change_[i] > -point_[i] ? 1.0 / weight_[i] : 0.0;
    }
    if (!factor()) {
      return false;
    }
    direction_ = -gradient_;
    cholesky_->solve(direction_);
    const double t = line_search(direction_);
    if (!std::isfinite(t)) {
      return false;
    }
    velocity_ += t * direction_;
  }
  x = (point_ + change_).cwiseMax(0.0);
  return true;
}

void InteriorPoint::Workspace::polish(Status& ending) {
  constexpr double kWorthPolishing = 1e-4;  // from a worse start the active set is a guess
  if (!(best_residual_ <= kWorthPolishing)) {
    return;
  }
  weight_ = rows_.compliance().array() + settings_.polish_proximal;
  Vector x = best_x_;
  double before = best_residual_;
  for (int step = 0; step < settings_.max_polish_steps && !deadline_->passed(); ++step) {
    if (!proximal_step(x)) {
      break;
    }
    const double after = consider(x);
    if (after > 0.5 * before || best_residual_ <= 0.01 * settings_.tolerance) {
      break;
    }
    before = after;
  }
  if (ending == Status::kSolved) {
    ending = Status::kStalled;  // only the certificate says solved
  }
}

void InteriorPointSettings::validate() const {
  SolverSettings::validate();
  if (!(proximal >= 0.0)) {
    throw std::invalid_argument("settings: proximal: must be >= 0, got " +
                                std::to_string(proximal));
  }
  if (!(step_fraction > 0.0 && step_fraction < 1.0)) {
    throw std::invalid_argument("settings: step_fraction: must be in (0, 1), got " +
                                std::to_string(step_fraction));
  }
  if (!(polish_proximal > 0.0)) {
    throw std::invalid_argument("settings: polish_proximal: must be > 0, got " +
                                std::to_string(polish_proximal));
  }
  if (max_polish_steps < 0) {
    throw std::invalid_argument("settings: max_polish_steps: must be >= 0, got " +
                                std::to_string(max_polish_steps));
  }
}

InteriorPoint::InteriorPoint(const InteriorPointSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>(settings)) {
  settings_.validate();
}

InteriorPoint::~InteriorPoint() = default;

std::string InteriorPoint::refuses(const Problem& problem) const {
  if (!std::holds_alternative<FactoredMatrix>(problem.M)) {
    return "takes a factored matrix A = J W J^T; this M is given whole";
  }
  return problem.is_lcp() ? "" : "takes an LCP; this problem has bounds, free or coupled rows";
}

Status InteriorPoint::iterate(const Problem& problem, const Vector* warm_start,
                              const Deadline& deadline, Result& result) {
  return workspace_->solve(problem, warm_start, deadline, result);
}

}  // namespace signorini::lcp
