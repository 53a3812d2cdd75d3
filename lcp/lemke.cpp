#include <signorini/lcp/column_room.h>
#include <signorini/lcp/lemke.h>
#include <signorini/lcp/lemke_ray.h>
#include <signorini/lcp/number_text.h>
#include <signorini/lcp/ray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

constexpr int kQ = -1;  // BasisFactor::residual: q instead of a column
constexpr int kNone = -1;
constexpr double kSmallPivot = 1e-10;       // of the column: only taken from a fresh factorisation
constexpr double kRestartTolerance = 30.0;  // pivot tolerance grows by this a restart
constexpr int kFirstOtherBasis = 2;         // the restart that takes another first basis
constexpr unsigned kLongPathSeed = 7919;    // other covers than those of the restarts
constexpr std::int64_t kFirstPathPivots = 50;
constexpr int kMostDoublings = 30;
constexpr double kLeastShare = 1e-6;  // of the cover, of a row whose q is small
constexpr int kBasisTrials = 20;      // random bases tried until one is regular
constexpr double kGoodBasis = 1e-3;   // relative error of a solve with a usable first basis
constexpr double kFreePivot = 1e-10;  // smaller ones pass for 0 in the columns of the free rows
constexpr double kTightRay = 1e-10;   // M^T y <= 0 is met to this fraction of |M|^T y

void require(bool good, const char* setting, const char* bound, double value) {
  if (!good) {
    throw std::invalid_argument(std::string("Lemke settings: ") + setting + ": must be " + bound +
                                ", got " + number_text(value));
  }
}

bool allows_zero(const Problem& problem) {
  return (problem.lower.size() == 0 || (problem.lower.array() <= 0.0).all()) &&
         (problem.upper.size() == 0 || (problem.upper.array() >= 0.0).all());
}

}  // namespace

void LemkeSettings::validate() const {
  SolverSettings::validate();
  require(pivot_tolerance > 0.0 && pivot_tolerance <= 1e-2, "pivot_tolerance", "in (0, 1e-2]",
          pivot_tolerance);
  require(tie_tolerance > 0.0 && tie_tolerance <= 1e-2, "tie_tolerance", "in (0, 1e-2]",
          tie_tolerance);
  require(refactorisation_period >= 1, "refactorisation_period", ">= 1", refactorisation_period);
  require(refinements_per_solve >= 0 && refinements_per_solve <= 10, "refinements_per_solve",
          "in 0 .. 10", refinements_per_solve);
  require(cover_tolerance >= 0.0 && cover_tolerance <= 1e-3, "cover_tolerance", "in [0, 1e-3]",
          cover_tolerance);
  require(restarts >= 0, "restarts", ">= 0", restarts);
  require(path_budget >= 0, "path_budget", ">= 0", path_budget);
  require(polish_rounds >= 0, "polish_rounds", ">= 0", polish_rounds);
}

Lemke::Lemke(const LemkeSettings& settings) : settings_(settings) {
  settings_.validate();
}

std::string Lemke::refuses(const Problem& problem) const {
  return problem.cones.empty() ? ""
                               : "takes bounds, free rows and coupled limits, no friction cones";
}

Status Lemke::iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                      Result& result) {
  if (LcpAugmentation::is_plain(problem)) {
    return solve_plain(problem, warm_start, deadline, result);
  }
  if (problem.q.isZero(0.0) && allows_zero(problem)) {
    result.z.setZero();  // nothing but exact zeros has a residual beside q = 0
    return Status::kSolved;
  }
  augmentation_.build(problem);
  if (warm_start != nullptr) {
    augmentation_.carry(problem, *warm_start, carried_);
  }
  const Status status = solve_plain(augmentation_.augmented(),
                                    warm_start != nullptr ? &carried_ : nullptr, deadline, result);
  augmentation_.recover(best_.z(), result.z);
  result.ray.resize(0);  // a ray of the augmented problem, of which nothing is judged
  result.detail += (result.detail.empty() ? "" : "; ") + std::string("bounds as ") +
                   std::to_string(augmentation_.augmented().size() - problem.size()) +
                   " rows of their own";
  return status;
}

/// The LCP with or without free rows.
Status Lemke::solve_plain(const Problem& problem, const Vector* warm_start,
                          const Deadline& deadline, Result& result) {
  find_free_rows(problem);
  pivots_ = factorizations_ = refinements_ = restarts_ = other_bases_ = 0;
  long_paths_ = long_path_pivots_ = 0;
  early_stop_ = false;
  polish_.reset_counts();
  best_.reset(problem, settings_.tolerance);
  Status status = Status::kNumericalBreakdown;
  if (free_count_ == 0 && (problem.q.array() >= 0.0).all()) {
    status = Status::kSolved;  // z = 0
  } else if (!scaled_.assign(problem)) {
    result.detail = "M is not finite once it is formed and scaled";
  } else if (free_count_ > 0 && !complete_free_basis()) {
    result.detail = "the columns of the free rows are dependent";
  } else {
    status = run(problem, warm_start, deadline, result);
    describe(result);
  }
  result.z = best_.z();
  result.statistics.pivots = pivots_;
  result.statistics.factorizations = factorizations_ + polish_.counts().factorizations;
  result.statistics.refinements = refinements_ + polish_.counts().refinements;
  return status;
}

Status Lemke::run(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                  Result& result) {
  start_ = free_basis_;
  if (warm_start != nullptr) {
    for (Index i = 0; i < problem.size(); ++i) {
      start_[i] = (*warm_start)[i] > 0.0 || is_free_[i] != 0 ? 1 : 0;
    }
    best_.offer((Eigen::Map<const Eigen::Array<char, Eigen::Dynamic, 1>>(
                     is_free_.data(), static_cast<Index>(is_free_.size())) != 0)
                    .select(*warm_start, warm_start->cwiseMax(0.0)));
    if (polish(start_, problem, deadline)) {
      return Status::kSolved;
    }
  }
  RayVerdict verdict;
  while (true) {
    const int before = pivots_;
    switch (pivot(restarts_, problem, deadline)) {
      case Ending::kSolved: return Status::kSolved;
      case Ending::kLimit: return Status::kIterationLimit;
      case Ending::kTime: return Status::kTimeLimit;
      case Ending::kRefused: break;
      case Ending::kLong:
        ++long_paths_;
        long_path_pivots_ += pivots_ - before;
        continue;
      case Ending::kRay: {
        Vector sharpened;
        const RayVerdict found = sharpen_ray(problem, ray_, sharpened);
        if (result.ray.size() == 0 || found.bound > verdict.bound) {
          verdict = found;
          result.ray = sharpened;
        }
        if (verdict.status == Status::kInfeasible || ray_is_tight()) {
          return Status::kRayUnproven;
        }
        break;
      }
    }
    if (restarts_ == settings_.restarts) {
      return result.ray.size() > 0 ? Status::kRayUnproven : Status::kNumericalBreakdown;
    }
    ++restarts_;
  }
}

Lemke::Ending Lemke::pivot(int attempt, const Problem& problem, const Deadline& deadline) {
  if (!start(attempt)) {
    return Ending::kRefused;
  }
  if (is_feasible()) {  // the first basis is complementary and feasible
    return finish(problem, deadline) ? Ending::kSolved : Ending::kRefused;
  }
  if (pivots_ >= pivot_limit()) {
    return Ending::kLimit;
  }
  const std::int64_t give_up = pivots_ + path_limit();
  if (!enter_cover()) {
    return Ending::kRefused;
  }
  const double first_cover = x_[basis_.cover_position()];
  double finish_below = settings_.cover_tolerance * first_cover;
  while (true) {
    if (deadline.passed()) {
      offer_current();
      return Ending::kTime;
    }
    if (pivots_ >= pivot_limit()) {
      offer_current();
      return Ending::kLimit;
    }
    if (pivots_ >= give_up) {
      offer_current();
      return Ending::kLong;
    }
    if (basis_.updates() >= settings_.refactorisation_period && !refactor()) {
      return refuse();
    }
    solve_refined(entering_, y_);
    int leaving = choose_leaving();
    if (basis_.updates() > 0 &&
        (leaving == kNone || std::abs(y_[leaving]) < kSmallPivot * y_.cwiseAbs().maxCoeff())) {
      // A ray or a doubtful pivot is believed only from a fresh factorisation.
      if (!refactor()) {
        return refuse();
      }
      solve_refined(entering_, y_);
      leaving = choose_leaving();
    }
    if (leaving == kNone) {
      collect_ray();
      offer_current();
      return Ending::kRay;
    }
    const bool complementary = leaving == basis_.cover_position();
    exchange(leaving);
    if (!x_.allFinite()) {
      return refuse();
    }
    if (complementary) {
      return finish(problem, deadline) ? Ending::kSolved : Ending::kRefused;
    }
    if (x_[basis_.cover_position()] <= finish_below) {
      if (finish(problem, deadline)) {
        early_stop_ = true;
        return Ending::kSolved;
      }
      finish_below = 1e-2 * x_[basis_.cover_position()];
    }
  }
}

Lemke::Ending Lemke::refuse() {
  offer_current();
  return Ending::kRefused;
}

/// The first basis, its x, and the cover vector.
bool Lemke::start(int attempt) {
  generator_.seed(static_cast<unsigned>(attempt) + 1U + kLongPathSeed * long_paths_);
  generator_.discard(8);
  pivot_tolerance_ =
      std::min(1e-2, settings_.pivot_tolerance * std::pow(kRestartTolerance, attempt));
  if (attempt == 0 && long_paths_ == 0 && start_from(start_)) {
    return true;
  }
  start_ = free_basis_;
  if (attempt < kFirstOtherBasis) {
    return start_from(start_);
  }
  for (int trial = 0; trial < kBasisTrials; ++trial) {
    const double share = uniform();
    for (std::size_t i = 0; i < start_.size(); ++i) {
      start_[i] = uniform() < share || is_free_[i] != 0 ? 1 : 0;
    }
    if (start_from(start_)) {
      ++other_bases_;
      return true;
    }
  }
  return false;
}

bool Lemke::start_from(const std::vector<char>& active) {
  basis_.reset(scaled_, active, cover_);
  if (!refactor()) {
    return false;
  }
  draw_ratios();
  basis_.multiply(ratios_, cover_);
  // A nearly singular basis gives itself away by not reproducing its own cover vector.
  y_ = cover_;
  basis_.solve(y_);
  return (y_ - ratios_).cwiseAbs().maxCoeff() < kGoodBasis;
}

/// In [1, 2), or where paths were given up as large as the basic variables, times that.
void Lemke::draw_ratios() {
  const bool textbook = settings_.textbook_cover && restarts_ == 0 && long_paths_ == 0;
  const double largest = x_.cwiseAbs().maxCoeff();
  ratios_.resize(scaled_.size());
  for (int p = 0; p < scaled_.size(); ++p) {
    const double size =
        long_paths_ > 0 && largest > 0.0 ? std::max(std::abs(x_[p]) / largest, kLeastShare) : 1.0;
    ratios_[p] = is_free_[p] != 0 ? 0.0 : textbook ? 1.0 : size * (1.0 + uniform());
  }
}

/// Pivots after which a path is given up.
std::int64_t Lemke::path_limit() const {
  const std::int64_t first = kFirstPathPivots + static_cast<std::int64_t>(settings_.path_budget) *
                                                    static_cast<std::int64_t>(scaled_.size());
  return settings_.path_budget == 0 ? std::numeric_limits<int>::max()
                                    : first << std::min(long_paths_, kMostDoublings);
}

/// In [0, 1), the same on every machine.
double Lemke::uniform() {
  return static_cast<double>(generator_() - std::minstd_rand::min()) /
         (static_cast<double>(std::minstd_rand::max() - std::minstd_rand::min()) + 1.0);
}

bool Lemke::enter_cover() {
  int position = kNone;
  for (int p = 0; p < scaled_.size(); ++p) {
    if (is_free_[p] != 0) {
      continue;
    }
    // Of equal ratios the last: the lexicographic choice for the perturbation (e, e^2, ...) of q.
    if (position == kNone || x_[p] / ratios_[p] <= x_[position] / ratios_[position]) {
      position = p;
    }
  }
  entering_ = complement(basis_.at(position));
  basis_.exchange(position, basis_.cover_variable(), Vector(-ratios_));
  ++pivots_;
  return refactor();
}

bool Lemke::refactor() {
  ++factorizations_;
  if (!basis_.factor()) {
    return false;
  }
  solve_refined(kQ, x_);
  return x_.allFinite();
}

void Lemke::solve_refined(int variable, Vector& x) {
  if (variable == kQ) {
    x = scaled_.q();
  } else {
    basis_.column(variable, x);
  }
  basis_.solve(x);
  residual_.resize(x.size());
  for (int k = 0; k < settings_.refinements_per_solve; ++k) {
    basis_.residual(variable, x, residual_);
    basis_.solve(residual_);
    x += residual_;
    ++refinements_;
  }
}

int Lemke::choose_leaving() {
  const double smallest_pivot = pivot_tolerance_ * y_.cwiseAbs().maxCoeff();
  const double zero = 1e-15 * x_.cwiseAbs().maxCoeff();
  double ratio = std::numeric_limits<double>::infinity();
  for (Index p = 0; p < x_.size(); ++p) {
    if (y_[p] > smallest_pivot && !holds_free(static_cast<int>(p))) {
      ratio = std::min(ratio, std::max(x_[p], 0.0) / y_[p]);
    }
  }
  tied_.clear();
  for (int p = 0; p < x_.size(); ++p) {
    const double after = std::max(x_[p], 0.0) - ratio * y_[p];
    if (y_[p] > smallest_pivot && !holds_free(p) &&
        after <= settings_.tie_tolerance * std::abs(x_[p]) + zero) {
      if (p == basis_.cover_position()) {
        return p;
      }
      tied_.push_back(p);
    }
  }
  if (tied_.empty()) {
    return kNone;
  }
  return tied_.size() == 1 ? tied_.front() : break_tie();
}

int Lemke::break_tie() {
  const Index n = x_.size();
  const Index count = static_cast<Index>(tied_.size());
  make_room(tied_rows_, n, count);
  Vector& row = residual_;
  for (Index k = 0; k < count; ++k) {
    row.setZero(n);
    row[tied_[k]] = 1.0;
    basis_.solve_transposed(row);
    tied_rows_.col(k).head(n) = row / y_[tied_[k]];
  }
  std::vector<Index> left(count);
  std::iota(left.begin(), left.end(), Index{0});
  for (Index c = 0; c < n && left.size() > 1; ++c) {
    Index least = left.front();
    for (const Index k : left) {
      least = tied_rows_(c, k) < tied_rows_(c, least) ? k : least;
    }
    const double bound = tied_rows_(c, least);
    std::erase_if(left, [&](Index k) {
      const double noise =
          settings_.tie_tolerance * tied_rows_.col(k).head(n).cwiseAbs().maxCoeff();
      return tied_rows_(c, k) > bound + noise;
    });
  }
  const Index chosen = *std::max_element(
      left.begin(), left.end(), [this](Index a, Index b) { return y_[tied_[a]] < y_[tied_[b]]; });
  return tied_[chosen];
}

void Lemke::exchange(int position) {
  const double step = std::max(x_[position], 0.0) / y_[position];
  const int leaving_variable = basis_.at(position);
  x_ -= step * y_;
  x_[position] = step;
  basis_.exchange(position, entering_, y_);
  entering_ = complement(leaving_variable);
  ++pivots_;
}

bool Lemke::finish(const Problem& problem, const Deadline& deadline) {
  offer_current();
  active_.assign(scaled_.size(), 0);
  for (int p = 0; p < scaled_.size(); ++p) {
    const int j = basis_.at(p) - scaled_.size();
    if (j >= 0 && j < scaled_.size()) {
      active_[j] = 1;
    }
  }
  return polish(active_, problem, deadline);
}

bool Lemke::polish(std::vector<char> active, const Problem& problem, const Deadline& deadline) {
  const ActiveSetPolish::Settings settings{.tolerance = settings_.tolerance,
                                           .rounds = settings_.polish_rounds};
  return polish_.run(problem, scaled_, settings, deadline, active, best_);
}

void Lemke::offer_current() {
  const int n = scaled_.size();
  z_.setZero(n);
  for (int p = 0; p < n; ++p) {
    const int j = basis_.at(p) - n;
    if (j >= 0 && j < n) {
      const double x = is_free_[j] != 0 ? x_[p] : std::max(x_[p], 0.0);
      z_[j] = static_cast<double>(scaled_.unscale_z(j, x));
    }
  }
  best_.offer(z_);
}

void Lemke::collect_ray() {
  const int n = scaled_.size();
  ray_.setZero(n);
  for (int p = 0; p < n; ++p) {
    const int j = basis_.at(p) - n;
    if (j >= 0 && j < n) {
      ray_[j] = scaled_.unscale_direction(j, -y_[p]);
    }
  }
  if (const int j = entering_ - n; j >= 0) {
    ray_[j] = scaled_.unscale_direction(j, 1.0);
  }
}

/// True if the ray is one up to rounding: M^T y <= 0 and q.y < 0, measured in the scaled problem.
/// No other start will find a better one then.
bool Lemke::ray_is_tight() {
  const int n = scaled_.size();
  for (int i = 0; i < n; ++i) {
    y_[i] = std::max(0.0, scaled_.scale_dual(i, ray_[i]));
  }
  const double size = y_.maxCoeff();
  const double gain = -scaled_.q().dot(y_);
  if (!std::isfinite(size) || !(gain > kTightRay * scaled_.q().cwiseAbs().dot(y_))) {
    return false;
  }
  for (int j = 0; j < n; ++j) {
    if (!(scaled_.dot_column(j, y_) <= kTightRay * scaled_.dot_absolute_column(j, y_))) {
      return false;
    }
  }
  return true;
}

void Lemke::find_free_rows(const Problem& problem) {
  is_free_.assign(problem.size(), 0);
  free_count_ = 0;
  for (Index i = 0; problem.lower.size() > 0 && i < problem.size(); ++i) {
    if (problem.lower[i] < 0.0) {
      is_free_[i] = 1;
      ++free_count_;
    }
  }
  free_basis_ = is_free_;
}

/// Extends the free rows by rows S so that M on them is regular: each column, free ones first, is
/// eliminated with the largest pivot of the free rows, else with that of another row i, whose z_i
/// then becomes basic, too.
bool Lemke::complete_free_basis() {
  const int n = scaled_.size();
  std::vector<int> columns;
  std::vector<char> used(n, 0);
  for (int i = 0; i < n; ++i) {
    if (is_free_[i] != 0) {
      columns.push_back(i);
    }
  }
  Matrix eliminated(n, n);  // the columns so far, in the coordinates of the pivots
  std::vector<int> pivot_rows;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    Vector a = Vector::Zero(n);
    scaled_.add_column(columns[k], 1.0, a.data());
    for (std::size_t e = 0; e < k; ++e) {
      const double factor = a[pivot_rows[e]];
      a -= factor * eliminated.col(static_cast<Index>(e));
      a[pivot_rows[e]] = factor;
    }
    int pivot = kNone;
    for (const bool among_basic : {true, false}) {
      for (int i = 0; i < n; ++i) {
        const bool allowed = used[i] == 0 && (free_basis_[i] != 0) == among_basic;
        if (allowed && std::abs(a[i]) > kFreePivot &&
            (pivot == kNone || std::abs(a[i]) > std::abs(a[pivot]))) {
          pivot = i;
        }
      }
      if (pivot != kNone) {
        break;
      }
    }
    if (pivot == kNone) {
      return false;
    }
    if (free_basis_[pivot] == 0) {
      free_basis_[pivot] = 1;
      columns.push_back(pivot);
    }
    used[pivot] = 1;
    pivot_rows.push_back(pivot);
    for (int i = 0; i < n; ++i) {
      a[i] = used[i] != 0 && i != pivot ? 0.0 : a[i] / a[pivot];
    }
    a[pivot] = 0.0;
    eliminated.col(static_cast<Index>(k)) = a;
  }
  return true;
}

bool Lemke::holds_free(int position) const {
  const int j = basis_.at(position) - scaled_.size();
  return j >= 0 && j < scaled_.size() && is_free_[j] != 0;
}

/// No basic variable that must not be negative is.
bool Lemke::is_feasible() const {
  for (int p = 0; p < scaled_.size(); ++p) {
    if (x_[p] < 0.0 && !holds_free(p)) {
      return false;
    }
  }
  return true;
}

int Lemke::complement(int variable) const {
  const int n = scaled_.size();
  return variable < n ? variable + n : variable - n;
}

int Lemke::pivot_limit() const {
  return settings_.max_iterations >= 0 ? settings_.max_iterations : 20000 + 50 * scaled_.size();
}

void Lemke::describe(Result& result) const {
  std::string& text = result.detail;
  const auto say = [&text](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  if (restarts_ > 0) {
    say(std::to_string(restarts_) + " restarts with another cover vector" +
        (other_bases_ > 0 ? ", " + std::to_string(other_bases_) + " from another basis" : ""));
  }
  if (long_paths_ > 0) {
    say(std::to_string(long_paths_) + " long path" + (long_paths_ > 1 ? "s" : "") +
        " given up after " + std::to_string(long_path_pivots_) +
        " pivots for another random cover");
  }
  if (early_stop_) {
    say("stopped at z_0 <= cover_tolerance and solved at z_0 = 0");
  }
  const ActiveSetPolish::Counts& counts = polish_.counts();
  if (counts.rounds > 0) {
    say("polish changed the active set " + std::to_string(counts.rounds) + " times");
  }
  if (counts.long_double) {
    say("active set solved by a long double LU");
  }
  if (counts.orthogonal) {
    say("dependent active rows, least-norm solution");
  }
}

}  // namespace signorini::lcp
