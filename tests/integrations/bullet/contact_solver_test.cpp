// The cheap way first: which route gives the answer, and that it is one.
#include <signorini/integrations/bullet/contact_solver.h>

#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace signorini::bullet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Two contacts of one point mass of 2 kg that falls at 1 m/s and slips at `slip`: the same contact
/// twice, so that the impulses are not unique. mu = .5.
lcp::Problem two_contacts(double slip) {
  lcp::Problem problem;
  lcp::FactoredMatrix A;
  A.mass.add_inverse(0.5 * lcp::Matrix::Identity(3, 3));
  for (int row = 0; row < 6; ++row) {
    A.add_row();
    A.add_entry(0, lcp::Vector::Unit(3, row % 3));
  }
  problem.M = A;
  problem.q = lcp::Vector{{-1.0, slip, 0.0, -1.0, slip, 0.0}};
  problem.lower = lcp::Vector{{0.0, -kInfinity, -kInfinity, 0.0, -kInfinity, -kInfinity}};
  problem.upper = lcp::Vector::Constant(6, kInfinity);
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 0.5},
                   {.normal_row = 3, .dimension = 3, .coefficient = 0.5}};
  return problem;
}

TEST(BulletContactSolver, StickingNeedsNoCoupling) {
  ContactSolver solver({});
  lcp::Problem problem = two_contacts(0.4);
  lcp::Result result;
  EXPECT_EQ(solver.solve(problem, nullptr, result), Route::kSticking);
  EXPECT_TRUE(lcp::is_solved(result.status));
  EXPECT_NEAR(result.z[0] + result.z[3], 2.0, 1e-8);
  EXPECT_NEAR(result.z[1] + result.z[4], -0.8, 1e-8);
  EXPECT_EQ(problem.cones.size(), 2u);  // as it was
  EXPECT_EQ(result.attempts.size(), 1u);
}

TEST(BulletContactSolver, SlidingIsCoupled) {
  ContactSolver solver({});
  lcp::Problem problem = two_contacts(3.0);
  lcp::Result result;
  EXPECT_EQ(solver.solve(problem, nullptr, result), Route::kCoupled);
  EXPECT_TRUE(lcp::is_solved(result.status));
  EXPECT_NEAR(result.z[1] + result.z[4], -1.0, 1e-7);
  EXPECT_NEAR(result.w[1], 2.5, 1e-7);

  // From there on it is known, and known to slip.
  lcp::Result again;
  const lcp::Vector start = result.z;
  EXPECT_EQ(solver.solve(problem, &start, again), Route::kUnchanged);
  EXPECT_TRUE(lcp::is_solved(again.status));
  problem.q *= 1.5;
  EXPECT_EQ(solver.solve(problem, &start, again), Route::kCoupled);
  EXPECT_NEAR(again.z[1] + again.z[4], -1.5, 1e-7);
  EXPECT_NE(again.attempts.front().solver, "interior-point");
}

TEST(BulletContactSolver, BoxesAndNoFriction) {
  ContactSolver solver({.friction = FrictionModel::kBox});
  lcp::Problem problem = two_contacts(3.0);
  problem.cones.clear();
  for (const int normal : {0, 3}) {
    for (const int row : {normal + 1, normal + 2}) {
      problem.limits.push_back({.row = row, .normal_row = normal, .coefficient = 0.5});
    }
  }
  lcp::Result result;
  EXPECT_EQ(solver.solve(problem, nullptr, result), Route::kCoupled);
  EXPECT_NEAR(result.z[1] + result.z[4], -1.0, 1e-7);
  problem.limits.clear();
  EXPECT_EQ(solver.solve(problem, nullptr, result), Route::kBounds);
  EXPECT_NEAR(result.z[1] + result.z[4], -6.0, 1e-7);
}

TEST(BulletContactSolver, TheRecorderIsToldOfTheWholeProblem) {
  struct Recorder : lcp::SolveRecorder {
    std::string record(const lcp::SolveRecord& record) override {
      ++told;
      cones = record.problem.cones.size();
      status = record.result.status;
      return told == 1 ? "" : "disk full";
    }
    int told = 0;
    std::size_t cones = 0;
    lcp::Status status = lcp::Status::kNotRun;
  } recorder;
  ContactSolver solver({.recorder = &recorder});
  lcp::Problem problem = two_contacts(0.4);
  lcp::Result result;
  solver.solve(problem, nullptr, result);
  EXPECT_EQ(recorder.told, 1);
  EXPECT_EQ(recorder.cones, 2u);
  EXPECT_TRUE(lcp::is_solved(recorder.status));
  solver.solve(problem, nullptr, result);
  EXPECT_NE(result.detail.find("disk full"), std::string::npos);
}

TEST(BulletContactSolver, BadNumbersAndNoTimeAreStatuses) {
  lcp::Problem problem = two_contacts(0.4);
  lcp::Result result;
  ContactSolver hurried({.time_limit = 1e-12});
  hurried.solve(problem, nullptr, result);
  EXPECT_EQ(result.status, lcp::Status::kTimeLimit);
  problem.q[0] = std::numeric_limits<double>::quiet_NaN();
  ContactSolver solver({});
  const lcp::Vector start = lcp::Vector::Zero(6);
  solver.solve(problem, &start, result);
  EXPECT_EQ(result.status, lcp::Status::kInvalidInput);
}

TEST(BulletContactSolver, EveryRouteHasAName) {
  for (const Route route :
       {Route::kNone, Route::kUnchanged, Route::kBounds, Route::kSticking, Route::kCoupled}) {
    EXPECT_FALSE(to_string(route).empty());
  }
}

}  // namespace
}  // namespace signorini::bullet
