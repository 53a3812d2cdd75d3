#include "plain_problem.h"

#include "byte_reader.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::testing {
namespace {

using Matrix3 = Eigen::Matrix<long double, 3, 3>;

constexpr long double kInfinity = std::numeric_limits<long double>::infinity();
constexpr long double kDoubleRounding = std::numeric_limits<double>::epsilon();
constexpr long double kOfTheFloor = PlainProblem::Claim{}.of_the_floor;
constexpr long double kOfTheResidual = 1e-9L;
constexpr long double kMostRounded = 1e-5L;

long double norm(const long double* x, int count) {
  long double sum = 0.0L;
  for (int k = 0; k < count; ++k) {
    sum = std::hypot(sum, x[k]);
  }
  return sum;
}

/// The nearest point to x of {|x_T| <= mu x_N}, in its place.
void project(long double mu, int dimension, long double* x) {
  const long double tangential = norm(x + 1, dimension - 1);
  if (x[0] >= 0.0L && tangential <= mu * x[0]) {
    return;
  }
  const long double along = (x[0] + mu * tangential) / (1.0L + mu * mu);
  const long double normal = std::max(along, 0.0L);
  for (int k = 1; k < dimension; ++k) {
    x[k] *= tangential > 0.0L ? mu * normal / tangential : 0.0L;
  }
  x[0] = normal;
}

}  // namespace

PlainProblem::PlainProblem(int rows)
    : n(rows),
      M(static_cast<std::size_t>(rows) * rows),
      size(M.size()),
      q(rows),
      q_size(rows),
      lower(rows),
      upper(rows, kInfinity) {}

/// z - clamp(z - w / scale, lower, upper)
long double PlainProblem::row_residual(int row, const double* z, long double w,
                                       long double scale) const {
  long double least = lower[row];
  long double most = upper[row];
  for (const Limit& limit : limits) {
    if (limit.row == row) {
      most = limit.coefficient * std::max(0.0L, static_cast<long double>(z[limit.normal_row]));
      least = -most;
    }
  }
  const long double at = z[row];
  const long double back = w / scale;  // at - back would round it away beside a large z
  if (back > at - least) {
    return std::abs(at - least);
  }
  if (back < at - most) {
    return std::abs(at - most);
  }
  return std::abs(back);
}

/// |z - P_K(z - w~ / scale)|, of Coulomb's law at least |min(|z|, w_N / scale)|.
long double PlainProblem::cone_residual(const Cone& cone, const double* z, const long double* w,
                                        long double scale) const {
  const double* of_cone = z + cone.normal_row;
  const long double* pushed = w + cone.normal_row;
  long double x[3];
  long double there[3];
  for (int k = 0; k < cone.dimension; ++k) {
    there[k] = of_cone[k];
    x[k] = there[k] - pushed[k] / scale;
  }
  if (is_coulomb) {
    x[0] -= cone.coefficient * norm(pushed + 1, cone.dimension - 1) / scale;
  }
  project(cone.coefficient, cone.dimension, x);
  for (int k = 0; k < cone.dimension; ++k) {
    x[k] -= there[k];
  }
  const long double projected = norm(x, cone.dimension);
  if (!is_coulomb) {
    return projected;
  }
  return std::max(projected, std::abs(std::min(norm(there, cone.dimension), pushed[0] / scale)));
}

/// The largest eigenvalue of the symmetric part of M_cc, or 1.
long double PlainProblem::cone_scale(const Cone& cone) const {
  Matrix3 block = Matrix3::Zero();
  for (int i = 0; i < cone.dimension; ++i) {
    for (int j = 0; j < cone.dimension; ++j) {
      block(i, j) = 0.5L * (M[(cone.normal_row + i) * n + cone.normal_row + j] +
                            M[(cone.normal_row + j) * n + cone.normal_row + i]);
    }
  }
  const auto found = Eigen::SelfAdjointEigenSolver<Matrix3>(block, Eigen::EigenvaluesOnly);
  const long double largest = found.eigenvalues()[2];
  return static_cast<double>(largest) > 0.0 ? largest : 1.0L;
}

PlainProblem::Residuals PlainProblem::residuals(const double* z) const {
  std::vector<long double> w = q;
  std::vector<long double> w_size = q_size;
  long double largest_q = least_q;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      w[i] += M[i * n + j] * z[j];
      w_size[i] += size[i * n + j] * std::abs(z[j]);
    }
    largest_q = std::max(largest_q, std::abs(q[i]));
  }
  Residuals found;
  std::vector<bool> in_cone(n, false);
  for (const Cone& cone : cones) {
    const long double scale = cone_scale(cone);
    const long double boundary =
        (1.0L + cone.coefficient) * std::abs(z[cone.normal_row]) +
        (cone.dimension > 2 ? std::hypot(z[cone.normal_row + 1], z[cone.normal_row + 2])
                            : std::abs(z[cone.normal_row + 1]));
    for (int k = 0; k < cone.dimension; ++k) {
      in_cone[cone.normal_row + k] = true;
    }
    long double turned = 0.0L;  // rounding in w_T, times mu
    for (int k = 1; k < cone.dimension; ++k) {
      turned += cone.coefficient * w_size[cone.normal_row + k];
    }
    found.natural = std::max(found.natural, cone_residual(cone, z, w.data(), 1.0L));
    found.unit_free = std::max(found.unit_free, scale * cone_residual(cone, z, w.data(), scale));
    found.natural_floor = std::max(found.natural_floor, boundary + turned);
    found.unit_free_floor = std::max(found.unit_free_floor, scale * boundary + turned);
  }
  for (int i = 0; i < n; ++i) {
    found.natural_floor = std::max(found.natural_floor, w_size[i]);
    found.unit_free_floor = std::max(found.unit_free_floor, w_size[i]);
    if (!in_cone[i]) {
      const long double diagonal = M[i * n + i];
      const long double scale = static_cast<double>(diagonal) > 0.0 ? diagonal : 1.0L;
      found.natural = std::max(found.natural, row_residual(i, z, w[i], 1.0L));
      found.unit_free = std::max(found.unit_free, scale * row_residual(i, z, w[i], scale));
    }
  }
  found.natural /= 1.0L + largest_q;
  found.natural_floor *= kDoubleRounding / (1.0L + largest_q);
  found.unit_free_floor *= kDoubleRounding;
  if (largest_q > 0.0L) {
    found.unit_free /= largest_q;
    found.unit_free_floor /= largest_q;
  } else {
    const bool hidden = found.unit_free <= kOfTheFloor * found.unit_free_floor;
    found.unit_free = hidden ? 0.0L : kInfinity;
    found.unit_free_floor = 0.0L;
  }
  return found;
}

void PlainProblem::judge(const double* z, const Claim& claim) const {
  require(std::all_of(z, z + n, [](double number) { return std::isfinite(number); }),
          "z is finite");
  const Residuals found = residuals(z);
  const auto told = [&](long double residual, long double is, long double floor) {
    constexpr long double kLeast =
        std::numeric_limits<double>::denorm_min();  // it is told in double
    return !(residual < (1.0L - kOfTheResidual) * is - claim.of_the_floor * floor - kLeast);
  };
  require(told(claim.natural_residual, found.natural, found.natural_floor),
          "the natural residual is not less than it is");
  require(told(claim.unit_free_residual, found.unit_free, found.unit_free_floor),
          "the unit-free residual is not less than it is");
  const auto small = [&](long double residual, long double floor) {
    const long double rounded = claim.is_to_rounding ? std::min(4.0L * floor, kMostRounded) : 0.0L;
    const long double most = std::max(claim.tolerance, rounded);
    return residual <= (1.0L + kOfTheResidual) * most + claim.of_the_floor * floor;
  };
  if (claim.is_solved || claim.is_to_rounding) {
    require(
        small(found.natural, found.natural_floor) && small(found.unit_free, found.unit_free_floor),
        "what is called solved is solved");
  }
}

void PlainProblem::judge_ray(const double* y, double bound) const {
  long double down = 0.0L;  // q.y, and
  long double down_size = 0.0L;
  std::vector<long double> growth(n);  // (M^T y)_i, and
  std::vector<long double> rounding(n);
  for (int j = 0; j < n; ++j) {
    require(y[j] >= 0.0 && std::isfinite(y[j]), "a ray is finite and not negative");
    down += q[j] * y[j];
    down_size += q_size[j] * y[j];
    long double column = 0.0L;
    long double column_size = 0.0L;
    for (int i = 0; i < n; ++i) {
      column += M[i * n + j] * y[i];
      column_size += size[i * n + j] * y[i];
    }
    growth[j] = column;
    rounding[j] = kOfTheFloor * kDoubleRounding * column_size;
  }
  for (const Cone& cone : cones) {  // |z_Tk| <= mu z_N
    for (int k = 1; k < cone.dimension; ++k) {
      require(y[cone.normal_row + k] == 0.0, "a ray has no tangential rows");
      growth[cone.normal_row] += cone.coefficient * std::abs(growth[cone.normal_row + k]);
      rounding[cone.normal_row] += cone.coefficient * rounding[cone.normal_row + k];
      growth[cone.normal_row + k] = 0.0L;
    }
  }
  long double most = 0.0L;
  for (int j = 0; j < n; ++j) {
    most = std::max(most, growth[j] - rounding[j]);
  }
  down -= kOfTheFloor * kDoubleRounding * down_size;
  require(down < 0.0L, "along a ray q.y falls");
  require(most <= 0.0L || bound <= (1.0L + kOfTheResidual) * -down / most,
          "the ray proves its bound");
}

}  // namespace signorini::testing
