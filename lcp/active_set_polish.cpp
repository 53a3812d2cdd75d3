#include <signorini/lcp/active_set_polish.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// w_i of an active row counts as zero at this many roundings of (|M||z| + |q|)_i.
constexpr double kVanishes = 2.0;
// A wrong sign is one beyond this many roundings.
constexpr double kWrongSign = 16.0;
// Smallest to largest pivot of an LU below which its rows are taken as dependent.
constexpr double kDependent = 1e-15;
constexpr double kRankThreshold = 1e-13;

}  // namespace

bool ActiveSetPolish::run(const Problem& problem, const ScaledLcp& scaled, const Settings& settings,
                          const Deadline& deadline, std::vector<char>& active, BestIterate& best) {
  problem_ = &problem;
  scaled_ = &scaled;
  settings_ = settings;
  active_ = &active;
  for (int i = 0; i < scaled.size(); ++i) {
    active[i] = active[i] != 0 || is_free(i) ? 1 : 0;
  }
  const auto solved = [&] {
    return is_solved(judge(best.certificate(), settings.tolerance, Status::kStalled));
  };
  for (int round = 0;; ++round) {
    solve_active();
    best.offer(rounded_);
    if (solved() || round == settings.rounds || deadline.passed()) {
      break;
    }
    // All at once while that may converge fast, then one at a time, which does not cycle as easily.
    if (!change_sides(2 * round < settings.rounds)) {
      break;
    }
    ++counts_.rounds;
  }
  return solved();
}

bool ActiveSetPolish::solve_active() {
  const int n = scaled_->size();
  alpha_.clear();
  place_.assign(n, -1);
  for (int i = 0; i < n; ++i) {
    if ((*active_)[i] != 0) {
      place_[i] = static_cast<int>(alpha_.size());
      alpha_.push_back(i);
    }
  }
  const Index k = static_cast<Index>(alpha_.size());
  compact_.setZero(k, k);
  for (Index j = 0; j < k; ++j) {
    scaled_->gather_column(alpha_[j], place_, compact_.col(j).data());
  }
  z_.assign(n, 0.0L);
  if (k == 0) {
    evaluate();
    return true;
  }
  ++counts_.factorizations;
  const Eigen::PartialPivLU<Matrix> lu(compact_);
  const auto pivots = lu.matrixLU().diagonal().cwiseAbs().eval();
  if (pivots.minCoeff() > kDependent * pivots.maxCoeff()) {
    if (refine(lu, double{})) {
      return true;
    }
    ++counts_.factorizations;
    counts_.long_double = true;
    const Eigen::PartialPivLU<LongMatrix> long_lu(compact_.cast<long double>());
    if (refine(long_lu, 0.0L)) {
      return true;
    }
  }
  ++counts_.factorizations;
  counts_.orthogonal = true;
  Eigen::CompleteOrthogonalDecomposition<Matrix> orthogonal;
  orthogonal.setThreshold(kRankThreshold);
  orthogonal.compute(compact_);
  return refine(orthogonal, double{});
}

template <typename Factor, typename Scalar>
bool ActiveSetPolish::refine(const Factor& factor, Scalar /*precision*/) {
  const int n = scaled_->size();
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> right(alpha_.size());
  z_.assign(n, 0.0L);
  std::vector<long double> best_z = z_;
  double best_error = std::numeric_limits<double>::infinity();
  for (int step = 0;; ++step) {
    const double error = evaluate();
    const bool better = error < best_error;
    if (better) {
      best_z = z_;
    }
    const bool stagnates = !(error < 0.5 * best_error) && step > 1;
    best_error = std::min(error, best_error);
    if (step > settings_.refinements || stagnates || !std::isfinite(error)) {
      break;
    }
    for (std::size_t k = 0; k < alpha_.size(); ++k) {
      right[k] = static_cast<Scalar>(-scaled_w_[alpha_[k]]);
    }
    right = factor.solve(right);
    for (std::size_t k = 0; k < alpha_.size(); ++k) {
      z_[alpha_[k]] += scaled_->unscale_z(alpha_[k], static_cast<long double>(right[k]));
    }
    counts_.refinements += step > 0 ? 1 : 0;
  }
  z_ = best_z;
  evaluate();
  return best_error <= kVanishes * kEpsilon;
}

/// From z_: w_, its scaled form, the magnitudes and the clamped z.
/// @return max |w'_i| / (|M'||z'| + |q'|)_i over the active i.
double ActiveSetPolish::evaluate() {
  const int n = scaled_->size();
  w_.resize(n);
  multiply(problem_->M, z_.data(), w_.data());
  scaled_w_.resize(n);
  rounded_.resize(n);
  magnitude_ = scaled_->q().cwiseAbs();
  for (const int j : alpha_) {
    const double z = std::abs(static_cast<double>(scaled_->scale_z(j, z_[j])));
    scaled_->add_absolute_column(j, z, magnitude_.data());
  }
  double worst = 0.0;
  for (int i = 0; i < n; ++i) {
    w_[i] += problem_->q[i];
    scaled_w_[i] = scaled_->scale_w(i, w_[i]);
    const double rounded = static_cast<double>(z_[i]);
    rounded_[i] = is_free(i) ? rounded : std::max(0.0, rounded);
    if (place_[i] >= 0) {
      // A row with q_i = 0 (a friction cone) has magnitude 0 at z = 0: no error, not 0 / 0.
      const double error =
          scaled_w_[i] == 0.0L ? 0.0 : static_cast<double>(std::abs(scaled_w_[i])) / magnitude_[i];
      worst = error <= worst ? worst : error;  // keeps a NaN
    }
  }
  return worst;
}

bool ActiveSetPolish::is_free(int i) const {
  return problem_->lower.size() > 0 && problem_->lower[i] < 0.0;
}

/// Puts indices with a wrong sign on the other side: all of them, or the worst one.
/// @return false if there is none.
bool ActiveSetPolish::change_sides(bool all) {
  const double largest_z = [this] {
    double largest = 0.0;
    for (const int i : alpha_) {
      largest = std::max(largest, std::abs(static_cast<double>(scaled_->scale_z(i, z_[i]))));
    }
    return largest;
  }();
  int worst = -1;
  double worst_size = 0.0;
  bool changed = false;
  for (int i = 0; i < scaled_->size(); ++i) {
    if (is_free(i)) {
      continue;
    }
    const bool is_active = place_[i] >= 0;
    const double value = static_cast<double>(is_active ? scaled_->scale_z(i, z_[i]) : scaled_w_[i]);
    const double rounding = kWrongSign * kEpsilon * (is_active ? largest_z : magnitude_[i]);
    if (!(value < -rounding)) {
      continue;
    }
    if (all) {
      (*active_)[i] = is_active ? 0 : 1;
      changed = true;
    } else if (-value > worst_size) {
      worst = i;
      worst_size = -value;
    }
  }
  if (worst >= 0) {
    (*active_)[worst] = place_[worst] >= 0 ? 0 : 1;
    changed = true;
  }
  return changed;
}

}  // namespace signorini::lcp
