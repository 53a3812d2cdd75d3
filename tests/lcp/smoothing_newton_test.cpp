#include <signorini/lcp/body_space_system.h>
#include <signorini/lcp/interior_point.h>
#include <signorini/lcp/smoothing_newton.h>

#include "definition_residual.h"
#include "stated_lcp.h"

#include <bench/contact_families.h>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <random>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTolerance = 1e-10;
constexpr int kMostSteps = 14;

/// A pyramid whose rows have a lower bound, two, an upper one, none, or two that are equal, in
/// turn.
Problem bounded_pyramid() {
  Problem problem = bench::make_family({.family = "pyramid2d", .size = 6});
  const Index n = problem.size();
  problem.lower.setZero(n);
  problem.upper.setConstant(n, kInfinity);
  for (Index i = 0; i < n; ++i) {
    switch (i % 9) {
      case 2: problem.upper[i] = 0.02; break;
      case 4: problem.lower[i] = -kInfinity, problem.upper[i] = 0.01; break;
      case 6: problem.lower[i] = -kInfinity; break;
      case 8: problem.upper[i] = problem.lower[i] = 0.005; break;
      default: break;
    }
  }
  return problem;
}

/// The velocities of the bodies with noise of this size.
Problem changed(const Problem& problem, double size) {
  Problem other = problem;
  const auto& A = std::get<FactoredMatrix>(problem.M);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, size);
  const Vector dv = Vector::NullaryExpr(A.degrees_of_freedom(), [&] { return normal(random); });
  const Vector none = Vector::Zero(A.rows());
  Vector dq(A.rows());
  A.times(dv.data(), none.data(), dq.data());
  other.q += dq;
  return other;
}

/// A problem in scaled coordinates, from its own solution or that of another.
struct Start {
  std::unique_ptr<ShiftedSystem> system;
  ScaledProblem scaled;
  Vector x;

  Start(const Problem& problem, const Vector& z) {
    if (std::holds_alternative<FactoredMatrix>(problem.M)) {
      system = std::make_unique<BodySpaceSystem>();
    } else {
      system = make_given_matrix_system();
    }
    system->set(problem.M);
    scaled.set(problem, *system);
    x = z.cwiseProduct(system->scale());
    Vector gradient;
    scaled.gradient(x, gradient);
    scaled.consider(x, gradient);
  }
  bool improve(int most_steps = kMostSteps) {
    return SmoothingNewton().improve(scaled, x, most_steps, kTolerance, Deadline(60.0));
  }
};

Vector solution(const Problem& problem) {
  Result result;
  InteriorPoint({{.tolerance = 1e-12}}).solve(problem, result);
  EXPECT_TRUE(is_solved(result.status));
  return result.z;
}

TEST(SmoothingNewton, SolvesBoundedProblemsFromTheSolutionOfAnother) {
  const Problem problem = bounded_pyramid();
  const Problem other = changed(problem, 1e-4);
  Start start(other, solution(problem));
  const double before = start.scaled.best_residual();
  ASSERT_GT(before, 1e-5);
  EXPECT_TRUE(start.improve());
  EXPECT_LE(start.scaled.best_residual(), kTolerance);
  EXPECT_LE(start.system->factorizations(), kMostSteps);
  Vector z;
  start.scaled.best_z(z);
  EXPECT_GE((z - other.lower).minCoeff(), 0.0);
  EXPECT_GE((other.upper - z).minCoeff(), 0.0);
  EXPECT_LE(definition_residual(other, z), 1e-8);
}

TEST(SmoothingNewton, SolvesAGivenMatrix) {
  Problem problem = bounded_pyramid();
  const Vector z = solution(problem);
  problem = changed(problem, 1e-4);
  problem.M = to_dense(problem.M);
  Start start(problem, z);
  EXPECT_TRUE(start.improve());
  EXPECT_LE(start.scaled.best_residual(), kTolerance);
}

TEST(SmoothingNewton, StepsAreCounted) {
  const Problem problem = bounded_pyramid();
  const Problem other = changed(problem, 1e-4);
  Start start(other, solution(problem));
  EXPECT_FALSE(start.improve(0));
  EXPECT_EQ(start.system->factorizations(), 0);
  EXPECT_FALSE(start.improve(1));
  EXPECT_EQ(start.system->factorizations(), 1);
}

/// w = -1 whatever z is: nothing to arrive at. The best point stays the start.
TEST(SmoothingNewton, GivesUpWhereThereIsNoSolution) {
  const Problem problem = lcp(Matrix::Zero(2, 2), vector({-1.0, -1.0}));
  Start start(problem, Vector::Zero(2));
  EXPECT_FALSE(start.improve());
  EXPECT_LE(start.system->factorizations(), kMostSteps);
  EXPECT_EQ(start.scaled.best(), Vector::Zero(2));
}

TEST(SmoothingNewton, AnExactStartTakesNoStep) {
  const Problem problem = lcp(Matrix::Identity(2, 2), vector({1.0, 1.0}));
  Start exact(problem, Vector::Zero(2));
  EXPECT_TRUE(exact.improve());
  EXPECT_EQ(exact.system->factorizations(), 0);
}

}  // namespace
}  // namespace signorini::lcp
