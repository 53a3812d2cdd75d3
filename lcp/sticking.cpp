#include <signorini/lcp/contact_groups.h>
#include <signorini/lcp/sparse_cholesky.h>
#include <signorini/lcp/sticking.h>
#include <signorini/lcp/whitened_rows.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Proximal weight of the linear solves, of a unit diagonal; see ActiveSetNewton.
constexpr double kProximal = 1e-9;
constexpr int kMostProximalSteps = 12;
// The same of refine(), where a heavy body on light ones moves by as little.
constexpr double kFineProximal = 1e-12;
// Rounds of seek_inside(), and what a round must leave of the largest violation to go on.
constexpr int kMostRounds = 25;
constexpr double kHelps = 0.95;
// Rounds of the sliding contacts' friction, and what a round must leave of the change to go on.
constexpr int kMostFrictionRounds = 60;
constexpr double kContracts = 0.97;
constexpr int kFirstFrictionRounds = 4;
constexpr double kRounding = 1e-14;
// What a start that is solved must meet, of the tolerance, to be left as it is; else it is given
// this many sets, the second where the first is not much worse than the start. In a scene at rest
// the error of one step is in the q of the next, where it adds up. A slip as small as that has no
// direction.
constexpr double kAsGood = 0.01;
constexpr int kSetsToPolish = 2;
constexpr double kMuchWorse = 10.0;
// Sets so much worse than the start that may follow each other where it is not solved.
constexpr int kWorsePatience = 3;
// Steps of refine(), what one must leave of the residual to count, and how many may not.
constexpr int kMostRefinements = 60;
constexpr double kRefines = 0.9;
constexpr int kRefinePatience = 8;
// Sets that may follow each other without a better one.
constexpr int kPatience = 6;

/// Where a group stands.
enum class Contact : std::uint8_t { kOpen, kSticking, kSliding };

}  // namespace

class Sticking::Workspace {
 public:
  Status solve(const Problem& problem, const StickingSettings& settings, const Vector* warm_start,
               const Deadline& deadline, Result& result);

 private:
  void set(const Problem& problem);
  void guess();
  [[nodiscard]] bool factor(double proximal = kProximal);
  void gradient();
  void solve_linear();
  void solve_on_set();
  void seek_inside();
  bool update_friction(double& change);
  int correct();
  double consider();
  double measure_caller(const Vector& z);
  double measure_exactly(const Vector& z);
  void refine(double tolerance);
  [[nodiscard]] double row_violation(const ContactGroups::Group& group) const;

  const Problem* problem_ = nullptr;
  ContactGroups groups_;
  WhitenedRows rows_;
  std::unique_ptr<SparseCholesky> cholesky_ = make_sparse_cholesky();
  std::vector<Contact> state_;
  std::vector<char> reversed_;  // sliding contacts whose slip changed its direction
  Vector x_, g_, r_, d_, h_, dx_, u_, z_, w_, best_z_;
  std::vector<double> impulse_, velocity_;  // of the bodies, caller's units
  std::vector<long double> long_z_, long_w_, long_impulse_, long_velocity_;
  double best_ = kInfinity;
  double fine_ = 0.0;   // residuals up to this need not be known better
  double still_ = 0.0;  // a slip up to this speed does as well as none
  int factorizations_ = 0;
};

namespace {

/// w = A z. @param impulse,velocity of the bodies: memory
template <typename Scalar>
void multiply(const FactoredMatrix& A, const Scalar* z, std::vector<Scalar>& impulse,
              std::vector<Scalar>& velocity, Scalar* w) {
  impulse.resize(A.degrees_of_freedom());
  velocity.resize(A.degrees_of_freedom());
  A.transpose_times(z, impulse.data());
  A.apply_inverse_mass(impulse.data(), velocity.data());
  A.times(velocity.data(), z, w);
}

}  // namespace

/// The residuals of z by the caller's own numbers, w_ at hand afterwards.
double Sticking::Workspace::measure_caller(const Vector& z) {
  w_.resize(z.size());
  multiply(std::get<FactoredMatrix>(problem_->M), z.data(), impulse_, velocity_, w_.data());
  w_ += problem_->q;
  const double residual = groups_.residual(*problem_, z, w_, fine_);
  if (residual < best_) {
    best_ = residual;
    best_z_ = z;
  }
  return residual;
}

/// The same with w_ to all its digits: beside a large z its product in double has none.
double Sticking::Workspace::measure_exactly(const Vector& z) {
  long_z_.assign(z.begin(), z.end());
  long_w_.resize(long_z_.size());
  multiply(std::get<FactoredMatrix>(problem_->M), long_z_.data(), long_impulse_, long_velocity_,
           long_w_.data());
  for (Index i = 0; i < z.size(); ++i) {
    w_[i] = static_cast<double>(long_w_[i] + problem_->q[i]);
  }
  return groups_.residual(*problem_, z, w_, 0.0);
}

/// Proximal steps on the set from best_z_, whose residuals are known exactly: with large mass
/// ratios those of solve_linear() hide, in the rounding of the light bodies' velocities, that
/// heavy ones still move.
void Sticking::Workspace::refine(double tolerance) {
  if (!factor(kFineProximal)) {
    return;
  }
  z_ = best_z_;
  double least = best_ = measure_exactly(z_);
  int without = 0;
  for (int step = 0; step < kMostRefinements && best_ > tolerance; ++step) {
    h_ = -(d_.array() > 0.0).select(w_.cwiseQuotient(rows_.scale()), 0.0);
    dx_ = d_.cwiseProduct(h_);
    rows_.transpose_times(dx_, u_);
    cholesky_->solve(u_);
    rows_.times(u_, dx_);
    dx_ = d_.cwiseProduct(h_ - dx_);
    z_ += dx_.cwiseQuotient(rows_.scale());
    groups_.clamp(z_);
    const double residual = measure_exactly(z_);
    if (residual < best_) {
      best_ = residual;
      best_z_ = z_;
    }
    without = residual < kRefines * least ? 0 : without + 1;
    least = std::min(least, residual);
    if (without > kRefinePatience || !std::isfinite(residual)) {
      return;
    }
  }
}

void Sticking::Workspace::set(const Problem& problem) {
  rows_.set(std::get<FactoredMatrix>(problem.M), groups_.starts());
  g_ = problem.q.cwiseQuotient(rows_.scale());
  d_.setZero(rows_.rows());
  cholesky_->analyse(rows_.body_space_matrix(d_));
  factorizations_ = 0;
}

/// The set that z_ and its w_ point at.
void Sticking::Workspace::guess() {
  x_ = z_.cwiseProduct(rows_.scale());
  state_.resize(groups_.size());
  reversed_.assign(groups_.size(), 0);
  for (std::size_t c = 0; c < groups_.size(); ++c) {
    const auto& [first, dimension, mu, is_free] = groups_[c];
    const bool carries = z_[first] > 0.0;
    state_[c] = is_free || carries || w_[first] < 0.0 ? Contact::kSticking : Contact::kOpen;
    if (dimension > 1 && carries) {
      const double limit = mu * z_[first];
      const double friction = z_.segment(first + 1, dimension - 1).norm();
      const double power =
          z_.segment(first + 1, dimension - 1).dot(w_.segment(first + 1, dimension - 1));
      if (friction >= (1.0 - 1e-9) * limit && power < 0.0) {
        state_[c] = Contact::kSliding;
      }
    }
  }
}

/// Factors for the set: rows that do not move have d = 0.
bool Sticking::Workspace::factor(double proximal) {
  for (std::size_t c = 0; c < groups_.size(); ++c) {
    const auto& [first, dimension, mu, is_free] = groups_[c];
    for (int k = 0; k < dimension; ++k) {
      const bool moves =
          state_[c] == Contact::kSticking || (state_[c] == Contact::kSliding && k == 0);
      d_[first + k] = moves ? 1.0 / (rows_.compliance()[first + k] + proximal) : 0.0;
    }
  }
  ++factorizations_;
  return cholesky_->factor(rows_.body_space_matrix(d_));
}

/// r_ = A x + g.
void Sticking::Workspace::gradient() {
  rows_.transpose_times(x_, u_);
  rows_.times(u_, r_);
  r_ += rows_.compliance().cwiseProduct(x_) + g_;
}

/// Proximal steps until the velocity of the rows that move no longer halves.
void Sticking::Workspace::solve_linear() {
  const double rounding = 1e-15 * (g_.cwiseAbs().maxCoeff() + x_.cwiseAbs().maxCoeff());
  double before = kInfinity;
  for (int step = 0;; ++step) {
    gradient();
    h_ = -(d_.array() > 0.0).select(r_, 0.0);
    const double most = h_.cwiseAbs().maxCoeff();
    if (!(most < 0.5 * before) || most <= rounding || step == kMostProximalSteps) {
      return;
    }
    before = most;
    dx_ = d_.cwiseProduct(h_);
    rows_.transpose_times(dx_, u_);
    cholesky_->solve(u_);
    rows_.times(u_, dx_);
    dx_ = d_.cwiseProduct(h_ - dx_);
    x_ += dx_;
  }
}

/// How far the group's x is from what its state allows.
double Sticking::Workspace::row_violation(const ContactGroups::Group& group) const {
  if (group.is_free) {
    return 0.0;
  }
  const double* x = x_.data() + group.first;
  return group.dimension == 1 ? std::max(-x[0], 0.0) : cone_violation(group.mu, group.dimension, x);
}

/// Of the plane of solutions on the set, one inside the cones: what is outside is mirrored at its
/// nearest point inside and the plane is gone back to.
void Sticking::Workspace::seek_inside() {
  double before = kInfinity;
  for (int round = 0; round < kMostRounds; ++round) {
    double most = 0.0;
    for (std::size_t c = 0; c < groups_.size(); ++c) {
      if (state_[c] == Contact::kSticking) {
        most = std::max(most, row_violation(groups_[c]));
      }
    }
    if (most == 0.0 || most > kHelps * before) {
      return;
    }
    before = most;
    for (std::size_t c = 0; c < groups_.size(); ++c) {
      if (state_[c] == Contact::kSticking && row_violation(groups_[c]) > 0.0) {
        groups_.reflect(c, x_);
      }
    }
    solve_linear();
  }
}

/// z_T = -mu z_N w_T/|w_T| where a contact slides; where it does as good as not, the direction is
/// rounding and that of z_T is kept. @return whether any moved; `change`: the most
bool Sticking::Workspace::update_friction(double& change) {
  change = 0.0;
  for (std::size_t c = 0; c < groups_.size(); ++c) {
    if (state_[c] != Contact::kSliding) {
      continue;
    }
    const auto& [first, dimension, mu, is_free] = groups_[c];
    auto friction = x_.segment(first + 1, dimension - 1);
    const auto slip = r_.segment(first + 1, dimension - 1);
    const double speed = slip.norm();
    const double size = friction.norm();
    const double limit = mu * std::max(x_[first], 0.0);
    h_.resize(x_.size());
    auto next = h_.segment(first + 1, dimension - 1);
    if (speed * rows_.scale()[first] > still_ || (speed > 0.0 && size == 0.0)) {
      next = -limit / speed * slip;
    } else if (size > 0.0) {
      next = limit / size * friction;
    } else {
      next = friction;
    }
    if (next.dot(friction) < 0.0) {
      reversed_[c] = 1;
    }
    change = std::max(change, (next - friction).cwiseAbs().maxCoeff());
    friction = next;
  }
  return change > 0.0;
}

/// The solution on the set. Afterwards r_ is that of x_.
void Sticking::Workspace::solve_on_set() {
  for (std::size_t c = 0; c < groups_.size(); ++c) {
    if (state_[c] == Contact::kOpen) {
      x_.segment(groups_[c].first, groups_[c].dimension).setZero();
    }
  }
  reversed_.assign(groups_.size(), 0);
  solve_linear();
  double before = kInfinity;
  double change = 0.0;
  for (int round = 0; update_friction(change); ++round) {
    const bool settles = change <= kRounding * x_.cwiseAbs().maxCoeff();
    const bool contracts = round < kFirstFrictionRounds || change < kContracts * before;
    if (settles || !contracts || round == kMostFrictionRounds) {
      break;
    }
    before = change;
    solve_linear();
  }
  seek_inside();
}

/// The larger residual of x_, put inside the cones.
double Sticking::Workspace::consider() {
  z_ = x_.cwiseQuotient(rows_.scale());
  groups_.clamp(z_);
  return measure_caller(z_);
}

/// Contacts whose wish is not granted change sides: first the normals, then friction.
/// @return how many did
int Sticking::Workspace::correct() {
  const double rounding = kRounding * (g_.cwiseAbs().maxCoeff() + x_.cwiseAbs().maxCoeff());
  int wrong = 0;
  for (std::size_t c = 0; c < groups_.size(); ++c) {
    const int first = groups_[c].first;
    if (groups_[c].is_free) {
      continue;
    }
    const bool pulls = state_[c] != Contact::kOpen && x_[first] < -rounding;
    const bool closes = state_[c] == Contact::kOpen && r_[first] < -rounding;
    if (pulls || closes) {
      state_[c] = pulls ? Contact::kOpen : Contact::kSticking;
      ++wrong;
    }
  }
  if (wrong > 0) {
    return wrong;
  }
  for (std::size_t c = 0; c < groups_.size(); ++c) {
    const auto& [first, dimension, mu, is_free] = groups_[c];
    if (dimension == 1) {
      continue;
    }
    if (state_[c] == Contact::kSticking && row_violation(groups_[c]) > rounding) {
      state_[c] = Contact::kSliding;  // against the way that sticking would push
      auto friction = x_.segment(first + 1, dimension - 1);
      const double size = friction.norm();  // 0: only the normal is outside, by rounding
      friction *= size > 0.0 ? mu * std::max(x_[first], 0.0) / size : 0.0;
      ++wrong;
    } else if (state_[c] == Contact::kSliding && reversed_[c] != 0) {
      state_[c] = Contact::kSticking;
      ++wrong;
    }
  }
  return wrong;
}

Status Sticking::Workspace::solve(const Problem& problem, const StickingSettings& settings,
                                  const Vector* warm_start, const Deadline& deadline,
                                  Result& result) {
  constexpr double kBelow = 0.5;  // the certificate has the last word
  problem_ = &problem;
  fine_ = 0.1 * kAsGood * settings.tolerance;
  result.statistics = {.iterations = 0, .factorizations = 0};
  groups_.set(problem);
  best_ = kInfinity;
  best_z_.setZero(problem.size());
  z_ = best_z_;
  if (warm_start != nullptr) {
    z_ = *warm_start;
    groups_.clamp(z_);
  }
  const double start = measure_caller(z_);
  if (start <= kAsGood * settings.tolerance) {
    result.z = z_;
    return Status::kStalled;  // solved: the certificate will say so
  }
  still_ = kAsGood * settings.tolerance * problem.q.cwiseAbs().maxCoeff();
  set(problem);
  guess();
  int most =
      settings.max_iterations >= 0 ? settings.max_iterations : StickingSettings::kDefaultSets;
  const bool polishes = start <= settings.tolerance;
  if (polishes) {
    most = std::min(most, kSetsToPolish);
  }
  Status ending = Status::kIterationLimit;
  int without = 0;
  int worse = 0;
  double least = kInfinity;
  for (int k = 0; k < most; ++k) {
    if (deadline.passed()) {
      ending = Status::kTimeLimit;
      break;
    }
    if (!factor()) {
      ending = Status::kNumericalBreakdown;
      break;
    }
    ++result.statistics.iterations;
    solve_on_set();
    const double residual = consider();
    without = residual < 0.9 * least ? 0 : without + 1;
    least = std::min(residual, least);
    const bool solved = residual <= kBelow * settings.tolerance;
    worse = warm_start != nullptr && residual > kMuchWorse * start ? worse + 1 : 0;
    const bool is_far = worse == (polishes ? 1 : kWorsePatience);
    ending = Status::kStalled;
    if (solved || without > kPatience) {
      break;
    }
    if (correct() == 0) {  // the right set, but for rounding
      refine(kBelow * settings.tolerance);
      break;
    }
    if (is_far) {
      break;
    }
    ending = Status::kIterationLimit;
  }
  result.statistics.factorizations = factorizations_;
  result.statistics.factor_bytes = static_cast<std::int64_t>(cholesky_->counts().bytes);
  result.z = best_z_;
  return ending;
}

Sticking::Sticking(const StickingSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>()) {
  settings_.validate();
}

Sticking::~Sticking() = default;

std::string Sticking::refuses(const Problem& problem) const {
  if (!std::holds_alternative<FactoredMatrix>(problem.M)) {
    return "takes a factored M";
  }
  if (!problem.limits.empty()) {
    return "takes no coupled limits; row " + std::to_string(problem.limits.front().row) +
           " has one";
  }
  return ContactGroups::refuses(problem);
}

Status Sticking::iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                         Result& result) {
  return workspace_->solve(problem, settings_, warm_start, deadline, result);
}

}  // namespace signorini::lcp
