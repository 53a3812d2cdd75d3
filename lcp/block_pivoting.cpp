#include <signorini/lcp/active_set_newton.h>
#include <signorini/lcp/block_pivoting.h>
#include <signorini/lcp/body_space_system.h>
#include <signorini/lcp/lemke_ray.h>
#include <signorini/lcp/number_text.h>
#include <signorini/lcp/scaled_problem.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kRounding = 16.0;   // roundings that are no wrong sign
constexpr int kCorrections = 12;     // refinement steps of a solve on a set at most
constexpr double kHelps = 0.5;       // of the residual: what a proximal step must leave at most
constexpr int kIdleSteps = 12;       // proximal steps in a row that may not help
constexpr int kIdleStepsToARay = 2;  // after which z may be running away
constexpr double kFarRay = 1e3;      // a ray must speak of z this much larger than the best one
// Where blocks go round and single exchanges take long, delta grows by this, up to kMostProximal,
// and falls by it from round to round.
constexpr double kProximalFactor = 100.0;
constexpr double kProximalFall = 10.0;
constexpr double kMostProximal = 1e-2;
constexpr double kLeastProximal = 1e-13;
constexpr int kSingleTrials = 10;     // and two a row: single exchanges before delta grows
constexpr double kOfTolerance = 0.1;  // of the tolerance: where the rounds end

void require(bool good, const char* setting, const char* bound, double value) {
  if (!good) {
    throw std::invalid_argument(std::string("BlockPivoting settings: ") + setting + ": must be " +
                                bound + ", got " + number_text(value));
  }
}

/// Appends a number; allocates only where the text outgrows what it had before.
template <typename Number>
void append(Number value, std::string& text) {
  std::array<char, 32> digits{};
  char* end = digits.data() + digits.size();
  if constexpr (std::is_floating_point_v<Number>) {
    end = std::to_chars(digits.data(), end, value, std::chars_format::general, 2).ptr;
  } else {
    end = std::to_chars(digits.data(), end, value).ptr;
  }
  text.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

}  // namespace

void BlockPivotingSettings::validate() const {
  SolverSettings::validate();
  require(proximal >= kLeastProximal && proximal <= kMostProximal, "proximal", "in [1e-13, 1e-2]",
          proximal);
  require(block_trials >= 0, "block_trials", ">= 0", block_trials);
  require(proximal_steps >= 1, "proximal_steps", ">= 1", proximal_steps);
}

/// The problem in scaled coordinates and everything that changes during a solve.
class BlockPivoting::Workspace {
 public:
  explicit Workspace(const BlockPivotingSettings& settings) : settings_(settings) {}

  Status solve(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
               Result& result);

 private:
  /// How the pivoting of one round ended.
  enum class Ending { kDone, kLimit, kTime, kBreakdown };

  void start(const Vector* warm_start);
  Ending pivot(const Deadline& deadline);
  [[nodiscard]] bool solve_on_set();
  int find_wrong();
  void change_side(Index i);
  [[nodiscard]] bool collect_ray(const Problem& problem, Vector& ray);
  void describe(std::string& detail) const;

  BlockPivotingSettings settings_;
  BodySpaceSystem bodies_;
  std::unique_ptr<ShiftedSystem> given_;
  ShiftedSystem* system_ = nullptr;
  ScaledProblem problem_;

  std::vector<RowState> state_;
  Vector x_, center_, step_;  // step_: the last proximal step, x - c
  Vector w_;                  // A x + g + delta (x - c)
  Vector e_, h_, dx_, gradient_, clamped_;
  std::vector<Index> wrong_;  // rows whose sign is wrong, ascending
  double largest_g_ = 0.0;

  double proximal_ = 0.0;        // delta of this round
  double least_proximal_ = 0.0;  // over all rounds
  double largest_proximal_ = 0.0;

  int sets_ = 0;
  int rounds_ = 0;
  int single_ = 0;
};

Status BlockPivoting::Workspace::solve(const Problem& problem, const Vector* warm_start,
                                       const Deadline& deadline, Result& result) {
  if (std::holds_alternative<FactoredMatrix>(problem.M)) {
    system_ = &bodies_;
  } else {
    given_ = given_ == nullptr ? make_given_matrix_system() : std::move(given_);
    system_ = given_.get();
  }
  system_->set(problem.M);
  problem_.set(problem, *system_);
  start(warm_start);
  Status status = Status::kStalled;
  double before = kInfinity;
  int idle = 0;
  for (rounds_ = 0; rounds_ < settings_.proximal_steps && idle < kIdleSteps;) {
    center_ = x_;
    const Ending ending = pivot(deadline);
    if (ending != Ending::kDone) {
      status = ending == Ending::kLimit  ? Status::kIterationLimit
               : ending == Ending::kTime ? Status::kTimeLimit
                                         : Status::kNumericalBreakdown;
      break;
    }
    ++rounds_;
    step_ = x_ - center_;
    clamped_ = x_.cwiseMax(problem_.lower()).cwiseMin(problem_.upper());
    problem_.gradient(clamped_, gradient_);
    const double residual = problem_.consider(clamped_, gradient_);
    if (residual <= kOfTolerance * settings_.tolerance) {
      break;
    }
    idle = residual <= kHelps * before || proximal_ > settings_.proximal ? 0 : idle + 1;
    before = std::min(before, residual);
    if (idle == kIdleStepsToARay && problem.is_lcp() && collect_ray(problem, result.ray)) {
      status = Status::kRayUnproven;
      break;
    }
    const double lowest = idle > 0 ? kLeastProximal : std::min(proximal_, settings_.proximal);
    proximal_ = std::max(lowest, proximal_ / kProximalFall);
    least_proximal_ = std::min(least_proximal_, proximal_);
  }
  problem_.best_z(result.z);
  if (status == Status::kStalled && problem_.best_residual() > settings_.tolerance &&
      problem.is_lcp() && collect_ray(problem, result.ray)) {
    status = Status::kRayUnproven;
  }
  describe(result.detail);
  result.statistics = {.iterations = rounds_,
                       .pivots = sets_,
                       .factorizations = system_->factorizations(),
                       .factor_bytes = system_->factorizations() > 0 ? system_->factor_bytes() : 0};
  return status;
}

/// The first set, x and c.
void BlockPivoting::Workspace::start(const Vector* warm_start) {
  const Index n = problem_.size();
  sets_ = rounds_ = single_ = 0;
  proximal_ = least_proximal_ = largest_proximal_ = settings_.proximal;
  x_ = problem_.best();  // zero, or the bound next to it
  if (warm_start != nullptr) {
    x_ = warm_start->cwiseProduct(system_->scale());
    x_ = x_.cwiseMax(problem_.lower()).cwiseMin(problem_.upper());
  }
  largest_g_ = problem_.g().cwiseAbs().maxCoeff();
  problem_.gradient(x_, gradient_);
  problem_.consider(x_, gradient_);
  state_.resize(n);
  for (Index i = 0; i < n; ++i) {
    const double lower = problem_.lower()[i];
    const double upper = problem_.upper()[i];
    state_[i] = x_[i] == lower   ? RowState::kAtLower
                : x_[i] == upper ? RowState::kAtUpper
                                 : RowState::kBetween;
    if (warm_start == nullptr && lower > -kInfinity && state_[i] == RowState::kBetween) {
      state_[i] = RowState::kAtLower;
    } else if (warm_start == nullptr && upper < kInfinity && state_[i] == RowState::kBetween) {
      state_[i] = RowState::kAtUpper;
    }
  }
}

/// Pivots until no sign is wrong for this c.
BlockPivoting::Workspace::Ending BlockPivoting::Workspace::pivot(const Deadline& deadline) {
  const int limit = settings_.max_iterations >= 0 ? settings_.max_iterations
                                                  : 1000 + 20 * static_cast<int>(problem_.size());
  int least = std::numeric_limits<int>::max();
  int trials = settings_.block_trials;
  int single_trials = kSingleTrials + static_cast<int>(problem_.size()) / 20;
  while (true) {
    if (sets_ >= limit) {
      return Ending::kLimit;
    }
    if (deadline.passed()) {
      return Ending::kTime;
    }
    ++sets_;
    if (!solve_on_set()) {
      return Ending::kBreakdown;
    }
    const int wrong = find_wrong();
    if (wrong == 0) {
      return Ending::kDone;
    }
    if (wrong < least) {
      least = wrong;
      trials = settings_.block_trials;
    } else if (trials > 0) {
      --trials;
    } else if (single_trials > 0 || proximal_ >= kMostProximal) {  // Murty
      --single_trials;
      ++single_;
      change_side(wrong_.front());
      continue;
    } else {
      proximal_ = std::min(kMostProximal, proximal_ * kProximalFactor);
      largest_proximal_ = std::max(largest_proximal_, proximal_);
      least = std::numeric_limits<int>::max();
      trials = settings_.block_trials;
      single_trials = kSingleTrials + static_cast<int>(problem_.size()) / 20;
      continue;
    }
    for (const Index i : wrong_) {
      change_side(i);
    }
  }
}

/// x on the set and w_, refined. @return false if that has no factor or is not finite
bool BlockPivoting::Workspace::solve_on_set() {
  const Index n = problem_.size();
  const double delta = proximal_;
  e_.resize(n);
  h_.resize(n);
  for (Index i = 0; i < n; ++i) {
    const bool basic = state_[i] == RowState::kBetween;
    e_[i] = basic ? 0.0 : kInfinity;
    if (!basic) {
      x_[i] = state_[i] == RowState::kAtLower ? problem_.lower()[i] : problem_.upper()[i];
    }
  }
  if (!system_->factor(e_, delta)) {
    return false;
  }
  double before = kInfinity;
  for (int k = 0;; ++k) {
    problem_.gradient(x_, w_);
    w_ += delta * (x_ - center_);
    double most = 0.0;
    double largest_x = 0.0;
    for (Index i = 0; i < n; ++i) {
      h_[i] = state_[i] == RowState::kBetween ? -w_[i] : 0.0;
      most = std::max(most, std::abs(h_[i]));
      largest_x = std::max(largest_x, std::abs(x_[i]));
    }
    if (!std::isfinite(most + largest_x)) {
      return false;
    }
    if (!(most < kHelps * before) || most <= kEpsilon * (largest_g_ + largest_x) ||
        k > kCorrections) {
      return w_.allFinite();
    }
    before = most;
    system_->solve(h_, dx_);
    x_ += dx_;
  }
}

/// Fills wrong_: rows outside their bounds, and rows at one whose w has the wrong sign, beyond
/// rounding. @return how many
int BlockPivoting::Workspace::find_wrong() {
  const double largest_x = x_.cwiseAbs().maxCoeff();
  const double rounding = kRounding * kEpsilon * (largest_g_ + largest_x);
  const double slack = kRounding * kEpsilon * largest_x;
  wrong_.clear();
  for (Index i = 0; i < problem_.size(); ++i) {
    bool wrong = false;
    switch (state_[i]) {
      case RowState::kBetween:
        wrong = x_[i] < problem_.lower()[i] - slack || x_[i] > problem_.upper()[i] + slack;
        break;
      case RowState::kAtLower:
        wrong = w_[i] < -rounding && problem_.lower()[i] < problem_.upper()[i];
        break;
      case RowState::kAtUpper:
        wrong = w_[i] > rounding && problem_.lower()[i] < problem_.upper()[i];
        break;
    }
    if (wrong) {
      wrong_.push_back(i);
    }
  }
  return static_cast<int>(wrong_.size());
}

void BlockPivoting::Workspace::change_side(Index i) {
  state_[i] = state_[i] != RowState::kBetween ? RowState::kBetween
              : x_[i] < problem_.lower()[i]   ? RowState::kAtLower
                                              : RowState::kAtUpper;
}

/// The direction in which z runs away, if it proves more than a bound near the present z.
bool BlockPivoting::Workspace::collect_ray(const Problem& problem, Vector& ray) {
  const Vector direction = step_.cwiseMax(0.0).cwiseQuotient(system_->scale());
  Vector sharpened;
  const RayVerdict verdict = sharpen_ray(problem, direction, sharpened);
  if (verdict.status == Status::kRayUnproven ||
      !(verdict.bound > kFarRay * problem_.best().cwiseQuotient(system_->scale()).lpNorm<1>())) {
    return false;
  }
  ray = sharpened;
  return true;
}

void BlockPivoting::Workspace::describe(std::string& detail) const {
  append(sets_, detail);
  detail += " sets";
  if (single_ > 0) {
    detail += ", ";
    append(single_, detail);
    detail += " single exchanges by least index";
  }
  detail += "; ";
  append(rounds_, detail);
  detail += " proximal rounds of weight ";
  append(least_proximal_, detail);
  if (largest_proximal_ > least_proximal_) {
    detail += " to ";
    append(largest_proximal_, detail);
  }
}

BlockPivoting::BlockPivoting(const BlockPivotingSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>(settings)) {
  settings_.validate();
}

BlockPivoting::~BlockPivoting() = default;

std::string BlockPivoting::refuses(const Problem& problem) const {
  if (!problem.cones.empty()) {
    return "takes no friction cones; row " + std::to_string(problem.cones.front().normal_row) +
           " has one";
  }
  return problem.limits.empty() ? ""
                                : "takes no coupled limits; row " +
                                      std::to_string(problem.limits.front().row) + " has one";
}

Status BlockPivoting::iterate(const Problem& problem, const Vector* warm_start,
                              const Deadline& deadline, Result& result) {
  return workspace_->solve(problem, warm_start, deadline, result);
}

}  // namespace signorini::lcp
