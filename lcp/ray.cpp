#include <signorini/lcp/enclosed_product.h>
#include <signorini/lcp/exact_sum.h>
#include <signorini/lcp/ray.h>

#include <cmath>
#include <limits>
#include <vector>

namespace signorini::lcp {
namespace {

/// max_i (M^T y)_i+, rounded up; 0 only if M^T y <= 0 exactly. NaN stays NaN.
long double growth(const MatrixForm& M, const VectorRef& y) {
  std::vector<Interval> product;
  enclose_transposed_product(M, y, product);
  long double largest = 0.0L;
  for (const Interval& entry : product) {
    if (!(entry.upper <= largest)) {
      largest = entry.upper;
    }
  }
  return largest;
}

ExactSum dot(const Vector& a, const VectorRef& b) {
  ExactSum sum;
  for (Index i = 0; i < a.size(); ++i) {
    sum.add_product(a[i], b[i]);
  }
  return sum;
}

double round_down(long double value) {
  const double nearest = static_cast<double>(value);
  return nearest <= value ? nearest
                          : std::nextafter(nearest, -std::numeric_limits<double>::infinity());
}

bool can_be_judged(const Problem& problem, const VectorRef& y) {
  return problem.is_lcp() && y.allFinite() && (y.array() >= 0.0).all() &&
         find_bad_value(problem).empty();
}

}  // namespace

RayVerdict judge_ray(const Problem& problem, const VectorRef& y) {
  if (!can_be_judged(problem, y)) {
    return {};
  }
  const ExactSum q_dot_y = dot(problem.q, y);
  if (q_dot_y.sign() >= 0) {
    return {};
  }
  const long double most = growth(problem.M, y);
  if (most == 0.0L) {
    return {Status::kInfeasible, std::numeric_limits<double>::infinity()};
  }
  const Interval bound = Interval(-q_dot_y.enclosure().upper) / most;
  const double rounded = round_down(bound.lower);
  if (!(rounded > 0.0) || !std::isfinite(most)) {  // underflow, overflow or NaN
    return {};
  }
  return {Status::kNoSolutionBelow, rounded};
}

}  // namespace signorini::lcp
