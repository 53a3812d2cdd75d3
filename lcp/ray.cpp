#include <signorini/lcp/enclosed_product.h>
#include <signorini/lcp/exact_sum.h>
#include <signorini/lcp/ray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace signorini::lcp {
namespace {

/// What M^T y is summed from: (|M|^T y)_i, or a bound of it.
void sizes_of_sums(const MatrixForm& M, const VectorRef& y, Vector& sizes) {
  if (const auto* dense = std::get_if<Matrix>(&M)) {
    sizes = dense->cwiseAbs().transpose() * y;
  } else if (const auto* sparse = std::get_if<SparseMatrix>(&M)) {
    sizes = sparse->cwiseAbs().transpose() * y;
  } else {
    diagonal(M, sizes);
    sizes = sizes.cwiseSqrt();
    sizes *= sizes.dot(y);
  }
}

/// The largest |x| in an interval; NaN if it has no order.
long double magnitude(const Interval& x) {
  return x.lower <= x.upper ? std::max(-x.lower, x.upper)
                            : std::numeric_limits<long double>::quiet_NaN();
}

/// How fast (M^T y).z may grow with the z_i of one row, or with the z_N of one contact.
struct Growth {
  Index row = 0;
  Interval value;
};

/// max(0, those that are not tangential), rounded up; 0 only if all are <= 0 exactly. NaN stays
/// NaN.
Growth largest_growth(const Problem& problem, const VectorRef& y) {
  std::vector<Interval> product;
  enclose_transposed_product(problem.M, y, product);
  std::vector<bool> is_tangential(product.size(), false);
  for (const FrictionCone& cone : problem.cones) {
    for (int k = 1; k < cone.dimension; ++k) {
      is_tangential[cone.normal_row + k] = true;
      product[cone.normal_row] +=
          cone.coefficient * Interval(magnitude(product[cone.normal_row + k]));
    }
  }
  Growth largest;
  for (std::size_t i = 0; i < product.size(); ++i) {
    if (!is_tangential[i] && !(product[i].upper <= largest.value.upper)) {
      largest = {static_cast<Index>(i), product[i]};
      if (std::isnan(product[i].upper)) {
        break;
      }
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
  const auto is_normal_alone = [&y](const FrictionCone& cone) {
    return (y.segment(cone.normal_row + 1, cone.dimension - 1).array() == 0.0).all();
  };
  return problem.is_unilateral() && y.allFinite() && (y.array() >= 0.0).all() &&
         std::ranges::all_of(problem.cones, is_normal_alone) && find_bad_value(problem).empty();
}

double defect_of(const Problem& problem, const VectorRef& y, const Growth& growth) {
  Vector sizes;
  sizes_of_sums(problem.M, y, sizes);
  double size = sizes[growth.row];
  for (const FrictionCone& cone : problem.cones) {
    if (cone.normal_row == growth.row) {
      size += cone.coefficient * sizes.segment(growth.row + 1, cone.dimension - 1).sum();
    }
  }
  return static_cast<double>(growth.value.upper) / size;
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
  const Growth growth = largest_growth(problem, y);
  const long double most = growth.value.upper;
  if (most == 0.0L) {
    return {Status::kInfeasible, std::numeric_limits<double>::infinity(), 0.0};
  }
  const Interval bound = Interval(-q_dot_y.enclosure().upper) / most;
  const double rounded = round_down(bound.lower);
  if (!(rounded > 0.0) || !std::isfinite(most)) {  // underflow, overflow or NaN
    return {};
  }
  return {Status::kNoSolutionBelow, rounded, defect_of(problem, y, growth)};
}

}  // namespace signorini::lcp
