#include <signorini/lcp/boxed_lcp.h>

#include "tests/integrations/boxed_lcp_problems.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

TEST(BoxedLcp, SolvedHoldsForTheHostsNumbers) {
  std::mt19937 random(3);
  BoxedLcpSolver solver;
  int answered = 0;
  for (int k = 0; k < 300; ++k) {
    BoxedLcp problem = random_boxed_lcp(random);
    if (solver.solve(problem)) {
      ++answered;
      ASSERT_LE(residual(problem), allowance(problem, kEpsilon)) << "problem " << k << " of seed 3";
    }
    EXPECT_EQ(problem.x, solver.last_result().z);
  }
  EXPECT_GE(answered, 297);
  EXPECT_EQ(solver.counters().problems, 300);
  EXPECT_EQ(solver.counters().not_solved(), 300 - answered);
}

/// Handed on dense up to 100 rows, sparse beyond.
TEST(BoxedLcp, TakesManyRows) {
  for (const Index n : {1, 100, 101, 200}) {
    BoxedLcp problem;
    problem.resize(n);
    problem.A = 2.0 * Matrix::Identity(n, n);
    problem.A.diagonal(1).setConstant(-0.5);
    problem.A.diagonal(-1).setConstant(-0.5);
    problem.b.setOnes();
    problem.lower.setZero();
    problem.upper.setConstant(std::numeric_limits<double>::infinity());
    problem.x.setZero();
    problem.normal_row.assign(static_cast<std::size_t>(n), -1);
    BoxedLcpSolver solver;
    EXPECT_TRUE(solver.solve(problem)) << n;
    EXPECT_LE(residual(problem), allowance(problem, kEpsilon)) << n;
  }
}

/// A normal and its friction, as a host hands them over.
BoxedLcp one_contact() {
  BoxedLcp problem;
  problem.resize(2);
  problem.A = Matrix::Identity(2, 2);
  problem.b = Vector{{2.0, 5.0}};
  problem.lower = Vector{{0.0, -0.5}};
  problem.upper = Vector{{std::numeric_limits<double>::infinity(), 0.5}};
  problem.normal_row = {-1, 0};
  problem.x = Vector::Zero(2);
  return problem;
}

TEST(BoxedLcp, FrictionIsBoundedByTheNormalOfTheAnswer) {
  BoxedLcp problem = one_contact();
  BoxedLcpSolver solver;
  ASSERT_TRUE(solver.solve(problem));
  EXPECT_NEAR(problem.x[0], 2.0, 1e-8);
  EXPECT_NEAR(problem.x[1], 1.0, 1e-8);
}

TEST(BoxedLcp, WhatIsNoProblemIsToldAndChangesNothing) {
  BoxedLcpSolver solver;
  int told = 0;
  solver.set_not_solved([&](const Result& result) {
    ++told;
    EXPECT_EQ(result.status, Status::kInvalidInput);
  });
  const auto refused = [&](void (*spoil)(BoxedLcp&)) {
    BoxedLcp problem = one_contact();
    spoil(problem);
    const Vector before = problem.x;
    EXPECT_FALSE(solver.solve(problem));
    EXPECT_EQ(problem.x, before);
    return solver.last_result().detail;
  };
  EXPECT_NE(refused([](BoxedLcp& p) { p.lower.resize(1); }).find("differ in size"),
            std::string::npos);
  EXPECT_NE(refused([](BoxedLcp& p) { p.normal_row[1] = 2; }).find("row 1"), std::string::npos);
  EXPECT_NE(refused([](BoxedLcp& p) { p.normal_row[0] = 1; }).find("depends itself"),
            std::string::npos);
  EXPECT_NE(refused([](BoxedLcp& p) { p.lower[1] = -0.4; }).find("-0.4"), std::string::npos);
  EXPECT_NE(refused([](BoxedLcp& p) { p.upper[1] = p.lower[1] = std::nan(""); }).find("row 1"),
            std::string::npos);
  EXPECT_EQ(told, 5);
  EXPECT_EQ(solver.counters().count(Status::kInvalidInput), 5);
}

}  // namespace
}  // namespace signorini::lcp
