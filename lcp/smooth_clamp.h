#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {

/// s(t) = (t + sqrt(t^2 + 4 mu^2)) / 2, which is max(t, 0) for mu = 0, and its derivatives (Chen,
/// Harker, SIAM J. Matrix Anal. Appl. 14, 1993; Kanzow, ibid. 17, 1996). Nothing cancels.
struct SmoothPlus {
  SmoothPlus(double t, double mu) {
    constexpr double kFar = 1e150;  // where t^2 would overflow mu is nothing
    root = std::abs(t) < kFar ? std::sqrt(t * t + 4.0 * mu * mu) : std::abs(t);
    const double large = 0.5 * root + 0.5 * std::abs(t);
    excess = large > 0.0 ? mu * (mu / large) : 0.0;
    const double small_share = root > 0.0 ? excess / root : 0.5;
    const double large_share = root > 0.0 ? large / root : 0.5;
    value = t > 0.0 ? large : excess;
    by_t = t > 0.0 ? large_share : small_share;
    rest = t > 0.0 ? small_share : large_share;
    by_mu = root > 0.0 ? 2.0 * mu / root : 1.0;
  }
  double root, value, by_t, rest, by_mu;  // rest = 1 - by_t
  double excess;                          // s(t) - max(t, 0)
};

/// p(y) = lower + s(y - lower) - s(y - upper), the clamp for mu = 0, and its derivatives. A bound
/// that is not there is infinite. Far bounds take no digits.
struct SmoothClamp {
  SmoothClamp(double y, double lower, double upper, double mu)
      : value(std::clamp(y, lower, upper)) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double by_lower = 1.0;
    double rest_of_lower = 0.0;
    if (lower > -kInfinity) {
      const SmoothPlus s(y - lower, mu);
      value += s.excess;
      by_lower = s.by_t;
      rest_of_lower = s.rest;
      by_mu += s.by_mu;
    }
    double by_upper = 0.0;
    double rest_of_upper = 1.0;
    if (upper < kInfinity) {
      const SmoothPlus s(y - upper, mu);
      value -= s.excess;
      by_upper = s.by_t;
      rest_of_upper = s.rest;
      by_mu -= s.by_mu;
    }
    // by_lower - by_upper, of the small numbers where both are near 1.
    by_y = std::max(y > upper ? rest_of_upper - rest_of_lower : by_lower - by_upper, 0.0);
    rest = rest_of_lower + by_upper;
  }
  double value, by_y = 1.0, rest = 0.0, by_mu = 0.0;  // rest = 1 - by_y
};

}  // namespace signorini::lcp
