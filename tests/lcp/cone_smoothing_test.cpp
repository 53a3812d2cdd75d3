#include <signorini/lcp/alart_curnier.h>
#include <signorini/lcp/cone_smoothing.h>
#include <signorini/lcp/scaled_groups.h>
#include <signorini/lcp/smooth_clamp.h>
#include <signorini/lcp/smoothed_cones.h>

#include "allocation_count.h"
#include "definition_residual.h"
#include "family_with_friction.h"
#include "stated_lcp.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kLaws = {FrictionLaw::kCoulomb, FrictionLaw::kAssociated};

Result solve(const Problem& problem, const ConeSmoothingSettings& settings = {},
             const Vector* warm_start = nullptr) {
  Result result;
  ConeSmoothing(settings).solve(problem, result, warm_start);
  return result;
}

/// Every kind of row: bounds in any mixture, a free and a fixed one, cones in space and in the
/// plane, one of them without friction.
Problem every_row(FrictionLaw law) {
  constexpr int kRows = 14;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Matrix G(kRows, 9);
  for (double& value : G.reshaped()) value = normal(random);
  Vector q(kRows);
  for (double& value : q) value = normal(random);
  Problem problem = lcp(G * G.transpose() + 0.1 * Matrix::Identity(kRows, kRows), q);
  problem.lower.setZero(kRows);
  problem.upper.setConstant(kRows, kInfinity);
  problem.upper[1] = 0.3;
  problem.lower[2] = -kInfinity;
  problem.lower[3] = problem.upper[3] = 0.2;
  problem.lower[4] = -kInfinity;
  problem.upper[4] = 0.1;
  problem.cones = {{5, 3, 0.5}, {8, 2, 0.8}, {10, 3, 0.0}};
  for (const FrictionCone& cone : problem.cones) {
    for (int k = 1; k < cone.dimension; ++k) {
      problem.lower[cone.normal_row + k] = -kInfinity;
    }
  }
  problem.friction_law = law;
  return problem;
}

/// F and its derivatives against central differences: at random points, with nothing tangential,
/// and deep inside of the cones and of their duals.
TEST(SmoothedCones, DerivativesAreThoseOfF) {
  for (const FrictionLaw law : kLaws) {
    const Problem problem = every_row(law);
    ScaledGroups groups;
    groups.set(problem);
    SmoothedCones cones;
    cones.set(groups.function().groups(), law);
    const Index n = problem.size();
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    const auto draw = [&] {
      return Vector(Vector::NullaryExpr(n, [&] { return normal(random); }));
    };
    const auto no_tangents = [&](Vector v) {
      for (const FrictionCone& cone : problem.cones) {
        v.segment(cone.normal_row + 1, cone.dimension - 1).setZero();
      }
      return v;
    };
    const auto on_normals = [&](double size) {
      Vector v = no_tangents(draw());
      for (const FrictionCone& cone : problem.cones) {
        v[cone.normal_row] = size;
      }
      return v;
    };
    const std::array points = {std::pair(draw(), draw()), std::pair(draw(), draw()),
                               std::pair(no_tangents(draw()), no_tangents(draw())),
                               std::pair(on_normals(9.0), draw()),
                               std::pair(draw(), on_normals(9.0))};
    std::vector<SmoothedCones::Block> A;
    std::vector<SmoothedCones::Block> B;
    Vector F;
    Vector by_mu;
    Vector above;
    Vector below;
    for (const auto& [x, u] : points) {
      for (const double mu : {1.0, 0.1}) {
        const Vector dx = draw();
        const Vector du = draw();
        cones.linearise(x, u, mu, F, A, B, by_mu);
        Vector expected = by_mu;
        for (std::size_t g = 0; g < A.size(); ++g) {
          const auto& group = groups.function().groups()[g];
          for (int i = 0; i < group.dimension; ++i) {
            for (int j = 0; j < group.dimension; ++j) {
              expected[group.first + i] +=
                  A[g](i, j) * dx[group.first + j] + B[g](i, j) * du[group.first + j];
            }
          }
        }
        const double h = 1e-5 * mu;
        cones.evaluate(x + h * dx, u + h * du, mu + h, above);
        cones.evaluate(x - h * dx, u - h * du, mu - h, below);
        EXPECT_LE(((above - below) / (2.0 * h) - expected).cwiseAbs().maxCoeff(), 1e-5) << mu;
      }
    }
  }
}

/// Bounds that stand for none take no digits, and a row far beyond its bound still moves.
TEST(SmoothClamp, FarBoundsTakeNoDigits) {
  constexpr double kMost = std::numeric_limits<double>::max();
  for (const double far : {1e6, 1e20, kMost}) {
    const SmoothClamp p(0.1, -far, far, 1e-3);
    EXPECT_NEAR(p.value, 0.1, 1e-17);
    EXPECT_EQ(p.by_y, 1.0);
    EXPECT_LT(p.rest, 1e-17);
    EXPECT_TRUE(std::isfinite(p.by_mu));
  }
  for (const SmoothClamp& p :
       {SmoothClamp(2.0, -kInfinity, 1.0, 1e-9), SmoothClamp(-1.0, 0.0, kInfinity, 1e-9)}) {
    EXPECT_NEAR(p.by_y, 1e-18, 1e-20);  // mu^2 / t^2
    EXPECT_EQ(p.rest, 1.0);
  }
  EXPECT_EQ(SmoothClamp(2.0, 1.0, 1.0, 0.1).by_y, 0.0);
  EXPECT_EQ(SmoothClamp(-2.0, 1.0, 1.0, 0.1).by_y, 0.0);
  EXPECT_EQ(SmoothClamp(-2.0, 1.0, 1.0, 0.1).value, 1.0);
}

TEST(SmoothedCones, AtZeroItIsWhatTheRowsAsk) {
  for (const FrictionLaw law : kLaws) {
    const Problem problem = every_row(law);
    Result result;
    AlartCurnier({{.tolerance = 1e-12}}).solve(problem, result);
    ASSERT_TRUE(is_solved(result.status));
    ScaledGroups groups;
    groups.set(problem);
    SmoothedCones cones;
    cones.set(groups.function().groups(), law);
    Vector x;
    Vector u;
    Vector F;
    groups.from_caller(result.z, x);
    groups.multiply(x, u);
    u += groups.b();
    cones.evaluate(x, u, 0.0, F);
    EXPECT_LE(F.cwiseAbs().maxCoeff(), 1e-10);
    cones.evaluate(x + Vector::Constant(x.size(), 0.01), u, 0.0, F);
    EXPECT_GE(F.cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(ConeSmoothing, SolvesEveryRow) {
  for (const FrictionLaw law : kLaws) {
    const Problem problem = every_row(law);
    const Result result = solve(problem);
    EXPECT_EQ(result.status, Status::kSolved) << result.detail;
    EXPECT_LE(definition_residual(problem, result.z), 1e-7);
    Problem sparse = problem;
    sparse.M = SparseMatrix(to_dense(problem.M).sparseView());
    EXPECT_EQ(solve(sparse).status, Status::kSolved);
  }
}

/// Where AlartCurnier takes 100 to 1000 steps and more.
TEST(ConeSmoothing, SolvesPilesThatSlideAndStacksAtRest) {
  struct Case {
    bench::FamilySpec spec;
    double mu;
    int most;  // steps; a fifth above what is measured
  };
  const std::array cases = {
      Case{{"spheres", 200}, 0.4, 45},
      Case{{"spheres", 200, 1e3}, 0.8, 50},
      Case{{"spheres", 200, 1e3, 1, true}, 0.8, 50},
      Case{{"pyramid2d", 7, 1e6, 1, true}, 0.4, 25},
      Case{{"pyramid3d", 4, 1.0, 1, true}, 0.8, 20},
      Case{{"tower4", 40, 1.0, 1, true}, 0.4, 15},
      Case{{"wall", 4, 1e6, 1, true}, 0.4, 30},
  };
  for (const Case& one : cases) {
    const Problem problem = family_with_friction(one.spec, one.mu);
    const Result result = solve(problem);
    EXPECT_TRUE(is_solved(result.status)) << one.spec.family << " " << to_string(result.status);
    EXPECT_LE(result.statistics.factorizations, one.most) << one.spec.family;
    EXPECT_LE(definition_residual(problem, result.z), 1e-6);
  }
}

TEST(ConeSmoothing, StartsWhereItIsTold) {
  const Problem problem = family_with_friction({.family = "spheres", .size = 200}, 0.4);
  const Result cold = solve(problem);
  ASSERT_EQ(cold.status, Status::kSolved);
  const Result same = solve(problem, {}, &cold.z);
  EXPECT_EQ(same.status, Status::kSolved);
  EXPECT_EQ(same.statistics.factorizations, 0);
  Problem other = problem;
  other.q *= 1.001;
  const Result warm = solve(other, {}, &cold.z);
  EXPECT_EQ(warm.status, Status::kSolved);
}

TEST(ConeSmoothing, EveryStatus) {
  const Problem problem = family_with_friction({.family = "spheres", .size = 30}, 0.4);
  EXPECT_EQ(solve(problem, {{.max_iterations = 3}}).status, Status::kIterationLimit);
  EXPECT_EQ(solve(problem, {{.max_iterations = 3}}).statistics.iterations, 3);
  EXPECT_EQ(solve(problem, {{.time_limit = 1e-9}}).status, Status::kTimeLimit);
  // Nothing pushes back: no solution, and no claim.
  const Problem hopeless = lcp(Matrix::Zero(1, 1), vector({-1.0}));
  EXPECT_EQ(solve(hopeless).status, Status::kIterationLimit);
  EXPECT_EQ(solve(hopeless).ray.size(), 0);
  Problem broken = problem;
  broken.q[0] = std::nan("");
  EXPECT_EQ(solve(broken).status, Status::kInvalidInput);
  EXPECT_EQ(solve(lcp(Matrix(0, 0), Vector(0))).status, Status::kSolved);
}

/// Next to no friction is none, and a lot sticks.
TEST(ConeSmoothing, TakesEveryCoefficient) {
  for (const double mu : {1e-300, 1e-13, 1e-6, 1e3}) {
    Problem problem = every_row(FrictionLaw::kCoulomb);
    problem.cones[0].coefficient = mu;
    const Result result = solve(problem);
    EXPECT_TRUE(is_solved(result.status)) << mu << " " << to_string(result.status);
  }
}

TEST(ConeSmoothing, RefusesCoupledLimits) {
  Problem problem = lcp(Matrix::Identity(2, 2), vector({-1.0, -1.0}));
  problem.limits.push_back({.row = 1, .normal_row = 0, .coefficient = 0.5});
  EXPECT_NE(ConeSmoothing().refuses(problem).find("coupled limits; row 1"), std::string::npos);
}

TEST(ConeSmoothing, SolvingAgainAllocatesNothing) {
  const Problem problem = family_with_friction({.family = "spheres", .size = 100}, 0.5);
  Problem other = problem;
  other.q *= 0.9;
  ConeSmoothing solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  const AllocationCount allocations;
  solver.solve(other, result);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(result.status, Status::kSolved);
}

}  // namespace
}  // namespace signorini::lcp
