#include <signorini/lcp/frictionless.h>
#include <signorini/lcp/ray.h>

#include "tests/lcp/allocation_count.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace signorini::lcp {
namespace {

Vector vector(std::initializer_list<double> values) {
  return Eigen::Map<const Vector>(values.begin(), static_cast<Index>(values.size()));
}

/// A ball of 1 kg between two walls that close in by `speed` each, opposite but for a lean of the
/// second one, with friction: z in x and y, normals first in each contact.
Problem ball_between_walls(double speed, double slip, double lean = 0.0) {
  FactoredMatrix A;
  const int ball = A.mass.add_mass(Matrix::Identity(2, 2));
  for (const Vector& axis :
       {vector({1.0, 0.0}), vector({0.0, 1.0}), vector({-1.0, lean}), vector({0.0, 1.0})}) {
    A.add_row();
    A.add_entry(ball, axis);
  }
  Problem problem;
  problem.M = A;
  problem.q = vector({-speed, slip, -speed, slip});
  problem.cones = {{.normal_row = 0, .dimension = 2, .coefficient = 0.5},
                   {.normal_row = 2, .dimension = 2, .coefficient = 0.5}};
  return problem;
}

Problem with_matrix(const Problem& problem, bool sparse) {
  Problem copy = problem;
  const Matrix M = to_dense(problem.M);
  copy.M = sparse ? MatrixForm(SparseMatrix(M.sparseView())) : MatrixForm(M);
  return copy;
}

Result solve(const Problem& problem) {
  Result result;
  Frictionless().solve(problem, result);
  return result;
}

TEST(Frictionless, ProvesThatNoFrictionSavesASqueezedBall) {
  for (const FrictionLaw law : {FrictionLaw::kCoulomb, FrictionLaw::kAssociated}) {
    Problem problem = ball_between_walls(0.5, 2.0);
    problem.friction_law = law;
    for (const Problem& form : {problem, with_matrix(problem, false), with_matrix(problem, true)}) {
      const Result result = solve(form);
      EXPECT_EQ(result.status, Status::kInfeasible) << result.detail;
      ASSERT_EQ(result.ray.size(), 4);
      EXPECT_EQ(result.ray[1], 0.0);
      EXPECT_EQ(result.ray[0], result.ray[2]);
      EXPECT_EQ(result.ray_bound, std::numeric_limits<double>::infinity());
    }
  }
}

TEST(Frictionless, BoundsTheImpulsesOfABallThatIsNearlySqueezed) {
  // The second wall leans by 2^-40: A y = 2^-40 (0, 1, 2^-40, 1) for y = (1, 0, 1, 0), q.y = -1,
  // and mu = 1/2 of the first tangential row counts for its normal.
  const double lean = 0x1p-40;
  const Problem problem = ball_between_walls(0.5, 0.0, lean);
  const RayVerdict verdict = judge_ray(problem, vector({1.0, 0.0, 1.0, 0.0}));
  EXPECT_EQ(verdict.status, Status::kNoSolutionBelow);
  const double growth = lean * (lean + 0.5);
  EXPECT_NEAR(verdict.bound, 1.0 / growth, 1e-12 / growth);
  EXPECT_LE(verdict.bound, 1.0 / growth);
  EXPECT_GT(verdict.defect, 0.0);
  EXPECT_LT(verdict.defect, 1e-12);
}

TEST(Frictionless, AnswersWhatDoesNotSlide) {
  const Result result = solve(ball_between_walls(-0.5, 0.0));
  EXPECT_EQ(result.status, Status::kSolved);
  Problem pushed = ball_between_walls(-1.0, 0.0);
  pushed.q[0] = -1.0;
  const Result one = solve(pushed);
  EXPECT_EQ(one.status, Status::kSolved) << one.detail;
  EXPECT_EQ(one.z, vector({1.0, 0.0, 0.0, 0.0}));
}

TEST(Frictionless, KeepsItsIterateWhereFrictionWouldAct) {
  Problem problem = ball_between_walls(-1.0, 0.25);
  problem.q[0] = -1.0;
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kStalled);
  EXPECT_EQ(result.detail, "solved without friction");
  EXPECT_EQ(result.z, vector({1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(result.ray.size(), 0);
}

TEST(Frictionless, TakesNoRowsAndRefusesWhatItCannotJudge) {
  Problem empty;
  empty.M = Matrix(0, 0);
  EXPECT_EQ(solve(empty).status, Status::kSolved);
  Problem bad = ball_between_walls(0.5, 0.0);
  bad.q[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve(bad).status, Status::kInvalidInput);
  Problem bounded = ball_between_walls(0.5, 0.0);
  bounded.lower = Vector::Constant(4, -1.0);
  EXPECT_THROW(solve(bounded), std::invalid_argument);
  Problem skew = with_matrix(ball_between_walls(0.5, 0.0), false);
  std::get<Matrix>(skew.M)(0, 2) = 0.5;
  EXPECT_THROW(solve(skew), std::invalid_argument);
}

TEST(Frictionless, AllocatesNothingTheSecondTime) {
  const Problem problem = ball_between_walls(-1.0, 0.25);
  Frictionless solver;
  Result result;
  solver.solve(problem, result);
  const AllocationCount count;
  solver.solve(problem, result);
  EXPECT_EQ(count.count(), 0);
}

TEST(Ray, WithConesHasNoTangentialRows) {
  const Problem problem = ball_between_walls(0.5, 2.0);
  EXPECT_EQ(judge_ray(problem, vector({3.0, 0.0, 3.0, 0.0})).status, Status::kInfeasible);
  EXPECT_EQ(judge_ray(problem, vector({3.0, 1e-300, 3.0, 0.0})).status, Status::kRayUnproven);
  EXPECT_EQ(judge_ray(problem, vector({1.0, 0.0, 0.0, 0.0})).status, Status::kNoSolutionBelow);
  Problem open = ball_between_walls(-0.5, 0.0);
  EXPECT_EQ(judge_ray(open, vector({1.0, 0.0, 1.0, 0.0})).status, Status::kRayUnproven);
}

}  // namespace
}  // namespace signorini::lcp
