#include <signorini/lcp/lemke_ray.h>
#include <signorini/lcp/number_text.h>
#include <signorini/lcp/structured_lemke.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kCrashPivot = 1e-6;  // smaller pivots are left out of the first basis
constexpr double kCheckBelow = 1e-5;  // smaller Schur complements are recomputed from M
constexpr double kRounding = 4.0;     // roundings of the largest basic variable that are zero
constexpr int kRefreshPeriod = 100;   // pivots between two evaluations of the basis from M
constexpr int kCorrections = 10;      // refinement steps at most

void require(bool good, const char* setting, const char* bound, double value) {
  if (!good) {
    throw std::invalid_argument(std::string("StructuredLemke settings: ") + setting + ": must be " +
                                bound + ", got " + number_text(value));
  }
}

}  // namespace

void StructuredLemkeSettings::validate() const {
  SolverSettings::validate();
  require(dependence_tolerance > 0.0 && dependence_tolerance <= 1e-3, "dependence_tolerance",
          "in (0, 1e-3]", dependence_tolerance);
  require(stop_tolerance >= 0.0 && stop_tolerance <= 1e-3, "stop_tolerance", "in [0, 1e-3]",
          stop_tolerance);
  require(crash_sweeps >= 0, "crash_sweeps", ">= 0", crash_sweeps);
  require(restarts >= 0, "restarts", ">= 0", restarts);
}

StructuredLemke::StructuredLemke(const StructuredLemkeSettings& settings) : settings_(settings) {
  settings_.validate();
}

std::string StructuredLemke::refuses(const Problem& problem) const {
  if (!problem.is_lcp()) {
    return "takes an LCP only: every row 0 <= z_i, w_i >= 0";
  }
  const std::string asymmetry = SymmetricLcp::find_asymmetry(problem);
  return asymmetry.empty() ? "" : "takes a symmetric M; " + asymmetry;
}

Status StructuredLemke::iterate(const Problem& problem, const Vector* warm_start,
                                const Deadline& deadline, Result& result) {
  pivots_ = refinements_ = factorizations_ = double_exchanges_ = 0;
  best_.reset(problem, settings_.tolerance);
  if (!scaled_.assign(problem)) {
    result.z = best_.z();
    result.detail = "M is not finite once it is formed and scaled";
    return Status::kNumericalBreakdown;
  }
  Status status = Status::kNumericalBreakdown;
  for (attempt_ = 0; attempt_ <= settings_.restarts; ++attempt_) {
    guess(problem, warm_start, attempt_);
    const Ending ending = start(attempt_) ? follow(deadline) : Ending::kBreakdown;
    factorizations_ += basis_->factorizations();
    if (ending == Ending::kRay) {
      collect_ray(ray_row_, result, problem);
      status = Status::kRayUnproven;
      if (judge_ray(problem, result.ray).status == Status::kInfeasible) {
        break;
      }
      continue;
    }
    offer();
    status = ending == Ending::kLimit  ? Status::kIterationLimit
             : ending == Ending::kTime ? Status::kTimeLimit
                                       : Status::kNumericalBreakdown;
    if (ending == Ending::kLimit || ending == Ending::kTime ||
        is_solved(judge(best_.certificate(), settings_.tolerance, Status::kStalled))) {
      break;
    }
  }
  result.z = best_.z();
  result.statistics.pivots = pivots_;
  result.statistics.factorizations = factorizations_;
  result.statistics.refinements = refinements_;
  describe(result.detail);
  return status;
}

/// Allocates nothing where the text has had the room.
void StructuredLemke::describe(std::string& detail) const {
  const auto say = [&detail](const char* what, int count, const char* of_what) {
    detail += detail.empty() ? "" : "; ";
    detail += what;
    detail += std::to_string(count);
    detail += of_what;
  };
  if (attempt_ > 0) {
    detail += detail.empty() ? "" : "; ";
    detail += "restarted with another d";
  }
  if (first_size_ > 0) {
    say("from a first basis of ", first_size_, " rows");
  }
  if (double_exchanges_ > 0) {
    say("dependent rows, ", double_exchanges_, " double exchanges");
  }
}

/// The rows that the first basis should have.
void StructuredLemke::guess(const Problem& problem, const Vector* warm_start, int attempt) {
  const int n = scaled_.size();
  first_.assign(n, 0);
  z_.assign(n, 0.0);
  if (attempt > 0) {
    return;
  }
  if (warm_start != nullptr) {
    for (int i = 0; i < n; ++i) {
      first_[i] = (*warm_start)[i] > 0.0 ? 1 : 0;
    }
    return;
  }
  if ((problem.q.array() >= 0.0).all() || settings_.crash_sweeps == 0) {
    return;
  }
  x_q_ = scaled_.q();
  for (int k = 0; k < settings_.crash_sweeps; ++k) {
    sweep();
  }
  for (int i = 0; i < n; ++i) {
    first_[i] = z_[i] > 0.0 ? 1 : 0;
  }
}

/// One projected Gauss-Seidel sweep over z_, with w in x_q_.
void StructuredLemke::sweep() {
  for (int i = 0; i < scaled_.size(); ++i) {
    const double d = scaled_.diagonal(i);
    if (d > 0.0) {
      const double step = std::max(-z_[i], -x_q_[i] / d);
      if (step != 0.0) {
        z_[i] += step;
        scaled_.add_column(i, step, x_q_.data());
      }
    }
  }
}

/// The first basis and a d for which its variables grow with lambda.
bool StructuredLemke::start(int attempt) {
  const int n = scaled_.size();
  basis_ = &tableau_;
  if (!scaled_.is_dense() && n > kTableauRows) {
    basis_ = &factor_;
  }
  basis_->reset(scaled_);
  rate_.resize(n);
  work_.resize(n);
  x_q_.resize(n);
  x_d_.resize(n);
  d_.resize(n);
  first_size_ = 0;
  if (std::any_of(first_.begin(), first_.end(), [](char c) { return c != 0; })) {
    first_size_ = basis_->load(first_, kCrashPivot);
  }
  generator_.seed(static_cast<unsigned>(attempt) + 1U);
  generator_.discard(8);
  for (double& rate : rate_) {
    rate = 0.5 + static_cast<double>(generator_() - std::minstd_rand::min()) /
                     static_cast<double>(std::minstd_rand::max() - std::minstd_rand::min());
  }
  for (int i = 0; i < n; ++i) {
    d_[i] = basis_->contains(i) ? 0.0 : rate_[i];
  }
  for (int i = 0; i < n; ++i) {
    if (basis_->contains(i)) {
      scaled_.add_column(i, -rate_[i], d_.data());
    }
  }
  refresh();
  return std::all_of(x_q_.begin(), x_q_.end(), [](double x) { return std::isfinite(x); });
}

StructuredLemke::Ending StructuredLemke::follow(const Deadline& deadline) {
  const int limit =
      settings_.max_iterations >= 0 ? settings_.max_iterations : 1000 + 50 * scaled_.size();
  int look = 0;  // at the clock, if it is asked
  double lambda = kInfinity;
  const double d_size = std::abs(*std::max_element(
      d_.begin(), d_.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  while (true) {
    double at = 0.0;
    const int row = first_to_vanish(lambda, at);
    if (row < 0 || at * d_size <= settings_.stop_tolerance) {
      return Ending::kFinished;
    }
    if (pivots_ >= limit) {
      return Ending::kLimit;
    }
    if (deadline.passed_at(look++, scaled_.size())) {
      return Ending::kTime;
    }
    lambda = std::min(lambda, at);
    basis_->column(row, rate_.data());
    if (!basis_->contains(row) && depends(row)) {
      const int block = null_block(lambda);
      if (block < 0) {
        ray_row_ = row;
        return Ending::kRay;
      }
      ++double_exchanges_;
      basis_->column(block, rate_.data());
      if (!pivot(block)) {
        return Ending::kBreakdown;
      }
      basis_->column(row, rate_.data());
    }
    if (!pivot(row)) {
      return Ending::kBreakdown;
    }
    if (since_refresh_ >= kRefreshPeriod) {
      refresh();
    }
  }
}

/// The basic variable that vanishes first as lambda falls, -1 if none does before 0; Harris's two
/// passes.
int StructuredLemke::first_to_vanish(double lambda, double& at) const {
  // Negative at lambda = 0 beyond rounding.
  const int n = scaled_.size();
  double largest = 0.0;
  for (int i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(x_q_[i]));
  }
  const double zero = kRounding * kEpsilon * (1.0 + largest);
  double bound = 0.0;
  for (int i = 0; i < n; ++i) {
    if (x_d_[i] > 0.0 && x_q_[i] < -zero) {
      bound = std::max(bound, std::min(lambda, -(x_q_[i] + zero) / x_d_[i]));
    }
  }
  int found = -1;
  double strongest = 0.0;
  for (int i = 0; i < n; ++i) {
    if (x_d_[i] > strongest && x_q_[i] < -zero && -x_q_[i] >= bound * x_d_[i]) {
      strongest = x_d_[i];
      found = i;
    }
  }
  at = found >= 0 ? std::min(lambda, -x_q_[found] / x_d_[found]) : 0.0;
  return found;
}

/// Whether a row outside C depends on C; rate_ must be its column. See Dantzig.
bool StructuredLemke::depends(int row) {
  if (rate_[row] > kCheckBelow) {
    return false;
  }
  std::fill(work_.begin(), work_.end(), 0.0);
  scaled_.add_column(row, 1.0, work_.data());
  double length = 1.0;
  for (int i = 0; i < scaled_.size(); ++i) {
    if (basis_->contains(i) && rate_[i] != 0.0) {
      scaled_.add_column(i, rate_[i], work_.data());
      length += rate_[i] * rate_[i];
    }
  }
  double product = work_[row];
  for (int i = 0; i < scaled_.size(); ++i) {
    product += basis_->contains(i) ? rate_[i] * work_[i] : 0.0;
  }
  return !(product > settings_.dependence_tolerance * length);
}

/// The basic z that vanishes first along rate_, at this lambda; -1 if none.
int StructuredLemke::null_block(double lambda) const {
  double largest = 1.0;
  for (int i = 0; i < scaled_.size(); ++i) {
    largest = basis_->contains(i) ? std::max(largest, std::abs(rate_[i])) : largest;
  }
  int found = -1;
  double least = kInfinity;
  for (int i = 0; i < scaled_.size(); ++i) {
    if (basis_->contains(i) && rate_[i] < -1e-10 * largest) {
      const double step = std::max(0.0, x_q_[i] + lambda * x_d_[i]) / -rate_[i];
      if (step < least) {
        least = step;
        found = i;
      }
    }
  }
  return found;
}

/// Exchanges z_row and w_row; rate_ must be the row's column.
bool StructuredLemke::pivot(int row) {
  const double pivot = rate_[row];
  if (!(pivot > 0.0)) {
    return false;
  }
  for (std::vector<double>* x : {&x_q_, &x_d_}) {
    const double entering = -(*x)[row] / pivot;
    for (int i = 0; i < scaled_.size(); ++i) {
      (*x)[i] += entering * rate_[i];
    }
    (*x)[row] = entering;
  }
  ++pivots_;
  ++since_refresh_;
  return basis_->exchange(row);
}

/// x: z_C with M_CC z_C = -right_C, refined, and right + M z elsewhere.
void StructuredLemke::evaluate(const std::vector<double>& right, std::vector<double>& x) {
  const int n = scaled_.size();
  z_.assign(n, 0.0);
  double best = kInfinity;
  for (int step = 0;; ++step) {
    x = right;
    double size = 0.0;
    for (int i = 0; i < n; ++i) {
      if (z_[i] != 0.0) {
        scaled_.add_column(i, z_[i], x.data());
        size = std::max(size, std::abs(z_[i]));
      }
    }
    double residual = 0.0;
    for (int i = 0; i < n; ++i) {
      residual = basis_->contains(i) ? std::max(residual, std::abs(x[i])) : residual;
    }
    if (!(residual < 0.5 * best) || step == kCorrections || residual <= kEpsilon * (1.0 + size)) {
      break;
    }
    best = residual;
    work_ = x;
    basis_->solve(work_.data());
    for (int i = 0; i < n; ++i) {
      z_[i] -= basis_->contains(i) ? work_[i] : 0.0;
    }
    ++refinements_;
  }
  for (int i = 0; i < n; ++i) {
    x[i] = basis_->contains(i) ? z_[i] : x[i];
  }
}

void StructuredLemke::refresh() {
  since_refresh_ = 0;
  evaluate(scaled_.q(), x_q_);
  evaluate(d_, x_d_);
}

/// The z of the basis at lambda = 0, negative ones (rounding, or an unfinished path) as 0.
void StructuredLemke::offer() {
  evaluate(scaled_.q(), x_q_);
  answer_.setZero(scaled_.size());
  for (int i = 0; i < scaled_.size(); ++i) {
    answer_[i] = basis_->contains(i) ? scaled_.unscale_z(i, std::max(0.0, x_q_[i])) : 0.0;
  }
  best_.offer_answer(answer_, settings_.quick_certificate);
}

void StructuredLemke::certify(const Problem& problem, Result& result) {
  if (!best_.take_over(result.certificate, result.w)) {
    Solver::certify(problem, result);
  }
}

/// rate_, the null direction that nothing blocks, as a ray.
void StructuredLemke::collect_ray(int row, Result& result, const Problem& problem) {
  Vector ray = Vector::Zero(scaled_.size());
  for (int i = 0; i < scaled_.size(); ++i) {
    if (basis_->contains(i)) {
      ray[i] = scaled_.unscale_direction(i, std::max(0.0, rate_[i]));
    }
  }
  ray[row] = scaled_.unscale_direction(row, 1.0);
  (void)sharpen_ray(problem, ray, result.ray);
}

}  // namespace signorini::lcp
