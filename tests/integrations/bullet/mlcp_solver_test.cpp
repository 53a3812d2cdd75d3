// Bullet's mixed LCPs, handed to us through its own interface. For each precision.
#include <signorini/integrations/bullet/example_scenes/example_scenes.h>
#include <signorini/integrations/bullet/mlcp_solver.h>

#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <Eigen/Geometry>
#include <algorithm>
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

/// Contacts of a few bodies with friction in one or two directions, some repeated, and joint rows,
/// free or limited. A = J W J^T, b = -J v.
Mlcp random_mlcp(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto pick = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  const int bodies = pick(1, 4);
  const int joint_rows = pick(0, 2) == 0 ? pick(1, 3) : 0;
  const int contacts = pick(joint_rows > 0 ? 0 : 1, 8);
  const int tangents = pick(1, 2);
  const int n = joint_rows + contacts * (1 + tangents);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, 6 * bodies);
  Eigen::VectorXd W(6 * bodies);
  for (Eigen::Index i = 0; i < W.size(); ++i) W[i] = std::pow(10.0, 0.5 * uniform(random));
  const auto fill = [&](int row, int a, int b, const Eigen::Vector3d& axis,
                        const Eigen::Vector3d& r) {
    J.block<1, 3>(row, 6 * a) = axis.transpose();
    J.block<1, 3>(row, 6 * a + 3) = r.cross(axis).transpose();
    if (b >= 0) {
      J.block<1, 3>(row, 6 * b) = -axis.transpose();
      J.block<1, 3>(row, 6 * b + 3) = r.cross(axis).transpose();
    }
  };
  const auto vector = [&] {
    return Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  };
  const auto other_than = [&](int a) { return a == 0 ? -1 : pick(0, a) - 1; };
  Mlcp made(n);
  for (int row = 0; row < joint_rows; ++row) {
    const int a = pick(0, bodies - 1);
    fill(row, a, other_than(a), vector(), vector());
    const bool limited = pick(0, 1) == 1;
    made.lo[row] = limited ? btScalar(-0.5) : -SIMD_INFINITY;
    made.hi[row] = limited ? btScalar(0.5) : SIMD_INFINITY;
  }
  for (int c = 0; c < contacts; ++c) {  // normals first, then all tangents, as Bullet has them
    const int normal = joint_rows + c;
    const int first = joint_rows + contacts + c * tangents;
    if (c > 0 && pick(0, 3) == 0) {  // the same contact again
      J.row(normal) = J.row(normal - 1);
      for (int t = 0; t < tangents; ++t) J.row(first + t) = J.row(first + t - tangents);
    } else {
      const int a = pick(0, bodies - 1);
      const int b = other_than(a);
      const Eigen::Vector3d axis = vector().normalized();
      const Eigen::Vector3d r = vector();
      fill(normal, a, b, axis, r);
      const Eigen::Vector3d t1 = axis.unitOrthogonal();
      fill(first, a, b, t1, r);
      if (tangents == 2) fill(first + 1, a, b, axis.cross(t1), r);
    }
    made.hi[normal] = btScalar(1e10);
    const double mu = pick(0, 4) == 0 ? 0.0 : 0.6 + 0.5 * uniform(random);
    for (int t = 0; t < tangents; ++t) {
      made.dependencies[first + t] = normal;
      made.lo[first + t] = btScalar(-mu);
      made.hi[first + t] = btScalar(mu);
    }
  }
  const Eigen::VectorXd v =
      Eigen::VectorXd::NullaryExpr(6 * bodies, [&] { return uniform(random); });
  const Eigen::MatrixXd A = J * W.asDiagonal() * J.transpose();
  const Eigen::VectorXd b = -J * v;
  for (int i = 0; i < n; ++i) {
    made.b[i] = btScalar(b[i]);
    for (int j = 0; j < n; ++j) made.A.setElem(i, j, btScalar(A(std::max(i, j), std::min(i, j))));
  }
  return made;
}

/// max_i |x_i - clamp(x_i - w_i, lo, hi)| / (1 + |b|), from Bullet's numbers alone.
double residual(const Mlcp& p) {
  long double most = 0.0L;
  long double b_inf = 0.0L;
  for (int i = 0; i < p.b.rows(); ++i) {
    long double w = -static_cast<long double>(p.b[i]);
    for (int j = 0; j < p.b.rows(); ++j) {
      w += static_cast<long double>(p.A(i, j)) * static_cast<long double>(p.x[j]);
    }
    const long double scale =
        p.dependencies[i] < 0 ? 1.0L
                              : std::max(static_cast<long double>(p.x[p.dependencies[i]]), 0.0L);
    const auto low = static_cast<long double>(p.lo[i]) * scale;
    const auto high = static_cast<long double>(p.hi[i]) * scale;
    const auto x = static_cast<long double>(p.x[i]);
    most = std::max(most, std::abs(x - std::clamp(x - w, low, high)));
    b_inf = std::max(b_inf, std::abs(static_cast<long double>(p.b[i])));
  }
  return static_cast<double>(most / (1.0L + b_inf));
}

/// What a status allows: the tolerance, and four times what rounding x (in a float build once more)
/// costs.
double allowance(const Mlcp& p) {
  double most = 0.0;
  double b_inf = 0.0;
  for (int i = 0; i < p.b.rows(); ++i) {
    double size = std::abs(double(p.b[i])) + std::abs(double(p.x[i]));
    for (int j = 0; j < p.b.rows(); ++j) size += std::abs(double(p.A(i, j)) * double(p.x[j]));
    most = std::max(most, size);
    b_inf = std::max(b_inf, std::abs(double(p.b[i])));
  }
  return 1e-8 + 4.0 * double(std::numeric_limits<btScalar>::epsilon()) * most / (1.0 + b_inf);
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
      ASSERT_LE(residual(problem), allowance(problem)) << "problem " << k << " of seed 20240611";
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
