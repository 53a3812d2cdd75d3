#include "bench/claim_judge.h"

#include <signorini/lcp/friction_cone.h>
#include <signorini/lcp/interval.h>

#include "bench/rational_judge.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace signorini::bench {
namespace {

using lcp::ExactProblem;
using lcp::FactoredMatrix;
using lcp::FrictionCone;
using lcp::FrictionLaw;
using lcp::Index;
using lcp::Interval;
using lcp::Matrix;
using lcp::Problem;
using lcp::Result;
using lcp::SparseMatrix;
using lcp::Status;
using lcp::Vector;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kRoundingCeiling = 1e-5;
constexpr double kScaleRounding = 1e-9;
constexpr int kFloorsAllowed = 4;
constexpr int kBits = 2048;
constexpr double kConeRounding = 0x1p-1000;  // more than kBits lose

/// The bounds of every row at the given z, and its scale D. Rows in cones have neither.
struct Rows {
  std::vector<double> scale;
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<double> coupling;  // mu of a coupled row, whose bounds are -+ mu max(z_n, 0); else -1
  std::vector<int> normal;       // n of a coupled row
  std::vector<bool> in_cone;
};

Rows rows_of(const Problem& problem) {
  const auto n = static_cast<std::size_t>(problem.size());
  Rows rows;
  Vector diagonal;
  lcp::diagonal(problem.M, diagonal);
  for (const double value : diagonal) {
    rows.scale.push_back(value > 0.0 ? value : 1.0);
  }
  rows.lower.assign(n, 0.0);
  rows.upper.assign(n, kInfinity);
  if (problem.lower.size() > 0) {
    rows.lower.assign(problem.lower.begin(), problem.lower.end());
  }
  if (problem.upper.size() > 0) {
    rows.upper.assign(problem.upper.begin(), problem.upper.end());
  }
  rows.coupling.assign(n, -1.0);
  rows.normal.assign(n, -1);
  for (const lcp::CoupledLimit& limit : problem.limits) {
    rows.coupling[limit.row] = limit.coefficient;
    rows.normal[limit.row] = limit.normal_row;
  }
  rows.in_cone.assign(n, false);
  for (const FrictionCone& cone : problem.cones) {
    std::fill_n(rows.in_cone.begin() + cone.normal_row, cone.dimension, true);
  }
  return rows;
}

/// The largest eigenvalue of the symmetric part of M_cc, 1 unless it is > 0.
double cone_scale(const Matrix& block) {
  const Matrix symmetric = 0.5 * (block + block.transpose());
  const double largest = Eigen::SelfAdjointEigenSolver<Matrix>(symmetric, Eigen::EigenvaluesOnly)
                             .eigenvalues()
                             .maxCoeff();
  return largest > 0.0 ? largest : 1.0;
}

double largest_q(const Problem& problem) {
  return problem.size() > 0 ? problem.q.cwiseAbs().maxCoeff() : 0.0;
}

// Intervals.

std::vector<Interval> enclose_w(const Problem& problem, const Vector& z) {
  std::vector<Interval> w(problem.q.begin(), problem.q.end());
  if (const auto* M = std::get_if<Matrix>(&problem.M)) {
    for (Index j = 0; j < M->cols(); ++j) {
      for (Index i = 0; i < M->rows() && z[j] != 0.0; ++i) {
        w[i] += (*M)(i, j) * Interval(z[j]);
      }
    }
  } else if (const auto* S = std::get_if<SparseMatrix>(&problem.M)) {
    for (Index j = 0; j < S->outerSize(); ++j) {
      for (SparseMatrix::InnerIterator it(*S, j); it; ++it) {
        w[it.row()] += it.value() * Interval(z[j]);
      }
    }
  } else {
    const auto& A = std::get<FactoredMatrix>(problem.M);
    std::vector<Interval> p(A.degrees_of_freedom());
    std::vector<Interval> v(A.degrees_of_freedom());
    for (int i = 0; i < A.rows(); ++i) {
      for (const FactoredMatrix::Entry& entry : A.entries(i)) {
        for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
          p[A.mass.offset(entry.block) + k] += A.values(entry)[k] * Interval(z[i]);
        }
      }
    }
    for (int b = 0; b < A.mass.block_count(); ++b) {
      A.mass.apply_inverse(b, p.data() + A.mass.offset(b), v.data() + A.mass.offset(b));
    }
    for (int i = 0; i < A.rows(); ++i) {
      w[i] += A.compliance(i) * Interval(z[i]);
      for (const FactoredMatrix::Entry& entry : A.entries(i)) {
        for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
          w[i] += A.values(entry)[k] * v[A.mass.offset(entry.block) + k];
        }
      }
    }
  }
  return w;
}

long double magnitude(const Interval& x) {
  return std::max(std::abs(x.lower), std::abs(x.upper));  // NaN stays NaN or is the other one
}

/// |z - clamp(z - w / s, lower, upper)|, from above; NaN if it cannot be bounded.
long double step_above(double z, const Interval& w, double s, long double lower,
                       long double upper) {
  Interval x(z);
  x -= w / s;
  if (!(x.lower <= x.upper)) {
    return std::numeric_limits<long double>::quiet_NaN();
  }
  const Interval clamped(std::min(std::max(x.lower, lower), upper),
                         std::min(std::max(x.upper, lower), upper));
  Interval r(z);
  r -= clamped;
  return magnitude(r);
}

/// |min(|z_c|, w_N / s)| of a Coulomb cone, from above, but for rounding |z_c|, 2^-60 of it.
long double normal_part_above(const FrictionCone& cone, const Vector& z, const Interval& w_normal,
                              long double s) {
  long double length = 0.0L;
  for (int k = 0; k < cone.dimension; ++k) {
    length = std::hypot(length, static_cast<long double>(z[cone.normal_row + k]));
  }
  const long double closing = -w_normal.lower / s;
  const long double opening = std::min(length, w_normal.upper / s);
  return std::max(closing, opening) * (1.0L + 0x1p-60L);
}

/// The residual |r_c(s)| of a cone (certificate.h) from above: long double at the middle of w, and
/// what the width of w and rounding can add (P_K does not expand distances, w~ expands them by at
/// most 1 + mu).
long double cone_step_above(const Problem& problem, const FrictionCone& cone, const Vector& z,
                            const std::vector<Interval>& w, long double s) {
  const int d = cone.dimension;
  const long double mu = cone.coefficient;
  long double middle[3] = {};
  long double width = 0.0L;
  long double size = 0.0L;
  for (int k = 0; k < d; ++k) {
    const Interval& wk = w[cone.normal_row + k];
    middle[k] = 0.5L * (wk.lower + wk.upper);
    width += wk.upper - wk.lower;
    size += std::abs(static_cast<long double>(z[cone.normal_row + k])) + magnitude(wk) / s;
  }
  long double x[3] = {};
  const long double push =
      problem.friction_law == FrictionLaw::kCoulomb ? mu * lcp::tangential_norm(d, middle) : 0.0L;
  for (int k = 0; k < d; ++k) {
    x[k] = z[cone.normal_row + k] - (middle[k] + (k == 0 ? push : 0.0L)) / s;
  }
  long double projected[3] = {};
  lcp::project_on_cone(mu, d, x, projected);
  long double sum = 0.0L;
  for (int k = 0; k < d; ++k) {
    sum = std::hypot(sum, z[cone.normal_row + k] - projected[k]);
  }
  const long double step = sum + (1.0L + mu) * (width / s + 0x1p-58L * size);
  if (problem.friction_law == FrictionLaw::kAssociated) {
    return step;
  }
  const long double normal = normal_part_above(cone, z, w[cone.normal_row], s);
  return normal >= step || std::isnan(normal) ? normal : step;
}

Matrix block_of(const Matrix& M, const FrictionCone& cone) {
  return M.block(cone.normal_row, cone.normal_row, cone.dimension, cone.dimension);
}

// Rationals.

mpq_class absolute(const mpq_class& x) {
  return abs(x);
}

mpq_class clamp(const mpq_class& x, const std::optional<mpq_class>& lower,
                const std::optional<mpq_class>& upper) {
  mpq_class y = x;
  if (lower && y < *lower) {
    y = *lower;
  }
  return upper && y > *upper ? *upper : y;
}

std::optional<mpq_class> finite(double bound) {
  return std::isfinite(bound) ? std::optional<mpq_class>(bound) : std::nullopt;
}

/// |z - clamp(z - w / s)| of a row outside cones.
mpq_class exact_step(const Rows& rows, const Vector& z, int i, const mpq_class& w,
                     const mpq_class& s) {
  std::optional<mpq_class> lower = finite(rows.lower[i]);
  std::optional<mpq_class> upper = finite(rows.upper[i]);
  if (rows.coupling[i] >= 0.0) {
    upper = mpq_class(rows.coupling[i]) * std::max(z[rows.normal[i]], 0.0);
    lower = -*upper;
  }
  const mpq_class own = z[i];
  return absolute(own - clamp(own - w / s, lower, upper));
}

/// |min(|z_c|, w_N / s)| of a Coulomb cone.
mpf_class exact_normal_part(const FrictionCone& cone, const Vector& z, const mpq_class& w_normal,
                            const mpq_class& s) {
  mpf_class length(0.0, kBits);
  for (int k = 0; k < cone.dimension; ++k) {
    const mpf_class value(z[cone.normal_row + k], kBits);
    length += value * value;
  }
  length = sqrt(length);
  const mpf_class normal(mpq_class(w_normal / s), kBits);
  return abs(std::min(length, normal));
}

/// The same as exact_step() of a cone, with kBits bits after the exact w.
mpf_class exact_cone_step(const Problem& problem, const FrictionCone& cone, const Vector& z,
                          const std::vector<mpq_class>& w, const mpq_class& s) {
  const int d = cone.dimension;
  const mpf_class mu(cone.coefficient, kBits);
  mpf_class tangential(0.0, kBits);
  for (int k = 1; k < d; ++k) {
    const mpf_class value(w[cone.normal_row + k], kBits);
    tangential += value * value;
  }
  tangential = sqrt(tangential);
  std::vector<mpf_class> x;
  x.reserve(d);
  for (int k = 0; k < d; ++k) {
    x.emplace_back(mpq_class(z[cone.normal_row + k]) - w[cone.normal_row + k] / s, kBits);
  }
  if (problem.friction_law == FrictionLaw::kCoulomb) {
    x[0] -= mu * tangential / mpf_class(s, kBits);
  }
  mpf_class norm(0.0, kBits);
  for (int k = 1; k < d; ++k) {
    norm += x[k] * x[k];
  }
  norm = sqrt(norm);
  std::vector<mpf_class> p = x;
  if (x[0] < 0 || norm > mu * x[0]) {
    mpf_class along((x[0] + mu * norm) / (1 + mu * mu), kBits);
    if (along < 0) {
      along = 0;
    }
    p[0] = along;
    for (int k = 1; k < d; ++k) {
      p[k] = norm > 0 ? mpf_class(mu * along * x[k] / norm, kBits) : mpf_class(0.0, kBits);
    }
  }
  mpf_class sum(0.0, kBits);
  for (int k = 0; k < d; ++k) {
    const mpf_class r(mpf_class(z[cone.normal_row + k], kBits) - p[k], kBits);
    sum += r * r;
  }
  const mpf_class step = sqrt(sum);
  return problem.friction_law == FrictionLaw::kCoulomb
             ? std::max(step, exact_normal_part(cone, z, w[cone.normal_row], s))
             : step;
}

bool within(const mpq_class& residual, const mpq_class& floor, double tolerance, Status status) {
  mpq_class allowed = tolerance;
  if (status == Status::kSolvedToRounding) {
    allowed = std::max(allowed, mpq_class(std::min(mpq_class(kFloorsAllowed * floor),
                                                   mpq_class(kRoundingCeiling))));
  }
  return residual <= allowed * (1 + mpq_class(kScaleRounding));
}

std::string wrong_residual(const Problem& problem, const Result& result, double tolerance) {
  const ExactResiduals r = exact_residuals(problem, result.z);
  if (!within(r.natural, r.natural_floor, tolerance, result.status)) {
    return fmt::format("natural residual {:.3e}, certified {:.3e}, floor {:.1e}",
                       lcp::to_nearest_double(r.natural), result.certificate.natural_residual,
                       lcp::to_nearest_double(r.natural_floor));
  }
  const bool no_q = largest_q(problem) == 0.0;
  const mpq_class rounding =
      problem.cones.empty() ? mpq_class(0) : mpq_class(r.natural_floor * kConeRounding);
  if (no_q ? r.unit_free > rounding
           : !within(r.unit_free, r.unit_free_floor, tolerance, result.status)) {
    return fmt::format("unit-free residual {:.3e}, certified {:.3e}, floor {:.1e}",
                       lcp::to_nearest_double(r.unit_free), result.certificate.unit_free_residual,
                       lcp::to_nearest_double(r.unit_free_floor));
  }
  return {};
}

std::string malformed(const Problem& problem, const Result& result) {
  const bool bad_input = !lcp::find_bad_value(problem).empty();
  if (bad_input != (result.status == Status::kInvalidInput)) {
    return bad_input ? "answers an invalid problem" : "calls a valid problem invalid";
  }
  if (result.z.size() != problem.size() || result.w.size() != problem.size()) {
    return "z or w has the wrong length";
  }
  if (!bad_input && !result.z.allFinite()) {
    return "z is not finite";
  }
  return result.status == Status::kNotRun ? "not run" : "";
}

}  // namespace

ExactResiduals exact_residuals(const Problem& problem, const Vector& z) {
  const ExactProblem exact = lcp::to_rational(problem);
  const Rows rows = rows_of(problem);
  ExactResiduals r;
  mpq_class most = 0;
  std::vector<mpq_class> w(exact.q);
  for (int i = 0; i < exact.n; ++i) {
    mpq_class size = absolute(exact.q[i]);
    for (int j = 0; j < exact.n; ++j) {
      const mpq_class product = exact.at(i, j) * z[j];
      w[i] += product;
      size += absolute(product);
    }
    most = std::max(most, size);
  }
  for (int i = 0; i < exact.n; ++i) {
    if (!rows.in_cone[i]) {
      const mpq_class s = rows.scale[i];
      r.natural = std::max(r.natural, exact_step(rows, z, i, w[i], 1));
      r.unit_free = std::max(r.unit_free, mpq_class(s * exact_step(rows, z, i, w[i], s)));
    }
  }
  const mpq_class w_most = most;
  mpq_class natural_most = 0;
  const Matrix M = problem.cones.empty() ? Matrix() : lcp::to_dense(problem.M);
  for (const FrictionCone& cone : problem.cones) {
    const mpq_class s = cone_scale(block_of(M, cone));
    r.natural = std::max(r.natural, mpq_class(exact_cone_step(problem, cone, z, w, 1)));
    r.unit_free =
        std::max(r.unit_free, mpq_class(s * mpq_class(exact_cone_step(problem, cone, z, w, s))));
    // The floor of a cone (certificate.h): what rounding z does to max(|z_T|, mu |z_N|).
    // In rationals, and |z_T| by a quarter of z: doubles overflow near the largest z.
    const Vector quarter = 0.25 * z.segment(cone.normal_row, cone.dimension);
    const mpq_class tangential =
        4 * mpq_class(lcp::tangential_norm(cone.dimension, quarter.data()));
    const mpq_class along = mpq_class(cone.coefficient) * mpq_class(std::abs(z[cone.normal_row]));
    const mpq_class rounded = std::max(tangential, along);
    natural_most = std::max(natural_most, rounded);
    most = std::max(most, mpq_class(s * rounded));
  }
  natural_most = std::max(natural_most, w_most);
  const mpq_class q_inf = largest_q(problem);
  r.natural /= 1 + q_inf;
  r.natural_floor = kEpsilon * natural_most / (1 + q_inf);
  if (q_inf > 0) {
    r.unit_free /= q_inf;
    r.unit_free_floor = kEpsilon * most / q_inf;
  }
  return r;
}

bool surely_within(const Problem& problem, const Vector& z, double tolerance) {
  const Rows rows = rows_of(problem);
  const std::vector<Interval> w = enclose_w(problem, z);
  const long double q_inf = largest_q(problem);
  const long double natural_allowed = tolerance * (1.0L + q_inf) * (1.0L - 0x1p-60L);
  const long double unit_free_allowed = tolerance * q_inf * (1.0L - 0x1p-60L);
  for (Index i = 0; i < problem.size(); ++i) {
    if (rows.in_cone[i]) {
      continue;
    }
    long double lower = rows.lower[i];
    long double upper = rows.upper[i];
    long double rounded = 0.0L;  // of the bounds
    if (rows.coupling[i] >= 0.0) {
      upper = static_cast<long double>(rows.coupling[i]) * std::max(z[rows.normal[i]], 0.0);
      lower = -upper;
      rounded = 0x1p-63L * upper;
    }
    const double s = rows.scale[i];
    if (!(step_above(z[i], w[i], 1.0, lower, upper) + rounded <= natural_allowed) ||
        !(s * (step_above(z[i], w[i], s, lower, upper) + rounded) <= unit_free_allowed)) {
      return false;
    }
  }
  const Matrix M = problem.cones.empty() ? Matrix() : lcp::to_dense(problem.M);
  for (const FrictionCone& cone : problem.cones) {
    const long double s = cone_scale(block_of(M, cone));
    if (!(cone_step_above(problem, cone, z, w, 1.0L) <= natural_allowed) ||
        !(s * cone_step_above(problem, cone, z, w, s) <= unit_free_allowed)) {
      return false;
    }
  }
  return true;
}

Verdict judge_claim(const Problem& problem, const Result& result, double tolerance) {
  if (std::string wrong = malformed(problem, result); !wrong.empty()) {
    return {std::move(wrong)};
  }
  switch (result.status) {
    case Status::kSolved:
      if (surely_within(problem, result.z, tolerance)) {
        return {};
      }
      return {wrong_residual(problem, result, tolerance), true};
    case Status::kSolvedToRounding: return {wrong_residual(problem, result, tolerance), true};
    case Status::kInfeasible:
    case Status::kNoSolutionBelow:
      if (!problem.is_unilateral()) {
        return {"a proof about a problem with bounds or limits"};
      }
      return {
          find_wrong_claim(lcp::to_rational(problem), result, tolerance, Truth{}, problem.cones),
          true};
    default: return {};
  }
}

}  // namespace signorini::bench
