#pragma once

#include <cmath>
#include <limits>

namespace signorini::lcp {

/// s(t) = (t + sqrt(t^2 + 4 mu^2)) / 2, which is max(t, 0) for mu = 0, and its derivatives (Chen,
/// Harker, SIAM J. Matrix Anal. Appl. 14, 1993; Kanzow, ibid. 17, 1996). Nothing cancels.
struct SmoothPlus {
  SmoothPlus(double t, double mu) {
    root = std::sqrt(t * t + 4.0 * mu * mu);
    const double large = 0.5 * (root + std::abs(t));
    const double small = large > 0.0 ? mu * mu / large : 0.0;
    value = t > 0.0 ? large : small;
    by_t = root > 0.0 ? value / root : 0.5;
    rest = root > 0.0 ? (t > 0.0 ? small : large) / root : 0.5;
    by_mu = root > 0.0 ? 2.0 * mu / root : 1.0;
  }
  double root, value, by_t, rest, by_mu;  // rest = 1 - by_t
};

/// p(y) = lower + s(y - lower) - s(y - upper), the clamp for mu = 0, and its derivatives. A bound
/// that is not there is infinite.
struct SmoothClamp {
  SmoothClamp(double y, double lower, double upper, double mu) : value(y) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (lower > -kInfinity) {
      const SmoothPlus s(y - lower, mu);
      value = lower + s.value;
      by_y = s.by_t;
      rest = s.rest;
      by_mu = s.by_mu;
    }
    if (upper < kInfinity) {
      const SmoothPlus s(y - upper, mu);
      value -= s.value;
      by_y -= s.by_t;
      rest += s.by_t;
      by_mu -= s.by_mu;
    }
  }
  double value, by_y = 1.0, rest = 0.0, by_mu = 0.0;  // rest = 1 - by_y
};

}  // namespace signorini::lcp
