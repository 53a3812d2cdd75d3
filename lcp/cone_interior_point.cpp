#include <signorini/lcp/alart_curnier.h>
#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/cone_barrier.h>
#include <signorini/lcp/cone_interior_point.h>
#include <signorini/lcp/number_text.h>
#include <signorini/lcp/scaled_groups.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

namespace signorini::lcp {

class ConeInteriorPoint::Workspace {
 public:
  explicit Workspace(const ConeInteriorPointSettings& settings) : settings_(settings) {}

  Status solve(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
               Result& result);

 private:
  void start(const Problem& problem);
  [[nodiscard]] Status follow_path(const Deadline& deadline, Statistics& statistics);
  [[nodiscard]] bool step(double tau);
  [[nodiscard]] bool find_directions();
  [[nodiscard]] double gap_after(double step) const;
  [[nodiscard]] double longest_step() const;
  [[nodiscard]] bool solved() {
    return is_solved(judge(best_.certificate(), settings_.tolerance, Status::kStalled));
  }
  [[nodiscard]] Status polish(const Problem& problem, const Deadline& deadline,
                              Statistics& statistics);

  ConeInteriorPointSettings settings_;
  ScaledGroups groups_;
  BestIterate best_;
  int products_ = 0;
  double left_ = 1.0;  // of what the start missed of the linear equations
  std::vector<ConeBarrier> barriers_;
  std::vector<AlartCurnierFunction::Block> A_, B_;
  std::vector<AlartCurnierFunction::Coupling> no_couplings_;
  Vector x_, u_, F_, dx_, du_, z_;
  std::unique_ptr<AlartCurnier> polisher_;
  Result polished_;
};

void ConeInteriorPoint::Workspace::start(const Problem& problem) {
  constexpr double kMargin = 1.0;  // of |b|_inf = 1; less costs piles short steps
  groups_.set(problem);
  const auto& groups = groups_.function().groups();
  barriers_.resize(groups.size());
  A_.resize(groups.size());
  B_.resize(groups.size());
  products_ = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    barriers_[g].start(groups[g], groups_.b().data() + groups[g].first, kMargin,
                       problem.friction_law == FrictionLaw::kCoulomb);
    products_ += barriers_[g].count();
  }
  x_.resize(problem.size());
  F_.resize(problem.size());
}

double ConeInteriorPoint::Workspace::gap_after(double step) const {
  double sum = 0.0;
  for (const ConeBarrier& barrier : barriers_) {
    sum += barrier.gap_after(step);
  }
  return sum;
}

double ConeInteriorPoint::Workspace::longest_step() const {
  double step = std::numeric_limits<double>::infinity();
  for (const ConeBarrier& barrier : barriers_) {
    step = std::min(step, barrier.longest_step());
  }
  return step;
}

/// The directions for the right-hand sides at hand, with the factor at hand.
bool ConeInteriorPoint::Workspace::find_directions() {
  const auto& groups = groups_.function().groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    barriers_[g].right_side(B_[g], F_.data() + groups[g].first);
  }
  if (!groups_.solve(F_, dx_)) {
    return false;
  }
  groups_.multiply(dx_, du_);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    barriers_[g].follow(dx_.data() + groups[g].first, du_.data() + groups[g].first);
  }
  return true;
}

/// Mehrotra's predictor and corrector. @return false if the system is singular.
bool ConeInteriorPoint::Workspace::step(double tau) {
  constexpr double kProximal = 1e-13;  // keeps free rows' blocks invertible
  for (std::size_t g = 0; g < barriers_.size(); ++g) {
    barriers_[g].derive(A_[g], B_[g]);
  }
  if (!groups_.factor(A_, B_, no_couplings_, kProximal)) {
    return false;
  }
  for (ConeBarrier& barrier : barriers_) {
    barrier.predict();
  }
  if (!find_directions()) {
    return false;
  }
  if (products_ > 0) {
    const double affine = std::min(1.0, longest_step());
    const double after = std::max(gap_after(affine) / products_, 0.0);
    const double target = tau * std::min(1.0, std::pow(after / tau, 3));  // Mehrotra
    for (ConeBarrier& barrier : barriers_) {
      barrier.correct(target);
    }
    if (!find_directions()) {
      return false;
    }
  }
  const double length = std::min(1.0, settings_.step_fraction * longest_step());
  left_ *= 1.0 - length;
  for (ConeBarrier& barrier : barriers_) {
    barrier.move(length);
  }
  return true;
}

Status ConeInteriorPoint::Workspace::follow_path(const Deadline& deadline, Statistics& statistics) {
  constexpr int kMostWithoutProgress = 8;
  constexpr double kProgress = 0.9;
  // While more than this of the start's error is left (but for Coulomb's shift, which is not
  // linear), the gap may grow: loads build up.
  constexpr double kMuchLeft = 0.01;
  const int most = settings_.max_iterations >= 0 ? settings_.max_iterations
                                                 : ConeInteriorPointSettings::kDefaultIterations;
  const auto& groups = groups_.function().groups();
  double least_tau = std::numeric_limits<double>::infinity();
  double least_left = std::numeric_limits<double>::infinity();
  left_ = 1.0;
  for (int without_progress = 0;; ++statistics.iterations) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      barriers_[g].get(x_.data() + groups[g].first);
    }
    groups_.to_caller(x_, z_);
    best_.offer(z_);
    const double tau = products_ > 0 ? gap_after(0.0) / products_ : 0.0;
    const bool nearer = left_ > kMuchLeft && left_ < kProgress * least_left;
    without_progress = nearer || tau < kProgress * least_tau ? 0 : without_progress + 1;
    least_tau = std::min(tau, least_tau);
    least_left = nearer ? left_ : least_left;
    if (solved() || without_progress > kMostWithoutProgress) {
      return Status::kStalled;
    }
    if (statistics.iterations >= most) {
      return Status::kIterationLimit;
    }
    if (deadline.passed()) {
      return Status::kTimeLimit;
    }
    groups_.multiply(x_, u_);
    u_ += groups_.b();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      barriers_[g].set_residual(u_.data() + groups[g].first);
    }
    ++statistics.factorizations;
    if (!step(tau)) {
      return Status::kNumericalBreakdown;
    }
  }
}

/// Alart-Curnier from the best iterate.
Status ConeInteriorPoint::Workspace::polish(const Problem& problem, const Deadline& deadline,
                                            Statistics& statistics) {
  const double time_left = deadline.left_seconds();
  if (!(time_left > 0.0)) {
    return Status::kTimeLimit;
  }
  if (polisher_ == nullptr) {
    AlartCurnierSettings settings;
    static_cast<SolverSettings&>(settings) = settings_;
    settings.recorder = nullptr;
    settings.certify_islands = false;
    settings.quick_certificate = true;
    settings.max_iterations = settings_.polish_steps;
    settings.proximal = 1e-6;
    polisher_ = std::make_unique<AlartCurnier>(settings);
  }
  z_ = best_.z();
  polisher_->solve_within(time_left, problem, polished_, &z_);
  best_.offer(polished_.z);
  statistics.factorizations += polished_.statistics.factorizations;
  statistics.factor_bytes = std::max(statistics.factor_bytes, polished_.statistics.factor_bytes);
  return is_solved(polished_.status) ? Status::kStalled : polished_.status;
}

Status ConeInteriorPoint::Workspace::solve(const Problem& problem, const Vector* warm_start,
                                           const Deadline& deadline, Result& result) {
  result.statistics = {.iterations = 0, .factorizations = 0, .factor_bytes = 0};
  best_.reset(problem, settings_.tolerance);
  if (warm_start != nullptr) {
    best_.offer(*warm_start);
  }
  Status ending = Status::kStalled;
  if (!solved()) {
    start(problem);
    ending = follow_path(deadline, result.statistics);
    result.statistics.factor_bytes = groups_.factor_bytes();
  }
  const bool limited = ending == Status::kTimeLimit ||
                       (ending == Status::kIterationLimit && settings_.max_iterations >= 0);
  if (!solved() && !limited && settings_.polish_steps > 0) {
    ending = polish(problem, deadline, result.statistics);
  }
  result.z = best_.z();
  return ending;
}

void ConeInteriorPointSettings::validate() const {
  SolverSettings::validate();
  if (polish_steps < 0) {
    throw std::invalid_argument("settings: polish_steps: must be >= 0, got " +
                                std::to_string(polish_steps));
  }
  if (!(step_fraction > 0.0 && step_fraction < 1.0)) {
    throw std::invalid_argument("settings: step_fraction: must be in (0, 1), got " +
                                number_text(step_fraction));
  }
}

ConeInteriorPoint::ConeInteriorPoint(const ConeInteriorPointSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>(settings)) {
  settings_.validate();
}

ConeInteriorPoint::~ConeInteriorPoint() = default;

std::string ConeInteriorPoint::refuses(const Problem& problem) const {
  return problem.limits.empty() ? ""
                                : "takes no coupled limits; row " +
                                      std::to_string(problem.limits.front().row) + " has one";
}

Status ConeInteriorPoint::iterate(const Problem& problem, const Vector* warm_start,
                                  const Deadline& deadline, Result& result) {
  return workspace_->solve(problem, warm_start, deadline, result);
}

}  // namespace signorini::lcp
