#include <signorini/lcp/active_set_newton.h>
#include <signorini/lcp/body_space_system.h>
#include <signorini/lcp/interior_point.h>
#include <signorini/lcp/mass_ratio.h>
#include <signorini/lcp/nncg.h>
#include <signorini/lcp/number_text.h>
#include <signorini/lcp/proximal_newton.h>
#include <signorini/lcp/scaled_problem.h>
#include <signorini/lcp/smoothing_newton.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A slack s >= 0 of one bound of every row and its multiplier y >= 0, s_i y_i -> 0. Rows without
/// the bound have s = 1, y = 0 and do not move.
class Barrier {
 public:
  void set(const Vector& has_bound) {
    has_ = has_bound;
    count_ = has_bound.sum();
  }
  Vector s, y, ds, dy;

  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] const Vector& has() const { return has_; }
  [[nodiscard]] double gap() const { return s.cwiseProduct(has_).dot(y); }
  /// The gap after a step.
  [[nodiscard]] double gap_after(double step) const {
    double sum = 0.0;
    for (Index i = 0; i < s.size(); ++i) {
      sum += has_[i] * (s[i] + step * ds[i]) * (y[i] + step * dy[i]);
    }
    return sum;
  }
  /// The right-hand side c of s dy + y ds = c: Mehrotra's corrector for the directions at hand.
  void correct(double target) {
    c_ = has_.array() * (target - s.array() * y.array() - ds.array() * dy.array());
  }
  /// Adds what brings the products at a step towards a tenth to ten times the target (Gondzio).
  void centre(double step, double target) {
    for (Index i = 0; i < s.size(); ++i) {
      const double product = (s[i] + step * ds[i]) * (y[i] + step * dy[i]);
      const double wanted = std::clamp(product, 0.1 * target, 10.0 * target);
      c_[i] += has_[i] * std::max(wanted - product, -10.0 * target);
    }
  }
  /// The directions at hand and their right-hand side, to come back to.
  void keep() {
    kept_ds_ = ds;
    kept_dy_ = dy;
  }
  void restore() {
    ds.swap(kept_ds_);
    dy.swap(kept_dy_);
  }
  /// The same without corrector and target.
  void predict() { c_ = -s.cwiseProduct(y); }
  [[nodiscard]] const Vector& right_side() const { return c_; }
  /// The directions for ds.
  void follow(const Vector& dx, double sign) {
    ds = sign * has_.cwiseProduct(dx);
    dy = (c_ - y.cwiseProduct(ds)).cwiseQuotient(s);
  }
  /// The largest step in [0, 1] that keeps s and y >= 0.
  [[nodiscard]] double longest_step() const {
    double step = 1.0;
    for (Index i = 0; i < s.size(); ++i) {
      if (ds[i] < 0.0) {
        step = std::min(step, -s[i] / ds[i]);
      }
      if (dy[i] < 0.0) {
        step = std::min(step, -y[i] / dy[i]);
      }
    }
    return step;
  }
  void move(double step) {
    s += step * ds;
    y += step * dy;
  }

 private:
  Vector has_, c_, kept_ds_, kept_dy_;
  double count_ = 0.0;
};

/// Whether the iterates still go anywhere, by the average product mu of slacks and multipliers and
/// by the largest |r_i|.
class Progress {
 public:
  /// @return false if nothing has fallen for too long, or only rounding is left to move the iterate
  [[nodiscard]] bool goes_on(double mu, double infeasibility, bool has_barriers) {
    constexpr int kMostWithout = 25;  // far starts rise before they fall
    // Where mu has fallen so far, products of slacks and multipliers are below the rounding of
    // their largest.
    constexpr double kLeastMu = 1e-24;
    const bool falls = mu < 0.9 * least_mu_ || infeasibility < 0.9 * least_infeasibility_;
    without_ = falls ? 0 : without_ + 1;
    least_mu_ = std::min(mu, least_mu_);
    most_mu_ = std::max(mu, most_mu_);
    least_infeasibility_ = std::min(infeasibility, least_infeasibility_);
    return without_ <= kMostWithout && !(has_barriers && !(mu > kLeastMu * most_mu_));
  }

 private:
  double least_mu_ = kInfinity;
  double most_mu_ = 0.0;
  double least_infeasibility_ = kInfinity;
  int without_ = 0;
};

}  // namespace

/// The problem in scaled coordinates and everything that changes during a solve.
class InteriorPoint::Workspace {
 public:
  explicit Workspace(const InteriorPointSettings& settings) : settings_(settings) {}

  Status solve(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
               Result& result) {
    deadline_ = &deadline;
    body_space_ = std::holds_alternative<FactoredMatrix>(problem.M);
    if (!body_space_ && given_ == nullptr) {
      given_ = make_given_matrix_system();
    }
    ShiftedSystem& system = body_space_ ? bodies_ : *given_;
    system.set(problem.M);
    problem_.set(problem, system);
    // Above this ratio the inside of what redundant rows leave open is found too slowly.
    are_alike_ = body_space_ && are_masses_alike(std::get<FactoredMatrix>(problem.M).mass);
    iterations_ = 0;
    sweeps_ = 0;
    const Status ending = run(problem, warm_start);
    if (sweeps_ > 0) {
      result.detail += "started from ";
      result.detail += std::to_string(sweeps_);
      result.detail += " sweeps";
    }
    if (proximal_ > settings_.proximal) {
      result.detail += result.detail.empty() ? "" : "; ";
      result.detail += "proximal term raised to " + number_text(proximal_) +
                       " where a factorisation failed (it changes the path, not the answer)";
    }
    problem_.best_z(result.z);
    result.statistics = {.iterations = iterations_,
                         .factorizations = system.factorizations(),
                         .factor_bytes = system.factorizations() > 0 ? system.factor_bytes() : 0};
    return ending;
  }

 private:
  static constexpr int kSweeps = 200;
  static constexpr int kWarmSweeps = 60;

  [[nodiscard]] Status run(const Problem& problem, const Vector* warm_start);
  [[nodiscard]] bool start_warm(const Vector& warm_start);
  [[nodiscard]] bool sweeps_are_cheap() const;
  [[nodiscard]] const Vector& sweep(const Problem& problem, const Vector* warm_start);
  [[nodiscard]] bool start_on_all_rows();
  void start_cold(double size_of_x);
  void set_barriers();
  [[nodiscard]] Status interior_point(bool cold);
  [[nodiscard]] Status predict_and_correct(double mu);
  [[nodiscard]] bool newton_direction();
  [[nodiscard]] bool factor();
  int guess_set();
  [[nodiscard]] bool approach_by_smoothing();
  [[nodiscard]] bool try_set();
  [[nodiscard]] bool cross_over(double residual, bool has_grown);
  bool polish(int most_factorizations);

  InteriorPointSettings settings_;
  const Deadline* deadline_ = nullptr;
  bool body_space_ = false;
  bool forces_add_up_ = false;  // contacts of bodies, and nothing that limits a force
  bool are_alike_ = false;      // the masses
  int sweeps_ = 0;              // before the first set
  BodySpaceSystem bodies_;
  std::unique_ptr<ShiftedSystem> given_;
  ScaledProblem problem_;
  ActiveSetNewton active_set_;
  ProximalNewton proximal_newton_;
  SmoothingNewton smoothing_newton_;
  std::unique_ptr<Nncg> sweeper_, warm_sweeper_;
  Result swept_;
  int iterations_ = 0;

  Vector x_, gradient_, r_;  // r = A x + g - y + v
  Barrier lower_, upper_;    // x - lower and y, upper - x and v
  double proximal_ = 0.0;
  double step_ = 1.0;  // the longest that kept the last iterate inside
  Vector e_, h_, dx_, kept_dx_, bound_, trial_;
  std::vector<RowState> guess_, last_guess_, tried_;
  int next_crossing_ = 0;
  int crossing_wait_ = 1;
  int wasted_ = 0;
  bool polished_early_ = false;
};

Status InteriorPoint::Workspace::run(const Problem& problem, const Vector* warm_start) {
  constexpr int kMostOfLastPolish = 60;
  set_barriers();
  forces_add_up_ = body_space_ && !problem_.has_upper();
  tried_.clear();
  next_crossing_ = 0;
  crossing_wait_ = 1;
  wasted_ = 0;
  polished_early_ = false;
  guess_.clear();
  proximal_ = settings_.proximal;
  x_ = problem_.best();  // zero, or the bound next to it
  problem_.gradient(x_, gradient_);
  if (problem_.consider(x_, gradient_) <= settings_.tolerance) {
    return Status::kStalled;  // solved: the certificate will say so
  }
  const Vector* start = warm_start;
  if (forces_add_up_ && are_alike_) {
    if (sweeps_are_cheap()) {
      start = &sweep(problem, warm_start);
    } else if (start == nullptr && start_on_all_rows()) {
      return Status::kStalled;
    }
  }
  if (warm_start != nullptr) {
    smoothing_newton_.reserve(problem_.size());  // whether or not this one comes to it
  }
  if (start != nullptr && start_warm(*start)) {
    return Status::kStalled;
  }
  const Status ending = interior_point(warm_start == nullptr);
  if (problem_.best_residual() > settings_.tolerance && !polish(kMostOfLastPolish) &&
      !guess_.empty() && guess_ != tried_ && ending != Status::kIterationLimit &&
      ending != Status::kTimeLimit) {
    (void)try_set();  // the last that the iterate pointed at, however far it was
  }
  return ending;
}

/// Which rows have which bound. A row whose bounds are equal has neither: it does not move.
void InteriorPoint::Workspace::set_barriers() {
  const auto& l = problem_.lower().array();
  const auto& u = problem_.upper().array();
  bound_ = (l > -kInfinity && l < u).cast<double>();
  lower_.set(bound_);
  bound_ = (u < kInfinity && l < u).cast<double>();
  upper_.set(bound_);
}

/// x of the size of g times size_of_x, away from its bounds. Forces add up from contact to contact:
/// their size is not known beforehand (see interior_point()).
void InteriorPoint::Workspace::start_cold(double size_of_x) {
  const double size_of_y = !forces_add_up_ ? 1.0 : are_alike_ ? 0.3 : 0.1;
  const Index n = problem_.size();
  const Vector& g = problem_.g();
  const double size = std::max(g.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const double margin = 0.1 * size;
  lower_.s.setOnes(n);
  lower_.y.setZero(n);
  upper_.s.setOnes(n);
  upper_.y.setZero(n);
  for (Index i = 0; i < n; ++i) {
    const double l = problem_.lower()[i];
    const double u = problem_.upper()[i];
    const bool below = lower_.has()[i] != 0.0;
    const bool above = upper_.has()[i] != 0.0;
    if (below && above) {
      const double inside = std::min(size_of_x * margin, 0.25 * (u - l));
      x_[i] = std::clamp(-size_of_x * g[i], l + inside, u - inside);
    } else if (below) {
      x_[i] = l + size_of_x * (std::max(-g[i], 0.0) + margin);
    } else if (above) {
      x_[i] = u - size_of_x * (std::max(g[i], 0.0) + margin);
    } else {
      x_[i] = l == u ? l : 0.0;
    }
    if (below) {
      lower_.s[i] = x_[i] - l;
      lower_.y[i] = size_of_y * std::max(g[i], margin);
    }
    if (above) {
      upper_.s[i] = u - x_[i];
      upper_.y[i] = size_of_y * std::max(-g[i], margin);
    }
  }
}

/// Whether kSweeps sweeps cost at most about six factorisations, by the flops of a factorisation a
/// row: of piles of spheres 4,000 with 1000 contacts, 12,000 with 3000, 41,000 with 10,000, 157,000
/// with 30,000; of pyramids and walls up to 10,000 with 40,000, of towers 100.
bool InteriorPoint::Workspace::sweeps_are_cheap() const {
  constexpr double kFlopsOfARow = 1e4;
  return bodies_.factor_flops() >= kFlopsOfARow * static_cast<double>(problem_.size());
}

/// The answer of a few sweeps, from the warm start if there is one.
const Vector& InteriorPoint::Workspace::sweep(const Problem& problem, const Vector* warm_start) {
  std::unique_ptr<Nncg>& sweeper = warm_start == nullptr ? sweeper_ : warm_sweeper_;
  if (sweeper == nullptr) {
    NncgSettings settings;
    settings.tolerance = settings_.tolerance;
    settings.max_iterations = warm_start == nullptr ? kSweeps : kWarmSweeps;
    sweeper = std::make_unique<Nncg>(settings);
  }
  sweeper->solve_within(deadline_->left_seconds(), problem, swept_, warm_start);
  sweeps_ = swept_.statistics.iterations;
  return swept_.z;
}

/// Tries the active set of the warm start; if that does not solve the problem, puts the iterate
/// near it, away from the bounds by the size of its error. @return whether the problem is solved
bool InteriorPoint::Workspace::start_warm(const Vector& warm_start) {
  constexpr ActiveSetNewton::Limits kLimits = {.factorizations = 8, .wrong_share = 0.05};
  const Index n = problem_.size();
  x_ = warm_start.cwiseProduct(problem_.system().scale())
           .cwiseMax(problem_.lower())
           .cwiseMin(problem_.upper());
  problem_.gradient(x_, gradient_);
  if (problem_.consider(x_, gradient_) <= settings_.tolerance) {
    return true;
  }
  guess_.resize(n);
  double sum = 0.0;
  for (Index i = 0; i < n; ++i) {
    const double target = x_[i] - gradient_[i];
    guess_[i] = target <= problem_.lower()[i]   ? RowState::kAtLower
                : target >= problem_.upper()[i] ? RowState::kAtUpper
                                                : RowState::kBetween;
    const double error = x_[i] - std::clamp(target, problem_.lower()[i], problem_.upper()[i]);
    sum += error * error;
  }
  trial_ = x_;
  if (active_set_.improve(problem_, trial_, guess_, kLimits, settings_.tolerance) <=
      settings_.tolerance) {
    return true;
  }
  guess_.clear();
  if (approach_by_smoothing()) {
    return true;
  }
  const double size =
      std::max(problem_.g().cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const double floor = std::max(std::sqrt(sum / static_cast<double>(n)), 1e-10 * size);
  lower_.s.setOnes(n);
  lower_.y.setZero(n);
  upper_.s.setOnes(n);
  upper_.y.setZero(n);
  for (Index i = 0; i < n; ++i) {
    const double l = problem_.lower()[i];
    const double u = problem_.upper()[i];
    const bool below = lower_.has()[i] != 0.0;
    const bool above = upper_.has()[i] != 0.0;
    const double inside = below && above ? std::min(floor, 0.25 * (u - l)) : floor;
    if (below) {
      x_[i] = std::max(x_[i], l + inside);
    }
    if (above) {
      x_[i] = std::min(x_[i], u - inside);
    }
    if (below) {
      lower_.s[i] = x_[i] - l;
      lower_.y[i] = std::max(gradient_[i], floor);
    }
    if (above) {
      upper_.s[i] = u - x_[i];
      upper_.y[i] = std::max(-gradient_[i], floor);
    }
  }
  return false;
}

/// Smoothing from a warm start, where it arrives in a third to a half of the interior point's
/// factorisations, and what it left to proximal points. Not from sweeps, whose error is of long
/// waves, and not where M is not symmetric: there it does not arrive as a rule. @return whether the
/// problem is solved
bool InteriorPoint::Workspace::approach_by_smoothing() {
  constexpr double kNear = 0.3;
  constexpr int kMostSteps = 14;
  constexpr int kMostOfPolish = 6;
  const int most =
      settings_.max_iterations >= 0 ? std::min(settings_.max_iterations, kMostSteps) : kMostSteps;
  if (sweeps_ > 0 || most == 0 || !problem_.system().is_symmetric() ||
      problem_.best_residual() > kNear) {
    return false;
  }
  trial_ = problem_.best();
  return smoothing_newton_.improve(problem_, trial_, most, settings_.tolerance, *deadline_) ||
         polish(std::min(kMostOfPolish, most));
}

/// Tries the set of all rows from x = 0, where all contacts press at rest. @return whether the
/// problem is solved
bool InteriorPoint::Workspace::start_on_all_rows() {
  constexpr ActiveSetNewton::Limits kLimits = {.factorizations = 3, .wrong_share = 0.06};
  trial_ = x_;
  guess_.assign(problem_.size(), RowState::kBetween);
  tried_ = guess_;
  const bool solved = active_set_.improve(problem_, trial_, guess_, kLimits, settings_.tolerance) <=
                      settings_.tolerance;
  guess_.clear();
  return solved;
}

/// Factors A + Y/S + V/T + proximal. Where that fails the proximal term grows: it changes the path,
/// not the answer.
bool InteriorPoint::Workspace::factor() {
  constexpr double kMostProximal = 1e-6;
  e_ = lower_.y.cwiseQuotient(lower_.s);
  if (problem_.has_upper()) {
    e_ += upper_.y.cwiseQuotient(upper_.s);
    for (Index i = 0; i < e_.size(); ++i) {
      if (problem_.lower()[i] == problem_.upper()[i]) {
        e_[i] = kInfinity;
      }
    }
  }
  while (!problem_.system().factor(e_, proximal_)) {
    proximal_ = std::max(100.0 * proximal_, 1e-12);
    if (proximal_ > kMostProximal) {
      return false;
    }
  }
  return true;
}

/// dx and the barriers' directions for their right-hand sides, with the factor at hand:
/// (A + Y/S + V/T) dx = -r + c_l / s - c_u / t.
bool InteriorPoint::Workspace::newton_direction() {
  h_ = lower_.right_side().cwiseQuotient(lower_.s) - r_;
  if (problem_.has_upper()) {
    h_ -= upper_.right_side().cwiseQuotient(upper_.s);
  }
  problem_.system().solve(h_, dx_);
  lower_.follow(dx_, 1.0);
  if (problem_.has_upper()) {
    upper_.follow(dx_, -1.0);
  }
  return std::isfinite(dx_.sum()) && std::isfinite(lower_.dy.sum());
}

/// One step of Mehrotra's predictor-corrector from the iterate with r_ and the given mu.
/// @return kNumericalBreakdown, or kNotRun if all went well
Status InteriorPoint::Workspace::predict_and_correct(double mu) {
  const bool has_upper = problem_.has_upper();
  if (!factor()) {
    return Status::kNumericalBreakdown;
  }
  lower_.predict();
  upper_.predict();
  if (!newton_direction()) {
    return Status::kNumericalBreakdown;
  }
  const double barriers = lower_.count() + upper_.count();
  const auto longest_step = [&] {
    return std::min(lower_.longest_step(), has_upper ? upper_.longest_step() : 1.0);
  };
  if (barriers > 0.0) {
    const double affine = longest_step();
    const double gap = lower_.gap_after(affine) + (has_upper ? upper_.gap_after(affine) : 0.0);
    const double target = mu * std::pow(std::max(gap / barriers, 0.0) / mu, 3);
    lower_.correct(target);
    if (has_upper) {
      upper_.correct(target);
    }
    if (!newton_direction()) {
      return Status::kNumericalBreakdown;
    }
    // Further correctors for centrality, where a solve is cheap beside a factorisation (Gondzio,
    // Computational Optimization and Applications 6, 1996), as long as they lengthen the step.
    const double cost = problem_.system().factor_cost();
    const int correctors = cost > 3.0 ? 2 : cost > 1.5 ? 1 : 0;
    for (int k = 0; k < correctors; ++k) {
      const double before = longest_step();
      const double wished = std::min(1.0, 1.5 * before + 0.1);
      kept_dx_ = dx_;
      lower_.keep();
      lower_.centre(wished, target);
      if (has_upper) {
        upper_.keep();
        upper_.centre(wished, target);
      }
      if (!newton_direction()) {
        return Status::kNumericalBreakdown;
      }
      if (longest_step() < before + 0.1 * (wished - before)) {
        dx_.swap(kept_dx_);
        lower_.restore();
        upper_.restore();
        break;
      }
    }
  }
  step_ = longest_step();
  const double step = step_ < 1.0 || barriers > 0.0 ? settings_.step_fraction * step_ : 1.0;
  x_ += step * dx_;
  lower_.move(step);
  if (has_upper) {
    upper_.move(step);
  }
  return Status::kNotRun;
}

/// From the start at hand, or from a cold one. Where the first step all but stands still the next
/// start has an x a hundred times as large, as long as that lengthens the step.
Status InteriorPoint::Workspace::interior_point(bool cold) {
  const int most = settings_.max_iterations >= 0 ? settings_.max_iterations
                                                 : InteriorPointSettings::kDefaultIterations;
  const double barriers = lower_.count() + upper_.count();
  constexpr double kLargestSize = 1e9;
  constexpr double kSizeGrows = 100.0;
  constexpr double kShortStep = 0.1;
  constexpr double kEarlyPolish = 1e-6;
  constexpr int kMostOfEarlyPolish = 6;
  double size_of_x = !forces_add_up_ ? 1.0 : are_alike_ ? 10.0 : 100.0;
  double last_first_step = 0.0;
  if (cold) {
    start_cold(size_of_x);
  }
  bool may_grow = cold && forces_add_up_;
  Progress progress;
  for (;; ++iterations_) {
    problem_.gradient(x_, gradient_);
    const double residual = problem_.consider(x_, gradient_);
    // Beyond this the polish is the better way to the last digits.
    if (residual <= std::max(settings_.tolerance, 1e-10) || cross_over(residual, may_grow)) {
      return Status::kStalled;  // the certificate will say what it is
    }
    if (residual <= kEarlyPolish && !polished_early_) {
      polished_early_ = true;
      if (polish(kMostOfEarlyPolish)) {
        return Status::kStalled;
      }
    }
    if (iterations_ == most) {
      return Status::kIterationLimit;
    }
    if (deadline_->passed()) {
      return Status::kTimeLimit;
    }
    r_ = gradient_ - lower_.y;
    double mu = lower_.gap();
    if (problem_.has_upper()) {
      r_ += upper_.y;
      mu += upper_.gap();
      for (Index i = 0; i < r_.size(); ++i) {
        if (problem_.lower()[i] == problem_.upper()[i]) {
          r_[i] = 0.0;
        }
      }
    }
    mu = barriers > 0.0 ? mu / barriers : 0.0;
    const double infeasibility = r_.cwiseAbs().maxCoeff();
    if (!progress.goes_on(mu, infeasibility, barriers > 0.0)) {
      return Status::kStalled;
    }
    if (const Status status = predict_and_correct(mu); status != Status::kNotRun) {
      return status;
    }
    may_grow = may_grow && step_ < kShortStep && size_of_x < kLargestSize;
    if (may_grow) {
      may_grow = step_ > last_first_step;
      last_first_step = step_;
      size_of_x *= may_grow ? kSizeGrows : 1.0 / kSizeGrows;
      start_cold(size_of_x);
      progress = {};
    }
  }
}

/// The active set that the iterate points at: a row is between its bounds where its slacks are
/// larger than their multipliers. @return rows that changed since the last guess
int InteriorPoint::Workspace::guess_set() {
  const Index n = problem_.size();
  last_guess_.swap(guess_);
  guess_.resize(n);
  int changed = 0;
  for (Index i = 0; i < n; ++i) {
    RowState state = RowState::kBetween;
    if (problem_.lower()[i] == problem_.upper()[i] ||
        (lower_.has()[i] != 0.0 && lower_.y[i] > lower_.s[i])) {
      state = RowState::kAtLower;
    } else if (upper_.has()[i] != 0.0 && upper_.y[i] > upper_.s[i]) {
      state = RowState::kAtUpper;
    }
    guess_[i] = state;
    changed += last_guess_.empty() || last_guess_[i] != state ? 1 : 0;
  }
  return changed;
}

/// @return whether the active set of the last guess solves the problem
bool InteriorPoint::Workspace::try_set() {
  constexpr ActiveSetNewton::Limits kLimits = {.factorizations = 8, .wrong_share = 0.015};
  tried_ = guess_;
  trial_ = x_;
  std::vector<RowState>& state = last_guess_;  // to change; the next guess is compared with guess_
  state = guess_;
  return active_set_.improve(problem_, trial_, state, kLimits, settings_.tolerance) <=
         settings_.tolerance;
}

/// Leaves the interior for the active set that the iterate points at, when that has settled: which
/// means nothing while the iterate is far from everything, unless it has just had to grow, as in
/// towers whose contacts all press. After a failure it waits, each time longer. @return whether
/// that solves the problem
bool InteriorPoint::Workspace::cross_over(double residual, bool has_grown) {
  constexpr double kFar = 0.3;
  constexpr double kSettled = 0.005;  // of the rows may still have changed, and
  constexpr double kMostChanged = 3.0;
  // Factorisations that failures may have cost: some, and a share of the iterations.
  constexpr double kFirstWaste = 2.0;
  constexpr double kWasteShare = 0.3;
  const int changed = guess_set();
  const bool settled =
      changed <= std::min(kSettled * static_cast<double>(guess_.size()), kMostChanged);
  const bool affordable = wasted_ <= kFirstWaste + kWasteShare * iterations_;
  const bool is_far = forces_add_up_ && residual > kFar && !(has_grown && iterations_ > 0);
  if (is_far || !settled || !affordable || iterations_ < next_crossing_ || guess_ == tried_) {
    return false;
  }
  const int before = problem_.system().factorizations();
  if (try_set()) {
    return true;
  }
  wasted_ += problem_.system().factorizations() - before;
  next_crossing_ = iterations_ + crossing_wait_;
  crossing_wait_ *= 2;
  return false;
}

/// Proximal Newton from the best iterate. @return whether that solves the problem
bool InteriorPoint::Workspace::polish(int most_factorizations) {
  constexpr double kWorthPolishing = 1e-4;  // from a worse start the active set is a guess
  if (body_space_ && problem_.best_residual() <= kWorthPolishing) {
    proximal_newton_.improve(
        problem_, bodies_, settings_.polish_proximal, settings_.max_polish_steps,
        bodies_.factorizations() + most_factorizations, settings_.tolerance, *deadline_);
  }
  return problem_.best_residual() <= settings_.tolerance;
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
  if (!problem.cones.empty()) {
    return "takes no friction cones; row " + std::to_string(problem.cones.front().normal_row) +
           " has one";
  }
  return problem.limits.empty() ? ""
                                : "takes no coupled limits; row " +
                                      std::to_string(problem.limits.front().row) + " has one";
}

Status InteriorPoint::iterate(const Problem& problem, const Vector* warm_start,
                              const Deadline& deadline, Result& result) {
  return workspace_->solve(problem, warm_start, deadline, result);
}

}  // namespace signorini::lcp
