#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace signorini::lcp {

/// The friction cone K = {(x_N, x_T) : |x_T| <= mu x_N}, |.| the Euclidean norm, for vectors of
/// `dimension` numbers (at most 3), the normal first. Scalar is double or long double. Nothing
/// overflows or underflows from 1e-150 to 1e150 (long double: further).

/// |x_T|.
template <typename Scalar>
Scalar tangential_norm(int dimension, const Scalar* x) {
  if (dimension == 2) {
    return std::abs(x[1]);
  }
  if constexpr (std::is_same_v<Scalar, long double>) {  // whose range holds the squares of doubles
    return std::sqrt(x[1] * x[1] + x[2] * x[2]);
  } else {
    return std::hypot(x[1], x[2]);
  }
}

/// p = P_K(x), the nearest point of K. x and p may be the same.
template <typename Scalar>
void project_on_cone(Scalar mu, int dimension, const Scalar* x, Scalar* p) {
  const Scalar normal = x[0];
  const Scalar tangential = tangential_norm(dimension, x);
  if (normal >= 0 && tangential <= mu * normal) {  // in K, also where mu or mu x_N is 0
    for (int k = 0; k < dimension; ++k) {
      p[k] = x[k];
    }
    return;
  }
  const Scalar along = (normal + mu * tangential) / (1 + mu * mu);  // p_N of the boundary
  const bool in_polar_cone = !(along > 0);
  p[0] = in_polar_cone ? Scalar(0) : along;
  for (int k = 1; k < dimension; ++k) {
    p[k] = in_polar_cone ? Scalar(0) : mu * along * (x[k] / tangential);
  }
}

/// max(|x_T| - mu x_N, 0), and -x_N where that is more: how far x violates K, 0 in K.
template <typename Scalar>
Scalar cone_violation(Scalar mu, int dimension, const Scalar* x) {
  return std::max({tangential_norm(dimension, x) - mu * x[0], -x[0], Scalar(0)});
}

}  // namespace signorini::lcp
