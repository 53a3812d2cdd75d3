#include <signorini/lcp/lemke_ray.h>

#include <cmath>

namespace signorini::lcp {
namespace {

constexpr double kNoise = 1e-9;  // of the largest entry
constexpr double kNearInteger = 1e-7;
constexpr int kLargestDenominator = 1000;

/// The integers near D y for the least D that fits; empty if none does. The largest entry of y
/// is 1.
Vector round_to_integers(const Vector& y) {
  Vector integers(y.size());
  for (int denominator = 1; denominator <= kLargestDenominator; ++denominator) {
    bool fits = true;
    for (Index i = 0; i < y.size() && fits; ++i) {
      integers[i] = std::round(denominator * y[i]);
      fits = std::abs(denominator * y[i] - integers[i]) <= kNearInteger * denominator;
    }
    if (fits) {
      return integers;
    }
  }
  return {};
}

}  // namespace

RayVerdict sharpen_ray(const Problem& problem, const VectorRef& direction, Vector& sharpened) {
  const double largest = direction.size() > 0 ? direction.maxCoeff() : 0.0;
  if (!(largest > 0.0) || !std::isfinite(largest)) {
    sharpened.setZero(direction.size());
    return {};
  }
  sharpened = direction / largest;
  sharpened = (sharpened.array() > kNoise).select(sharpened, 0.0);
  const RayVerdict cleaned = judge_ray(problem, sharpened);
  if (cleaned.status == Status::kInfeasible) {
    return cleaned;
  }
  if (const Vector integers = round_to_integers(sharpened); integers.size() > 0) {
    const RayVerdict rounded = judge_ray(problem, integers);
    if (rounded.status == Status::kInfeasible || rounded.bound > cleaned.bound) {
      sharpened = integers;
      return rounded;
    }
  }
  return cleaned;
}

}  // namespace signorini::lcp
