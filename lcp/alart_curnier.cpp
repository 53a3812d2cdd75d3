#include <signorini/lcp/alart_curnier.h>
#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/number_text.h>
#include <signorini/lcp/scaled_groups.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kSmallestAlpha = 1e-12;
constexpr double kLargestAlpha = 1e3;
constexpr double kFinestTolerance = 1e-15;
// What alpha falls to after an inner iteration, by its steps: it went well with two, and without
// all it may take.
constexpr int kFewSteps = 2;
constexpr double kFastFall = 0.1;
constexpr double kFall = 0.3;
constexpr double kSlowFall = 0.5;
constexpr double kRise = 3.0;
constexpr double kAboveFailed = 2.0;  // where alpha goes at first, of the last that failed
constexpr double kForgets = 0.5;      // of that, a step
constexpr double kStrictness = 1e-2;  // of an inner iteration, of the error before it
// What a proximal step must leave of the best error to help, and how many may not before a start
// is given up for 0.
constexpr double kHelps = 0.9;
constexpr int kPatience = 20;
constexpr int kMostStalled = 3;  // iterations with the largest alpha that failed

}  // namespace

class AlartCurnier::Workspace {
 public:
  Status solve(const Problem& problem, const AlartCurnierSettings& settings,
               const Vector* warm_start, const Deadline& deadline, Result& result);

 private:
  struct Inner {
    bool converged;
    int steps;
  };
  Inner newton(const AlartCurnierSettings& settings, double alpha, double error, double tolerance);
  double evaluate(double alpha, const Vector& x);
  double violation();
  [[nodiscard]] bool solved() {
    return is_solved(judge(best_.certificate(), tolerance_, Status::kStalled));
  }
  [[nodiscard]] bool exhausted() const {
    return *factorizations_ >= most_steps_ || deadline_->passed();
  }
  double error_of(const Vector& x);
  void finish(Result& result) const {
    result.z = best_.z();
    result.statistics.factor_bytes = groups_.factor_bytes();
  }

  const Deadline* deadline_ = nullptr;
  int* factorizations_ = nullptr;
  int most_steps_ = 0;
  double tolerance_ = 0.0;
  double rho_ = 1.0;  // of the line search
  ScaledGroups groups_;
  BestIterate best_;
  Vector x_, anchor_, trial_, u_, F_, natural_, dx_, z_, least_x_;
  std::vector<AlartCurnierFunction::Block> A_, B_;
  std::vector<AlartCurnierFunction::Coupling> couplings_;
};

double AlartCurnier::Workspace::error_of(const Vector& x) {
  groups_.to_caller(x, z_);
  return BestIterate::merit(best_.offer(z_));
}

/// F_ at x, with u_. @return |F|.
double AlartCurnier::Workspace::evaluate(double alpha, const Vector& x) {
  groups_.multiply(x, u_);
  u_ += groups_.b() + alpha * (x - anchor_);
  groups_.function().evaluate(x, u_, rho_, F_);
  return F_.norm();
}

/// The largest entry of F at x_ and u_ for rho = 1, whatever that of the line search.
double AlartCurnier::Workspace::violation() {
  groups_.function().evaluate(x_, u_, 1.0, natural_);
  return natural_.cwiseAbs().maxCoeff();
}

/// Newton from x_, whose u_ and F_ it leaves at the best point it saw.
///
/// A step along what only alpha holds (redundant contacts) moves x by 1/alpha of what it moves u
/// by, so that |F| for rho = 1 sees x alone and lets almost no full step pass. rho = alpha^-1/2 is
/// half way between the scales of the two kinds of motion; from a start with an error larger than
/// alpha it would take what pushes for what has come apart.
AlartCurnier::Workspace::Inner AlartCurnier::Workspace::newton(const AlartCurnierSettings& settings,
                                                               double alpha, double error,
                                                               double tolerance) {
  constexpr double kSmallestStep = 0.5;
  constexpr double kArmijo = 1e-4;
  std::array<double, 4> recent{};
  rho_ = 1.0 / std::sqrt(std::max(alpha, std::min(1.0, error)));
  double size = evaluate(alpha, x_);
  recent.fill(size);
  double least = size;
  least_x_ = x_;
  int step = 0;
  for (; step < settings.inner_steps && !exhausted(); ++step) {
    if (violation() <= tolerance) {
      return {true, step};
    }
    groups_.function().differentiate(x_, u_, rho_, A_, B_, couplings_);
    ++*factorizations_;
    if (!groups_.factor(A_, B_, couplings_, alpha) || !groups_.solve(F_, dx_)) {
      break;
    }
    const double reference = *std::max_element(recent.begin(), recent.end());
    double t = 1.0;
    for (;; t *= 0.5) {
      trial_ = x_ + t * dx_;
      size = evaluate(alpha, trial_);
      if (size <= (1.0 - kArmijo * t) * reference || t <= kSmallestStep) {
        break;
      }
    }
    if (!std::isfinite(size)) {
      break;
    }
    x_.swap(trial_);
    recent[step % recent.size()] = size;
    if (size < least) {
      least = size;
      least_x_ = x_;
    }
  }
  x_ = least_x_;
  evaluate(alpha, x_);
  return {violation() <= tolerance, step};
}

Status AlartCurnier::Workspace::solve(const Problem& problem, const AlartCurnierSettings& settings,
                                      const Vector* warm_start, const Deadline& deadline,
                                      Result& result) {
  result.statistics = {.iterations = 0, .factorizations = 0, .factor_bytes = 0};
  deadline_ = &deadline;
  factorizations_ = &result.statistics.factorizations;
  most_steps_ =
      settings.max_iterations >= 0 ? settings.max_iterations : AlartCurnierSettings::kDefaultSteps;
  tolerance_ = settings.tolerance;
  best_.reset(problem, settings.tolerance);
  groups_.set(problem);
  x_.setZero(problem.size());
  if (warm_start != nullptr) {
    groups_.from_caller(*warm_start, x_);
  }
  double alpha = settings.proximal;
  double error = error_of(x_);
  double strictness = kStrictness;
  int stalled = 0;
  double failed = 0.0;  // alpha
  double least = error;
  int without = 0;
  bool has_start = !x_.isZero(0.0);
  while (!solved() && !exhausted()) {
    anchor_ = x_;
    const double tolerance = std::max(strictness < kStrictness ? kFinestTolerance : 1e-13,
                                      strictness * std::min(1.0, error));
    const Inner inner = newton(settings, alpha, error, tolerance);
    if (++result.statistics.iterations >= most_steps_) {
      most_steps_ = 0;  // a proximal step counts at least as one
    }
    bool is_stuck = false;
    if (inner.steps == 0 && inner.converged) {  // F's units hide an error that the certificate sees
      is_stuck = tolerance <= kFinestTolerance;
      strictness *= 1e-3;
    }
    const double after = error_of(x_);
    const bool helped = after < kHelps * least;
    least = helped ? after : least;
    without = helped ? 0 : without + 1;
    is_stuck = is_stuck || (has_start && without >= kPatience);
    const bool is_near = helped && violation() <= std::max(1e-12, 0.1 * error);
    if (!is_stuck && (inner.converged || is_near)) {
      // Where proximal points lead away, only the problem itself is of use.
      const double lowest = after > error ? 0.0 : kAboveFailed * failed;
      const double fallen = alpha * (inner.steps <= kFewSteps             ? kFastFall
                                     : inner.steps < settings.inner_steps ? kFall
                                                                          : kSlowFall);
      alpha = std::min(alpha, std::max({fallen, lowest, kSmallestAlpha}));
      failed = after > error ? 0.0 : kForgets * failed;
      error = after;
      stalled = 0;
      continue;
    }
    is_stuck = is_stuck || (alpha >= kLargestAlpha && ++stalled > kMostStalled);
    if (!is_stuck) {
      if (after > error) {
        x_ = anchor_;
      }
      error = std::min(error, after);
      failed = alpha;
      alpha = std::min(kRise * alpha, kLargestAlpha);
      continue;
    }
    if (!has_start) {
      finish(result);
      return Status::kStalled;
    }
    has_start = false;
    x_.setZero();
    error = least = error_of(x_);
    alpha = std::max(settings.proximal, AlartCurnierSettings().proximal);
    strictness = kStrictness;
    stalled = 0;
    failed = 0.0;
  }
  finish(result);
  return deadline.passed() ? Status::kTimeLimit
                           : (solved() ? Status::kStalled : Status::kIterationLimit);
}

void AlartCurnierSettings::validate() const {
  SolverSettings::validate();
  if (!(proximal > 0.0) || !std::isfinite(proximal)) {
    throw std::invalid_argument("settings: proximal: must be > 0, got " + number_text(proximal));
  }
  if (inner_steps < 1) {
    throw std::invalid_argument("settings: inner_steps: must be >= 1, got " +
                                std::to_string(inner_steps));
  }
}

AlartCurnier::AlartCurnier(const AlartCurnierSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>()) {
  settings_.validate();
}

AlartCurnier::~AlartCurnier() = default;

std::string AlartCurnier::refuses(const Problem&) const {
  return {};
}

Status AlartCurnier::iterate(const Problem& problem, const Vector* warm_start,
                             const Deadline& deadline, Result& result) {
  return workspace_->solve(problem, settings_, warm_start, deadline, result);
}

}  // namespace signorini::lcp
