#include "bench/rational_judge.h"

#include "bench/complementary_cones.h"

#include <algorithm>
#include <limits>

namespace signorini::bench {
namespace {

using lcp::ExactProblem;
using lcp::Index;
using lcp::Result;
using lcp::Status;
using lcp::Vector;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kFloorsAllowed = 4;

mpq_class largest_of(const std::vector<mpq_class>& values) {
  mpq_class most = 0;
  for (const mpq_class& value : values) {
    most = std::max(most, mpq_class(abs(value)));
  }
  return most;
}

bool within(const mpq_class& residual, const mpq_class& floor, double tolerance, Status status) {
  const mpq_class allowed = tolerance;
  return residual <= allowed ||
         (status == Status::kSolvedToRounding && residual <= kFloorsAllowed * floor);
}

std::string wrong_solution(const ExactProblem& problem, const Result& result, double tolerance) {
  const RationalResiduals r = rational_residuals(problem, result.z);
  if (!within(r.natural, r.natural_floor, tolerance, result.status)) {
    return "natural residual " + std::to_string(r.natural.get_d());
  }
  if (!within(r.unit_free, r.unit_free_floor, tolerance, result.status)) {
    return "unit-free residual " + std::to_string(r.unit_free.get_d());
  }
  return {};
}

/// -q.y, and the fastest that (M^T y).z grows with a z_i, or with the z_N of a cone, of the doubles
/// y.
struct RaySums {
  mpq_class minus_q_dot_y;
  mpq_class growth;
};

RaySums ray_sums(const ExactProblem& problem, const std::vector<lcp::FrictionCone>& cones,
                 const Vector& y) {
  RaySums sums;
  std::vector<mpq_class> growth(problem.n);
  for (int j = 0; j < problem.n; ++j) {
    sums.minus_q_dot_y -= problem.q[j] * y[j];
    for (int i = 0; i < problem.n; ++i) {
      growth[j] += problem.at(i, j) * y[i];
    }
  }
  for (const lcp::FrictionCone& cone : cones) {
    for (int k = 1; k < cone.dimension; ++k) {
      mpq_class& tangential = growth[cone.normal_row + k];
      growth[cone.normal_row] += mpq_class(cone.coefficient) * abs(tangential);
      tangential = 0;  // what is left of it
    }
  }
  for (const mpq_class& value : growth) {
    sums.growth = std::max(sums.growth, value);
  }
  return sums;
}

std::string wrong_ray(const ExactProblem& problem, const std::vector<lcp::FrictionCone>& cones,
                      const Result& result, const Truth& truth) {
  if (result.ray.size() != problem.n || !result.ray.allFinite() || result.ray.minCoeff() < 0.0) {
    return "the ray is not finite and >= 0";
  }
  for (const lcp::FrictionCone& cone : cones) {
    if (!result.ray.segment(cone.normal_row + 1, cone.dimension - 1).isZero(0.0)) {
      return "the ray is not 0 on a tangential row";
    }
  }
  const RaySums sums = ray_sums(problem, cones, result.ray);
  if (sums.minus_q_dot_y <= 0) {
    return "q.ray >= 0";
  }
  if (result.status == Status::kInfeasible) {
    if (sums.growth > 0) {
      return "(M^T ray)_i > 0 for some i";
    }
    return truth.existence == Existence::kSolution ? "a solution exists" : "";
  }
  const mpq_class bound = result.ray_bound;
  if (bound * sums.growth > sums.minus_q_dot_y) {
    return "the bound Z is above that of the ray";
  }
  if (truth.existence == Existence::kSolution) {
    mpq_class sum = 0;
    for (const mpq_class& z : truth.solution) {
      sum += z;
    }
    if (sum < bound) {
      return "a solution lies below the bound Z";
    }
  }
  return {};
}

}  // namespace

RationalResiduals rational_residuals(const ExactProblem& problem, const Vector& z) {
  RationalResiduals r;
  mpq_class most = 0;
  for (int i = 0; i < problem.n; ++i) {
    mpq_class w = problem.q[i];
    mpq_class magnitude = abs(problem.q[i]);
    for (int j = 0; j < problem.n; ++j) {
      const mpq_class product = problem.at(i, j) * z[j];
      w += product;
      magnitude += abs(product);
    }
    const mpq_class& diagonal = problem.at(i, i);
    const mpq_class exact_z = z[i];
    const mpq_class scaled_z = diagonal > 0 ? mpq_class(diagonal * exact_z) : exact_z;
    r.natural = std::max(r.natural, mpq_class(abs(std::min(exact_z, w))));
    r.unit_free = std::max(r.unit_free, mpq_class(abs(std::min(scaled_z, w))));
    most = std::max(most, magnitude);
  }
  const mpq_class q_inf = largest_of(problem.q);
  r.natural /= 1 + q_inf;
  r.natural_floor = kEpsilon * most / (1 + q_inf);
  if (q_inf > 0) {
    r.unit_free /= q_inf;
    r.unit_free_floor = kEpsilon * most / q_inf;
  }
  return r;
}

Truth find_truth(const lcp::Problem& problem, const ExactProblem& exact) {
  // Where enumeration decides, another path need not.
  const int restarts = exact.n > kMostRowsEnumerated ? lcp::kExactRestarts : 0;
  lcp::ExactSolution lemke = lcp::solve_exactly(
      problem, -1, lcp::Deadline(std::numeric_limits<double>::infinity()), restarts);
  if (lemke.ending == lcp::ExactEnding::kSolution) {
    return {Existence::kSolution, std::move(lemke.z), false};
  }
  if (lemke.ray_proves_infeasible) {
    return {Existence::kNone, {}, false};
  }
  if (exact.n > kMostRowsEnumerated) {
    return {};
  }
  if (auto z = find_in_complementary_cones(exact)) {
    return {Existence::kSolution, std::move(*z), true};
  }
  return {Existence::kNone, {}, true};
}

std::string find_wrong_claim(const ExactProblem& problem, const Result& result, double tolerance,
                             const Truth& truth, const std::vector<lcp::FrictionCone>& cones) {
  switch (result.status) {
    case Status::kSolved:
    case Status::kSolvedToRounding: return wrong_solution(problem, result, tolerance);
    case Status::kInfeasible:
    case Status::kNoSolutionBelow: return wrong_ray(problem, cones, result, truth);
    default: return {};
  }
}

}  // namespace signorini::bench
