#include <signorini/lcp/back_end.h>
#include <signorini/lcp/refined_lu.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr double kEnough = 1e-12;
constexpr int kRefinements = 3;

}  // namespace

void RefinedLu::analyse(const View& matrix) {
  const BackEndScope scope;  // an analysis allocates
  free_.reset_bytes();
  block_.analyse(matrix);
}

bool RefinedLu::factor(const View& matrix) {
  outer_ = matrix.outerIndexPtr();
  inner_ = matrix.innerIndexPtr();
  values_ = matrix.valuePtr();
  columns_ = static_cast<int>(matrix.cols());
  pivots_freely_ = !block_.factor(matrix);
  return !pivots_freely_ || factor_freely();
}

bool RefinedLu::factor_freely() {
  pivots_freely_ = true;
  if (columns_ > kFreeColumns) {
    return false;
  }
  const View matrix(columns_, columns_, outer_[columns_], outer_, inner_, values_);
  free_.analyse(matrix);
  return free_.factor(matrix);
}

/// max_i |b - M x|_i / (|M| |x| + |b|)_i (Oettli, Prager 1964), b in right_; leaves b - M x in
/// residual_.
double RefinedLu::backward_error(std::span<const double> x) {
  residual_ = right_;
  size_.resize(right_.size());
  std::ranges::transform(right_, size_.begin(), [](double b) { return std::abs(b); });
  for (int c = 0; c < columns_; ++c) {
    for (int k = outer_[c]; k < outer_[c + 1]; ++k) {
      const double term = values_[k] * x[c];
      residual_[inner_[k]] -= term;
      size_[inner_[k]] += std::abs(term);
    }
  }
  double worst = 0.0;
  for (int i = 0; i < columns_; ++i) {
    if (!std::isfinite(residual_[i])) {
      return std::numeric_limits<double>::infinity();
    }
    if (residual_[i] != 0.0) {
      worst = std::max(worst, std::abs(residual_[i]) / size_[i]);
    }
  }
  return worst;
}

bool RefinedLu::solve(std::span<double> x) {
  if (!std::ranges::all_of(x, [](double value) { return std::isfinite(value); })) {
    return false;
  }
  if (!pivots_freely_) {
    right_.assign(x.begin(), x.end());
    block_.solve(x);
    for (int k = 0; backward_error(x) > kEnough; ++k) {
      if (k == kRefinements) {
        std::ranges::copy(right_, x.begin());
        if (!factor_freely()) {
          return false;
        }
        break;
      }
      block_.solve(residual_);
      std::ranges::transform(x, residual_, x.begin(), std::plus());
    }
  }
  if (pivots_freely_) {
    free_.solve(x);
  }
  return true;
}

}  // namespace signorini::lcp
