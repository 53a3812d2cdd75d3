// DART's boxed LCPs, handed to us through its own interface, and worlds that step with it.
#include <signorini/integrations/dart/boxed_lcp_solver.h>

#include "tests/integrations/boxed_lcp_problems.h"
#include "tests/integrations/dart/worlds.h"

#include <cmath>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace signorini::dartsim {
namespace {

using ::dart::constraint::DantzigBoxedLcpSolver;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// What DART hands over. The padding of A holds NaN: nobody may read it.
struct DartLcp {
  int n;
  std::vector<double> A;
  lcp::Vector b, x, lo, hi;
  std::vector<int> findex;

  explicit DartLcp(const lcp::BoxedLcp& from)
      : n(static_cast<int>(from.b.size())),
        b(from.b),
        x(from.x),
        lo(from.lower),
        hi(from.upper),
        findex(from.normal_row) {
    const int stride = n > 1 ? (n + 3) / 4 * 4 : n;
    A.assign(static_cast<std::size_t>(n) * stride, kNaN);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) A[static_cast<std::size_t>(i) * stride + j] = from.A(i, j);
    }
  }
  bool solve(::dart::constraint::BoxedLcpSolver& solver, int unbounded = 0) {
    return solver.solve(n, A.data(), x.data(), b.data(), unbounded, lo.data(), hi.data(),
                        findex.data(), true);
  }
};

/// One contact with friction in one direction.
lcp::BoxedLcp one_contact(const lcp::Matrix& A, const lcp::Vector& b, double mu) {
  lcp::BoxedLcp p;
  p.resize(2);
  p.A = A;
  p.b = b;
  p.lower = lcp::Vector{{0.0, -mu}};
  p.upper = lcp::Vector{{kInfinity, mu}};
  p.normal_row = {-1, 0};
  p.x.setZero();
  return p;
}

TEST(DartBoxedLcp, FiveThousandRandomProblemsNoneWronglySolvedNoneSilent) {
  constexpr int kProblems = 5000;
  std::mt19937 random(20250301);
  BoxedLcpSolver solver;
  int told = 0;
  solver.set_not_solved([&](const lcp::Result& result) {
    ++told;
    EXPECT_FALSE(lcp::is_solved(result.status));
  });
  int answered = 0;
  for (int k = 0; k < kProblems; ++k) {
    lcp::BoxedLcp problem = random_boxed_lcp(random);
    DartLcp given(problem);
    const bool is_solved = given.solve(solver);
    ASSERT_EQ(is_solved, lcp::is_solved(solver.last_result().status));
    problem.x = given.x;
    if (is_solved) {
      ++answered;
      ASSERT_LE(residual(problem), allowance(problem, kEpsilon))
          << "problem " << k << " of seed 20250301";
    }
  }
  EXPECT_EQ(told, kProblems - answered);
  EXPECT_EQ(solver.counters().problems, kProblems);
  EXPECT_EQ(solver.counters().not_solved(), told);
  EXPECT_GE(answered, kProblems * 99 / 100);
  RecordProperty("answered", answered);
}

// What DART's Dantzig calls solved and gets right is our answer too, where there is one alone.
TEST(DartBoxedLcp, FrictionlessAnswersAreDantzigs) {
  std::mt19937 random(7);
  BoxedLcpSolver solver;
  DantzigBoxedLcpSolver dantzig;
  int compared = 0;
  for (int k = 0; k < 500; ++k) {
    lcp::BoxedLcp problem = random_boxed_lcp(random);
    for (lcp::Index i = 0; i < problem.b.size(); ++i) {
      if (problem.normal_row[i] >= 0) {
        problem.lower[i] = problem.upper[i] = 0.0;
        problem.normal_row[i] = -1;
      }
      problem.A(i, i) *= 1.0 + 1e-5;  // DART's constraint force mixing: the answer is unique
    }
    DartLcp ours(problem);
    DartLcp theirs(problem);
    ASSERT_TRUE(ours.solve(solver));
    if (!theirs.solve(dantzig)) {
      continue;
    }
    ++compared;
    // |x - x'| <= |w - w'| / (least eigenvalue of A, >= 1e-5 min A_ii)
    EXPECT_LE((ours.x - theirs.x).cwiseAbs().maxCoeff(), 1e-2 * (1.0 + theirs.x.norm()));
    const lcp::Vector w = problem.A * (ours.x - theirs.x);
    EXPECT_LE(w.cwiseAbs().maxCoeff(), 1e-6 * (1.0 + problem.b.norm())) << "problem " << k;
  }
  EXPECT_GE(compared, 400);
}

// Dantzig bounds friction by the normal impulse of the frictionless problem, 1/5; the true one,
// with friction at its bound -x_n/2, is 1/(5 - 2/2) = 1/4.
TEST(DartBoxedLcp, FrictionIsBoundedByTheNormalImpulseOfTheAnswer) {
  lcp::BoxedLcp problem =
      one_contact(lcp::Matrix{{5.0, 2.0}, {2.0, 3.0}}, lcp::Vector{{1.0, -1.5}}, 0.5);
  DartLcp theirs(problem);
  DantzigBoxedLcpSolver dantzig;
  EXPECT_TRUE(theirs.solve(dantzig));  // it says solved
  problem.x = theirs.x;
  EXPECT_GE(residual(problem), 1e-3);

  BoxedLcpSolver solver;
  problem.x.setZero();
  DartLcp ours(problem);
  ASSERT_TRUE(ours.solve(solver));
  EXPECT_NEAR(ours.x[0], 0.25, 1e-8);
  EXPECT_NEAR(ours.x[1], -0.125, 1e-8);
}

TEST(DartBoxedLcp, ARowThatNamesItselfOrNoneHasItsOwnBounds) {
  lcp::BoxedLcp problem =
      one_contact(lcp::Matrix{{1.0, 0.0}, {0.0, 1.0}}, lcp::Vector{{2.0, 3.0}}, 0.5);
  problem.normal_row = {0, 1};
  DartLcp own(problem);
  BoxedLcpSolver solver;
  ASSERT_TRUE(own.solve(solver));
  EXPECT_NEAR(own.x[0], 2.0, 1e-7);
  EXPECT_NEAR(own.x[1], 0.5, 1e-7);
  problem.normal_row = {-1, 0};
  DartLcp coupled(problem);
  ASSERT_TRUE(coupled.solve(solver));
  EXPECT_NEAR(coupled.x[1], 1.0, 1e-7);
}

TEST(DartBoxedLcp, TheFirstRowsAreUnboundedWhateverTheirBoundsSay) {
  DartLcp given(one_contact(lcp::Matrix{{1.0, 0.0}, {0.0, 1.0}}, lcp::Vector{{-2.0, 9.0}}, 0.5));
  given.findex[1] = -1;
  BoxedLcpSolver solver;
  ASSERT_TRUE(given.solve(solver, /*unbounded=*/1));
  EXPECT_NEAR(given.x[0], -2.0, 1e-7);
  EXPECT_NEAR(given.x[1], 0.5, 1e-7);
}

TEST(DartBoxedLcp, WhatIsNoProblemIsInvalidInputAndPushesNothing) {
  BoxedLcpSolver solver;
  const auto ends_invalid = [&](DartLcp& given, const std::string& words) {
    given.x.setConstant(3.0);
    EXPECT_FALSE(given.solve(solver));
    EXPECT_EQ(solver.last_result().status, lcp::Status::kInvalidInput);
    EXPECT_NE(solver.last_result().detail.find(words), std::string::npos)
        << solver.last_result().detail;
    EXPECT_TRUE(given.x.isZero(0.0));
  };
  const lcp::BoxedLcp good =
      one_contact(lcp::Matrix::Identity(2, 2), lcp::Vector::Constant(2, 1.0), 0.5);
  DartLcp range(good);
  range.findex[1] = 7;
  ends_invalid(range, "row 1 depends on row 7");
  DartLcp bounds(good);
  bounds.lo[1] = -0.25;
  ends_invalid(bounds, "row 1: coupled bounds must be -mu and mu, got -0.25 and 0.5");
  DartLcp nan(good);
  nan.b[0] = kNaN;
  ends_invalid(nan, "nan");
  EXPECT_EQ(solver.counters().count(lcp::Status::kInvalidInput), 3);
}

TEST(DartBoxedLcp, AnInfeasibleProblemIsToldAndNotSolved) {
  lcp::BoxedLcp problem;  // one impulse cannot part what it cannot move
  problem.resize(2);
  problem.A = lcp::Matrix{{1.0, -1.0}, {-1.0, 1.0}};
  problem.b = lcp::Vector{{1.0, 1.0}};
  problem.lower.setZero();
  problem.upper.setConstant(kInfinity);
  problem.normal_row = {-1, -1};
  problem.x.setZero();
  DartLcp given(problem);
  BoxedLcpSolver solver;
  EXPECT_FALSE(given.solve(solver));
  EXPECT_EQ(solver.last_result().status, lcp::Status::kInfeasible);
}

TEST(DartBoxedLcp, HasATypeOfItsOwnAndTakesEveryMatrix) {
  const BoxedLcpSolver solver;
  const ::dart::constraint::BoxedLcpSolver& base = solver;
  EXPECT_TRUE(base.is<BoxedLcpSolver>());
  EXPECT_FALSE(base.is<DantzigBoxedLcpSolver>());
  EXPECT_TRUE(BoxedLcpSolver().canSolve(1, nullptr));
}

// A box of 2 kg slides at 2 m/s with mu = .4 until friction stops it after v^2 / (2 mu g); each
// step's friction acts a whole step, which costs h v / 2.
TEST(DartWorld, ABoxSlidesAsFarAsFrictionLetsIt) {
  constexpr double kSpeed = 2.0, kFriction = 0.4;
  const auto slide = [&](const ::dart::constraint::BoxedLcpSolverPtr& solver) {
    const auto world = world_with_floor(solver, kFriction);
    const auto box = cube("box", 0.5, 2.0, kFriction);
    place(*box, Eigen::Vector3d(0.0, 0.0, 0.25));
    world->addSkeleton(box);
    for (int i = 0; i < 200; ++i) world->step();  // lands
    const double start = position(box).x();
    Eigen::VectorXd v = box->getVelocities();
    v[3] += kSpeed;
    box->setVelocities(v);
    for (int i = 0; i < 1000; ++i) world->step();
    EXPECT_LE(box->getVelocities().cwiseAbs().maxCoeff(), 1e-3);
    return position(box).x() - start;
  };
  const auto solver = std::make_shared<BoxedLcpSolver>();
  const double ours = slide(solver);
  const double closed_form = kSpeed * kSpeed / (2.0 * kFriction * 9.81);
  EXPECT_NEAR(ours, closed_form, 0.01 * closed_form);
  EXPECT_NEAR(ours, slide(std::make_shared<DantzigBoxedLcpSolver>()), 0.01 * closed_form);
  EXPECT_GE(solver->counters().problems, 1000);
  EXPECT_EQ(solver->counters().not_solved(), 0);
}

// Five boxes for one second: they sink by 2e-7 m, which is DART's constraint force mixing, and do
// not go sideways. With DART's Dantzig, whose friction is not bound by its own normal impulses,
// they go 3e-4 m sideways.
TEST(DartWorld, AStackOfBoxesStandsAsWithDantzigAndEveryStepIsCertified) {
  constexpr int kBoxes = 5;
  const auto stand = [](const ::dart::constraint::BoxedLcpSolverPtr& with) {
    const auto world = world_with_floor(with, 0.5);
    std::vector<::dart::dynamics::SkeletonPtr> stack;
    for (int k = 0; k < kBoxes; ++k) {
      stack.push_back(cube("box" + std::to_string(k), 0.5, 1.0, 0.5));
      place(*stack.back(), Eigen::Vector3d(0.0, 0.0, 0.25 + 0.5 * k));
      world->addSkeleton(stack.back());
    }
    for (int i = 0; i < 1000; ++i) world->step();
    std::vector<Eigen::Vector3d> ends;
    for (const auto& box : stack) ends.push_back(position(box));
    return ends;
  };
  const auto solver = std::make_shared<BoxedLcpSolver>();
  const auto ours = stand(solver);
  const auto theirs = stand(std::make_shared<DantzigBoxedLcpSolver>());
  for (int k = 0; k < kBoxes; ++k) {
    const Eigen::Vector3d start(0.0, 0.0, 0.25 + 0.5 * k);
    EXPECT_LE((ours[k] - start).norm(), 1e-6) << "box " << k;
    EXPECT_LE((ours[k] - start).head<2>().norm(), 1e-9) << "box " << k;
    EXPECT_LE((ours[k] - theirs[k]).norm(), 1e-3) << "box " << k;
  }
  EXPECT_GE(solver->counters().problems, 900);
  EXPECT_EQ(solver->counters().not_solved(), 0);
}

}  // namespace
}  // namespace signorini::dartsim
