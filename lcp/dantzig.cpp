#include <signorini/lcp/dantzig.h>
#include <signorini/lcp/lemke_ray.h>
#include <signorini/lcp/number_text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kOfTolerance = 1e-2;  // what counts as violated, of the wanted residual
// Schur complements below this are recomputed from M. In a tableau, where an exchange on p costs
// the others eps / p, only those below kSafe times that, or kSafe times what counts as dependent.
constexpr double kCheckSchurBelow = 1e-5;
constexpr double kSafe = 100.0;
constexpr double kLeastCurvature = 1e-3;  // a dependent row is not driven first
constexpr double kNoRate = 1e-12;         // of the largest rate: does not move
constexpr double kRelax = 1e-13;          // of the largest z: bounds are met within this (Harris)
constexpr int kCorrections = 10;          // refinement steps at most
constexpr int kRefreshes = 50;            // passes of refinement and driving at most
constexpr double kExactSymmetry = 1e-12;  // rounding of the source
constexpr double kRounding = 8.0;         // roundings that are no violation

void require(bool good, const char* setting, const char* bound, double value) {
  if (!good) {
    throw std::invalid_argument(std::string("Dantzig settings: ") + setting + ": must be " + bound +
                                ", got " + number_text(value));
  }
}

}  // namespace

void DantzigSettings::validate() const {
  SolverSettings::validate();
  require(dependence_tolerance > 0.0 && dependence_tolerance <= 1e-3, "dependence_tolerance",
          "in (0, 1e-3]", dependence_tolerance);
  require(limit_rounds >= 1, "limit_rounds", ">= 1", limit_rounds);
}

Dantzig::Dantzig(const DantzigSettings& settings) : settings_(settings) {
  settings_.validate();
}

std::string Dantzig::refuses(const Problem& problem) const {
  if (!problem.cones.empty()) {
    return "takes bounds and coupled limits, no friction cones";
  }
  const std::string asymmetry = SymmetricLcp::find_asymmetry(problem);
  return asymmetry.empty() ? "" : "takes a symmetric M; " + asymmetry;
}

Status Dantzig::iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                        Result& result) {
  pivots_ = flips_ = refinements_ = dependent_moves_ = rounds_ = looks_ = 0;
  ray_row_ = -1;
  result.z.setZero();
  if (!scaled_.assign(problem)) {
    result.detail = "M is not finite once it is formed and scaled";
    return Status::kNumericalBreakdown;
  }
  const Status status =
      start(problem, warm_start) ? run(problem, deadline, result) : Status::kNumericalBreakdown;
  for (int i = 0; i < scaled_.size(); ++i) {
    result.z[i] = scaled_.unscale_z(i, z_[i]);
  }
  describe(problem, result);
  result.statistics.pivots = pivots_;
  result.statistics.factorizations = basis_->factorizations();
  result.statistics.refinements = refinements_;
  return status;
}

bool Dantzig::start(const Problem& problem, const Vector* warm_start) {
  const int n = scaled_.size();
  basis_ = &tableau_;
  if (!scaled_.is_dense() && n > kTableauRows) {
    basis_ = &factor_;
  }
  basis_->reset(scaled_);
  z_.resize(n);
  w_.resize(n);
  rate_.resize(n);
  work_.resize(n);
  ray_work_.resize(n);
  slack_w_.resize(n);
  slack_z_.resize(n);
  blocks_.reserve(n);
  ignored_.assign(n, 0);
  any_ignored_ = false;
  largest_z_ = 0.0;
  least_pivot_ = 1.0;
  // Rows of large scale have small w in the caller's units, where the residual is measured.
  const double largest_q = problem.q.cwiseAbs().maxCoeff();
  const double wanted = kOfTolerance * settings_.tolerance;
  for (int i = 0; i < n; ++i) {
    slack_w_[i] = wanted * largest_q * scaled_.scale(i) * scaled_.q_scale();
    slack_z_[i] = std::min(slack_w_[i], scaled_.scale_z(i, wanted * (1.0 + largest_q)));
  }
  couple(problem, true);
  for (int i = 0; i < n; ++i) {
    const double from = warm_start != nullptr ? scaled_.scale_z(i, (*warm_start)[i]) : 0.0;
    z_[i] = std::min(std::max(from, scaled_.lower(i)), scaled_.upper(i));
  }
  if (warm_start != nullptr) {
    for (int i = 0; i < n; ++i) {
      if (z_[i] > scaled_.lower(i) && z_[i] < scaled_.upper(i)) {
        basis_->column(i, rate_.data());
        if (!depends(i) && !exchange(i)) {
          return false;
        }
      }
    }
  }
  return true;
}

/// The bounds of the coupled rows from z: 0 at first, then -+ mu z_n.
void Dantzig::couple(const Problem& problem, bool first) {
  for (const CoupledLimit& limit : problem.limits) {
    const int n = limit.normal_row;
    const double most =
        first ? 0.0 : limit.coefficient * scaled_.unscale_z(n, std::max(0.0, z_[n]));
    scaled_.set_bounds(limit.row, -most, most);
  }
}

Status Dantzig::run(const Problem& problem, const Deadline& deadline, Result& result) {
  for (rounds_ = 1;; ++rounds_) {
    switch (solve_box(deadline)) {
      case Ending::kSatisfied: break;
      case Ending::kRay: return judge_direction(problem, result);
      case Ending::kLimit: return Status::kIterationLimit;
      case Ending::kTime: return Status::kTimeLimit;
      case Ending::kBreakdown:
        result.detail = "M is not positive semidefinite beyond rounding";
        return Status::kNumericalBreakdown;
      default: return Status::kStalled;
    }
    // kStalled is what the frame keeps if the certificate refuses.
    if (problem.limits.empty() || (rounds_ > 1 && meets_limits(problem)) ||
        rounds_ > settings_.limit_rounds) {
      return Status::kStalled;
    }
    couple(problem, false);
    for (const CoupledLimit& limit : problem.limits) {
      const int i = limit.row;
      if (!basis_->contains(i)) {
        // Keeps its side; the side of a row that was fixed at 0 is that of its w.
        const double side = z_[i] != 0.0 ? z_[i] : -w_[i];
        z_[i] = side > 0.0 ? scaled_.upper(i) : side < 0.0 ? scaled_.lower(i) : 0.0;
      }
    }
  }
}

/// The null direction that nothing blocks, as the ray of an LCP.
Status Dantzig::judge_direction(const Problem& problem, Result& result) {
  if (!problem.is_lcp()) {
    result.detail = "row " + std::to_string(ray_row_) +
                    " depends on others that it contradicts: infeasible as far as rounding shows";
    return Status::kRayUnproven;
  }
  // Refined, so that its exact form can be found.
  std::fill(work_.begin(), work_.end(), 0.0);
  for (int i = 0; i < scaled_.size(); ++i) {
    if (basis_->contains(i) || i == ray_row_) {
      scaled_.add_column(i, i == ray_row_ ? 1.0 : rate_[i], work_.data());
    }
  }
  if (basis_->refactor()) {
    basis_->solve(work_.data());
    for (int i = 0; i < scaled_.size(); ++i) {
      rate_[i] -= basis_->contains(i) ? work_[i] : 0.0;
    }
  }
  Vector ray = Vector::Zero(scaled_.size());
  for (int i = 0; i < scaled_.size(); ++i) {
    if (basis_->contains(i)) {
      ray[i] = scaled_.unscale_direction(i, std::max(0.0, rate_[i]));
    }
  }
  ray[ray_row_] = scaled_.unscale_direction(ray_row_, 1.0);
  return sharpen_ray(problem, ray, result.ray).status;
}

/// True if the limits are those of the present z, within the wanted residual.
bool Dantzig::meets_limits(const Problem& problem) const {
  return std::all_of(problem.limits.begin(), problem.limits.end(), [this](const auto& limit) {
    const int n = limit.normal_row;
    const double most =
        scaled_.scale_z(limit.row, limit.coefficient * scaled_.unscale_z(n, std::max(0.0, z_[n])));
    return std::abs(most - scaled_.upper(limit.row)) <= slack_z_[limit.row];
  });
}

Dantzig::Ending Dantzig::solve_box(const Deadline& deadline) {
  for (int pass = 0; pass < kRefreshes; ++pass) {
    if (!refresh()) {
      return Ending::kBreakdown;
    }
    int row = most_violated();
    if (row < 0) {
      return Ending::kSatisfied;
    }
    Ending ending = Ending::kNext;
    for (; row >= 0 && ending == Ending::kNext; row = most_violated()) {
      ending = drive(row, deadline);
    }
    if (ending != Ending::kNext && ending != Ending::kRounding) {
      return ending;
    }
  }
  return Ending::kStalled;
}

/// Moves z_row until its w is 0 or a bound is met.
Dantzig::Ending Dantzig::drive(int row, const Deadline& deadline) {
  const int limit =
      settings_.max_iterations >= 0 ? settings_.max_iterations : 1000 + 50 * scaled_.size();
  const double direction = w_[row] < 0.0 ? 1.0 : -1.0;
  const double last = direction > 0.0 ? scaled_.upper(row) : scaled_.lower(row);
  while (true) {
    if (pivots_ + flips_ >= limit) {
      return Ending::kLimit;
    }
    if (deadline.passed_at(looks_++, scaled_.size())) {
      return Ending::kTime;
    }
    basis_->column(row, rate_.data());
    const bool dependent = depends(row);
    if (std::abs(w_[row]) <= slack_w_[row]) {
      // It met 0 together with a bound of another row.
      w_[row] = 0.0;
      return dependent || exchange(row) ? Ending::kNext : Ending::kBreakdown;
    }
    Event event = first_block(row, direction, dependent);
    const double own = dependent ? kInfinity : std::abs(w_[row]) / rate_[row];
    const double to_bound = std::abs(last - z_[row]);
    if (std::min({own, event.step, to_bound}) == kInfinity) {
      ray_row_ = row;
      return Ending::kRay;
    }
    if (own <= std::min(event.step, to_bound)) {
      event = {row, own, 0.0, 0.0};
    } else if (to_bound <= event.step) {
      event = {row, to_bound, last, 0.0};
    }
    // A basic w that passes for blocking with a row that depends on C cannot move: rounding.
    if (event.row != row && !basis_->contains(event.row)) {
      std::swap(rate_, work_);
      basis_->column(event.row, rate_.data());
      const bool ignore = depends(event.row);
      std::swap(rate_, work_);
      if (ignore) {
        ignored_[event.row] = 1;
        any_ignored_ = true;
        continue;
      }
    }
    dependent_moves_ += dependent ? 1 : 0;
    const double step = direction * event.step;
    for (int i = 0; i < scaled_.size(); ++i) {
      (basis_->contains(i) ? z_ : w_)[i] += step * rate_[i];
    }
    z_[row] += step;
    if (any_ignored_) {
      std::fill(ignored_.begin(), ignored_.end(), 0);
      any_ignored_ = false;
    }
    if (event.row == row && event.step == to_bound && event.step != own) {
      z_[row] = last;
      ++flips_;
      // M v = 0 leaves w_row as it was: where it asks for the way back, it was rounding.
      return dependent && violation(row) > slack_w_[row] ? Ending::kRounding : Ending::kNext;
    }
    if (event.row == row || !basis_->contains(event.row)) {
      if (!exchange(event.row)) {
        return Ending::kBreakdown;
      }
      w_[event.row] = 0.0;
      if (event.row == row) {
        return Ending::kNext;
      }
    } else if (!leave(event.row, event.bound)) {
      return Ending::kBreakdown;
    }
  }
}

/// How far the basic variable of row i can go at this rate, and in `bound` where it ends.
inline double Dantzig::way(int i, double rate, double& bound) const {
  if (basis_->contains(i)) {
    bound = rate > 0.0 ? scaled_.upper(i) : scaled_.lower(i);
    return rate > 0.0 ? bound - z_[i] : z_[i] - bound;
  }
  const bool leaves_zero = rate < 0.0 ? z_[i] < scaled_.upper(i) : z_[i] > scaled_.lower(i);
  const double distance = rate < 0.0 ? w_[i] : -w_[i];
  return leaves_zero && distance >= -slack_w_[i] ? distance : kInfinity;
}

/// The first row whose basic variable blocks a step along `direction`, by Harris's two passes.
Dantzig::Event Dantzig::first_block(int row, double direction, bool dependent) {
  const int n = scaled_.size();
  double largest = 1.0;
  for (int i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(rate_[i]));
  }
  const double no_rate = kNoRate * largest;
  const double relax = kRelax * (1.0 + largest_z_);
  double least = kInfinity;
  blocks_.clear();
  for (int i = 0; i < n; ++i) {
    const double rate = direction * rate_[i];
    const double size = std::abs(rate);
    if (size <= no_rate || i == row || (dependent && !basis_->contains(i)) || ignored_[i] != 0) {
      continue;
    }
    double bound = 0.0;
    const double distance = way(i, rate, bound);
    if (distance < kInfinity) {
      const double step = std::max(0.0, distance) / size;
      blocks_.push_back({i, step, bound, size});
      least = std::min(least, step + relax / size);
    }
  }
  Event event{-1, kInfinity, 0.0, 0.0};
  for (const Event& block : blocks_) {
    if (block.step <= least && block.rate > event.rate) {
      event = block;
    }
  }
  return event;
}

/// Whether a row outside C depends on C; rate_ must be its column. A small Schur complement is
/// computed again as v.M v, whose error is quadratic in that of the rates.
bool Dantzig::depends(int row) {
  if (rate_[row] > kCheckSchurBelow) {
    return false;
  }
  const int n = scaled_.size();
  double length = 1.0;
  for (int i = 0; i < n; ++i) {
    length += basis_->contains(i) ? rate_[i] * rate_[i] : 0.0;
  }
  const double most = settings_.dependence_tolerance * length;
  if (basis_ == &tableau_ && rate_[row] > kSafe * std::max(most, kEpsilon / least_pivot_)) {
    return false;
  }
  double product = 0.0;
  std::vector<double>& image = ray_work_;
  std::fill(image.begin(), image.end(), 0.0);
  scaled_.add_column(row, 1.0, image.data());
  for (int i = 0; i < n; ++i) {
    if (basis_->contains(i) && rate_[i] != 0.0) {
      scaled_.add_column(i, rate_[i], image.data());
    }
  }
  for (int i = 0; i < n; ++i) {
    if (basis_->contains(i)) {
      product += rate_[i] * image[i];
    }
  }
  product += image[row];
  return !(product > most);
}

bool Dantzig::exchange(int row) {
  ++pivots_;
  if (!basis_->contains(row)) {
    least_pivot_ = std::min(least_pivot_, std::abs(basis_->pivot(row)));
  }
  return basis_->exchange(row);
}

bool Dantzig::leave(int row, double bound) {
  z_[row] = bound;
  w_[row] = 0.0;
  return exchange(row);
}

/// z_C and w from the problem's own M; basic z that are out of bounds leave.
/// @return false if that does not end in finite numbers and a regular basis
bool Dantzig::refresh() {
  bool inside = false;
  while (!inside) {
    correct();
    inside = true;
    for (int i = 0; i < scaled_.size(); ++i) {
      if (!std::isfinite(z_[i]) || !std::isfinite(w_[i])) {
        return false;
      }
      if (!basis_->contains(i)) {
        continue;
      }
      const double slack = std::max(slack_z_[i], kRounding * kEpsilon * largest_z_);
      const double bound = std::min(std::max(z_[i], scaled_.lower(i)), scaled_.upper(i));
      if (std::abs(bound - z_[i]) > slack) {
        inside = false;
        if (!leave(i, bound)) {
          return false;
        }
      } else {
        z_[i] = bound;
      }
    }
  }
  return true;
}

/// Refines M_CC z_C = -(q + M_CN z_N)_C until that no longer helps.
void Dantzig::correct() {
  double best = kInfinity;
  for (int step = 0;; ++step) {
    measure();
    double residual = 0.0;
    for (int i = 0; i < scaled_.size(); ++i) {
      residual = basis_->contains(i) ? std::max(residual, std::abs(w_[i])) : residual;
    }
    if (!(residual < 0.5 * best) || step == kCorrections ||
        residual <= kEpsilon * (1.0 + largest_z_)) {
      return;
    }
    best = residual;
    work_ = w_;
    basis_->solve(work_.data());
    for (int i = 0; i < scaled_.size(); ++i) {
      z_[i] -= basis_->contains(i) ? work_[i] : 0.0;
    }
    ++refinements_;
  }
}

/// w = M z + q
void Dantzig::measure() {
  w_ = scaled_.q();
  largest_z_ = 0.0;
  for (int i = 0; i < scaled_.size(); ++i) {
    if (z_[i] != 0.0) {
      scaled_.add_column(i, z_[i], w_.data());
      largest_z_ = std::max(largest_z_, std::abs(z_[i]));
    }
  }
}

double Dantzig::violation(int row) const {
  const double w = w_[row];
  const bool wrong = w < 0.0 ? z_[row] < scaled_.upper(row) : z_[row] > scaled_.lower(row);
  return wrong && !basis_->contains(row) ? std::abs(w) : 0.0;
}

/// Twice what driving the row lowers 1/2 z.M z + q.z by, were there no bounds.
double Dantzig::weight(int row, double amount) const {
  const double curvature = basis_->pivot(row);
  return amount * amount / std::max(curvature, kLeastCurvature);
}

/// The row outside C whose w weighs most, free rows first; -1 if all are within rounding.
int Dantzig::most_violated() const {
  const double rounding = kRounding * kEpsilon * (1.0 + largest_z_);
  int worst = -1;
  double most = 0.0;
  for (int i = 0; i < scaled_.size(); ++i) {
    const double amount = violation(i);
    if (amount > std::max(slack_w_[i], rounding)) {
      const bool is_free = scaled_.lower(i) == -kInfinity && scaled_.upper(i) == kInfinity;
      const double weighted = is_free ? kInfinity : weight(i, amount);
      if (weighted > most) {
        most = weighted;
        worst = i;
      }
    }
  }
  return worst;
}

void Dantzig::describe(const Problem& problem, Result& result) const {
  const auto say = [&result](const std::string& what) {
    result.detail += (result.detail.empty() ? "" : "; ") + what;
  };
  if (const double asymmetry = SymmetricLcp::asymmetry(problem).size; asymmetry > kExactSymmetry) {
    say("M is symmetric to " + number_text(asymmetry) +
        " only: pivoted as if it were, refined on M");
  }
  if (rounds_ > 1) {
    say("coupled limits: solved " + std::to_string(rounds_) + " times");
  }
  if (dependent_moves_ > 0) {
    say("dependent rows, " + std::to_string(dependent_moves_) + " moves along null directions");
  }
}

}  // namespace signorini::lcp
