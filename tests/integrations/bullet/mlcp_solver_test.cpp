// Bullet's mixed LCPs, handed to us through its own interface. For each precision.
#include <signorini/integrations/bullet/example_scenes/example_scenes.h>
#include <signorini/integrations/bullet/mlcp_solver.h>

#include "tests/integrations/boxed_lcp_problems.h"

#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>

namespace signorini::bullet {
namespace {

/// What btMLCPSolver hands over.
struct Mlcp {
  btMatrixXu A;
  btVectorXu b, x, lo, hi;
  btAlignedObjectArray<int> dependencies;

  explicit Mlcp(int n) {
    A.resize(n, n);
    A.setZero();
    for (btVectorXu* v : {&b, &x, &lo, &hi}) {
      v->resize(n);
      v->setZero();
    }
    dependencies.resize(n, -1);
  }
  bool solve(MlcpSolver& solver) { return solver.solveMLCP(A, b, x, lo, hi, dependencies, 50); }
};

/// Bullet writes infinity in two ways: 1e10 at contacts, SIMD_INFINITY at joints.
btScalar bullet_bound(double limit, bool is_contact) {
  const double infinity = is_contact ? 1e10 : double(SIMD_INFINITY);
  return btScalar(std::isinf(limit) ? std::copysign(infinity, limit) : limit);
}

Mlcp random_mlcp(std::mt19937& random) {
  const lcp::BoxedLcp from = random_boxed_lcp(random);
  const int n = static_cast<int>(from.b.size());
  Mlcp made(n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) made.A.setElem(i, j, btScalar(from.A(i, j)));
    made.b[i] = btScalar(from.b[i]);
    made.lo[i] = bullet_bound(from.lower[i], false);
    made.hi[i] = bullet_bound(from.upper[i], from.lower[i] == 0.0);
    made.dependencies[i] = from.normal_row[i];
  }
  return made;
}

/// Bullet's numbers, as they are.
lcp::BoxedLcp numbers_of(const Mlcp& p) {
  lcp::BoxedLcp numbers;
  numbers.resize(p.b.rows());
  for (int i = 0; i < p.b.rows(); ++i) {
    for (int j = 0; j < p.b.rows(); ++j) numbers.A(i, j) = double(p.A(i, j));
    numbers.b[i] = double(p.b[i]);
    numbers.lower[i] = double(p.lo[i]);
    numbers.upper[i] = double(p.hi[i]);
    numbers.normal_row[i] = p.dependencies[i];
    numbers.x[i] = double(p.x[i]);
  }
  return numbers;
}

TEST(BulletMlcp, FiveThousandRandomProblemsNoneWronglySolvedNoneSilent) {
  constexpr int kProblems = 5000;
  std::mt19937 random(20240611);
  MlcpSolver solver;
  int told = 0;
  solver.set_not_solved([&](const lcp::Result& result) {
    ++told;
    EXPECT_FALSE(lcp::is_solved(result.status));
  });
  int answered = 0;
  int refused = 0;
  for (int k = 0; k < kProblems; ++k) {
    Mlcp problem = random_mlcp(random);
    if (problem.solve(solver)) {
      ++answered;
      const lcp::BoxedLcp numbers = numbers_of(problem);
      ASSERT_LE(residual(numbers),
                allowance(numbers, double(std::numeric_limits<btScalar>::epsilon())))
          << "problem " << k << " of seed 20240611";
    } else {
      ++refused;
      ASSERT_FALSE(lcp::is_solved(solver.last_result().status));
    }
  }
  EXPECT_EQ(told, refused);
  EXPECT_EQ(solver.counters().problems, kProblems);
  EXPECT_EQ(solver.counters().not_solved(), refused);
  EXPECT_GE(answered, kProblems * 99 / 100);
  RecordProperty("answered", answered);
}

TEST(BulletMlcp, FrictionFollowsTheNormalImpulse) {
  Mlcp p(2);  // 2 kg falling at 3 m/s, sliding at 10 m/s, mu = .5
  p.A.setElem(0, 0, btScalar(0.5));
  p.A.setElem(1, 1, btScalar(0.5));
  p.b[0] = 3;
  p.b[1] = -10;
  p.hi[0] = btScalar(1e10);
  p.lo[1] = btScalar(-0.5);
  p.hi[1] = btScalar(0.5);
  p.dependencies[1] = 0;
  MlcpSolver solver;
  ASSERT_TRUE(p.solve(solver));
  EXPECT_NEAR(double(p.x[0]), 6.0, 1e-6);
  EXPECT_NEAR(double(p.x[1]), -3.0, 1e-6);
}

TEST(BulletMlcp, WhatIsNoProblemIsInvalidInput) {
  MlcpSolver solver;
  const auto ends_invalid = [&](Mlcp& p, const std::string& words) {
    EXPECT_FALSE(p.solve(solver));
    EXPECT_EQ(solver.last_result().status, lcp::Status::kInvalidInput);
    EXPECT_NE(solver.last_result().detail.find(words), std::string::npos)
        << solver.last_result().detail;
  };
  Mlcp sizes(2);
  sizes.lo.resize(1);
  ends_invalid(sizes, "size");
  Mlcp range(2);
  range.dependencies[1] = 7;
  ends_invalid(range, "row 1 depends on row 7");
  Mlcp chain(3);
  chain.dependencies[1] = 2;
  chain.dependencies[2] = 0;
  ends_invalid(chain, "depends itself");
  Mlcp bounds(2);
  bounds.dependencies[1] = 0;
  bounds.lo[1] = btScalar(-0.5);
  bounds.hi[1] = btScalar(0.25);
  ends_invalid(bounds, "row 1: coupled bounds");
  Mlcp nan(1);
  nan.hi[0] = btScalar(1e10);
  nan.b[0] = std::numeric_limits<btScalar>::quiet_NaN();
  ends_invalid(nan, "nan");
  EXPECT_EQ(solver.counters().count(lcp::Status::kInvalidInput), 5);
}

TEST(BulletMlcp, AnEmptyProblemIsSolved) {
  Mlcp p(0);
  MlcpSolver solver;
  EXPECT_TRUE(p.solve(solver));
}

TEST(BulletMlcp, AnInfeasibleProblemIsNotSolved) {
  Mlcp p(2);  // one impulse cannot part what it cannot move
  p.A.setElem(0, 0, 1);
  p.A.setElem(0, 1, -1);
  p.A.setElem(1, 0, -1);
  p.A.setElem(1, 1, 1);
  p.b[0] = 1;
  p.b[1] = 1;
  p.hi[0] = p.hi[1] = btScalar(1e10);
  MlcpSolver solver;
  EXPECT_FALSE(p.solve(solver));
  EXPECT_EQ(solver.last_result().status, lcp::Status::kInfeasible);
}

// Bullet's own fallbacks are just the problems that we said were not solved.
TEST(BulletMlcp, BulletsFallbacksAreOurRefusals) {
  MlcpSolver mlcp;
  btMLCPSolver solver(&mlcp);
  ExampleScene scene("ragdoll", solver);
  scene.world().getSolverInfo().m_minimumSolverBatchSize = 1;
  scene.world().getSolverInfo().m_splitImpulse = 0;
  for (int i = 0; i < 120; ++i) scene.step();
  EXPECT_GE(mlcp.counters().problems, 100);
  EXPECT_EQ(solver.getNumFallbacks(), mlcp.counters().not_solved());
  EXPECT_LE(scene.joint_error(), 2e-2);
}

}  // namespace
}  // namespace signorini::bullet
