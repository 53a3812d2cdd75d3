#include <signorini/lcp/lemke_ray.h>

#include <cmath>

namespace signorini::lcp {
namespace {

constexpr double kNoise = 1e-9;              // of the largest entry
constexpr double kRounding = 1e-14;          // relative error expected of an entry
constexpr double kLargestDenominator = 1e9;  // integers below it survive kRounding well enough

/// The least d >= 1 (d <= most) for which d x is an integer up to d * error: the denominators of
/// the continued fraction of x. 0 if there is none.
double denominator_of(double x, double error, double most) {
  double previous = 0.0;
  double current = 1.0;
  double rest = x - std::floor(x);
  while (current <= most) {
    if (std::abs(x - std::round(current * x) / current) <= error) {
      return current;
    }
    if (rest == 0.0) {
      return 0.0;
    }
    const double inverse = 1.0 / rest;
    const double digit = std::floor(inverse);
    rest = inverse - digit;
    const double next = digit * current + previous;
    previous = current;
    current = next;
  }
  return 0.0;
}

/// The integers D y for a small common denominator D; empty if none fits. The largest entry of y
/// is 1.
Vector round_to_integers(const Vector& y) {
  double common = 1.0;
  for (Index i = 0; i < y.size(); ++i) {
    const double factor =
        denominator_of(common * y[i], common * kRounding, kLargestDenominator / common);
    if (factor == 0.0) {
      return {};
    }
    common *= factor;
  }
  return (common * y).array().round();
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
