#include <signorini/lcp/pgs.h>

#include "definition_residual.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr unsigned kSeed = 20240607;

/// Bodies of various dimensions, each row on one or two of them; more rows than degrees of freedom
/// gives a singular A. With `compliance`, every third row has some.
FactoredMatrix random_factored(int bodies, int rows, bool compliant, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  FactoredMatrix A;
  for (int b = 0; b < bodies; ++b) {
    const int d = b % 3 == 2 ? 2 : 6;
    const Matrix root = Matrix::NullaryExpr(d, d, [&] { return uniform(random); });
    const Matrix positive = root * root.transpose() + Matrix::Identity(d, d);
    const Matrix symmetric = 0.5 * (positive + positive.transpose());
    b % 2 == 0 ? A.mass.add_mass(symmetric) : A.mass.add_inverse(symmetric);
  }
  for (int i = 0; i < rows; ++i) {
    A.add_row(compliant && i % 3 == 0 ? 0.1 : 0.0);
    const int first = static_cast<int>(random() % bodies);
    const int second = static_cast<int>(random() % bodies);
    for (const int body : {first, second}) {
      if (body == second && first == second && A.entries(i).size() == 1) {
        continue;
      }
      A.add_entry(body,
                  Vector::NullaryExpr(A.mass.dimension(body), [&] { return uniform(random); }));
    }
  }
  return A;
}

/// q = w - A z for complementary z, w >= 0: a problem with a solution.
Vector feasible_q(const FactoredMatrix& A, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  Vector z = Vector::Zero(A.rows());
  Vector w = Vector::Zero(A.rows());
  for (int i = 0; i < A.rows(); ++i) {
    (random() % 2 == 0 ? z : w)[i] = uniform(random);
  }
  Vector product(A.rows());
  A.multiply(z.data(), product.data());
  return w - product;
}

Problem with_matrix(const Problem& problem, MatrixForm M) {
  return {std::move(M), problem.q, problem.lower, problem.upper, problem.limits};
}

Problem problem_of(MatrixForm M, const Vector& q) {
  return {std::move(M), q, {}, {}, {}};
}

Problem dense_problem(const Matrix& M, const Vector& q) {
  return problem_of(M, q);
}

Result solve(const Problem& problem, const PgsSettings& settings = {},
             const Vector* warm_start = nullptr) {
  Pgs pgs(settings);
  Result result;
  pgs.solve(problem, result, warm_start);
  return result;
}

PgsSettings limited(int sweeps, double tolerance = 1e-8) {
  PgsSettings settings;
  settings.max_iterations = sweeps;
  settings.tolerance = tolerance;
  return settings;
}

/// Each form does the same arithmetic in another order: 20 sweeps of at most 40 products a row,
/// each off by eps |M||z|, stay within 20 * 40 * eps < 2e-13 of the largest intermediate, times
/// what one sweep can amplify; ten times more is allowed.
TEST(Pgs, TwentySweepsAreTheSameOverEveryForm) {
  for (const bool compliant : {false, true}) {
    const FactoredMatrix A = random_factored(7, 40, compliant, kSeed);
    const Problem factored = problem_of(A, feasible_q(A, kSeed + 1));
    const Problem sparse = with_matrix(factored, A.form());
    const Problem dense = with_matrix(factored, to_dense(A));
    PgsSettings settings = limited(20);
    settings.row_order = RowOrder::kNatural;
    const Result from_factored = solve(factored, settings);
    const Result from_sparse = solve(sparse, settings);
    const Result from_dense = solve(dense, settings);
    ASSERT_EQ(from_factored.statistics.iterations, 20);
    const double scale = from_factored.z.cwiseAbs().maxCoeff();
    EXPECT_LE((from_factored.z - from_sparse.z).cwiseAbs().maxCoeff(), 2e-12 * scale);
    EXPECT_LE((from_factored.z - from_dense.z).cwiseAbs().maxCoeff(), 2e-12 * scale);
  }
}

TEST(Pgs, SolvesRedundantFeasibleProblems) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const FactoredMatrix A = random_factored(5, 30, false, seed);
    const Problem problem = problem_of(A, feasible_q(A, seed + 100));
    const Result result = solve(problem, limited(200000));
    EXPECT_EQ(result.status, Status::kSolved) << "seed " << seed << ": " << result.detail;
    EXPECT_EQ(result.solver, "pgs");
  }
}

TEST(Pgs, SolvesBoxAndFreeRowsInEveryForm) {
  const FactoredMatrix A = random_factored(7, 24, true, kSeed);
  Problem factored = problem_of(A, feasible_q(A, kSeed + 2));
  factored.lower = Vector::Zero(24);
  factored.upper = Vector::Constant(24, kInfinity);
  factored.lower.head(4).setConstant(-kInfinity);
  factored.lower.segment(4, 8).setConstant(-0.2);
  factored.upper.segment(4, 8).setConstant(0.3);
  for (const Problem& problem :
       {factored, with_matrix(factored, A.form()), with_matrix(factored, to_dense(A))}) {
    const Result result = solve(problem);
    ASSERT_EQ(result.status, Status::kSolved) << result.detail;
    EXPECT_LE(definition_residual(problem, result.z), 1e-8);
    for (Index i = 0; i < 24; ++i) {
      EXPECT_GE(result.z[i], problem.lower[i]);
      EXPECT_LE(result.z[i], problem.upper[i]);
    }
    EXPECT_LE(result.w.head(4).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_GT((result.z.segment(4, 8).array() == 0.3).count() +
                  (result.z.segment(4, 8).array() == -0.2).count(),
              0)
        << "no row ended at a box bound: the test tests nothing";
  }
}

/// A unit mass on a plane, pushed sideways: normal row and one tangent row, box friction.
Problem pushed_block(double mu, double tangential_velocity) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(6, 6));
  A.add_row();
  A.add_entry(0, Vector::Unit(6, 2));
  A.add_row();
  A.add_entry(0, Vector::Unit(6, 0));
  Problem problem = problem_of(std::move(A), Eigen::Vector2d(-1.0, tangential_velocity));
  problem.limits.push_back({.row = 1, .normal_row = 0, .coefficient = mu});
  return problem;
}

TEST(Pgs, CoupledLimitSlidesAtMuTimesTheNormalImpulse) {
  const Result result = solve(pushed_block(0.5, 3.0));
  ASSERT_EQ(result.status, Status::kSolved);
  EXPECT_DOUBLE_EQ(result.z[0], 1.0);
  EXPECT_DOUBLE_EQ(result.z[1], -0.5);
  EXPECT_DOUBLE_EQ(result.w[1], 2.5);
}

TEST(Pgs, CoupledLimitSticksInsideTheLimit) {
  const Result result = solve(pushed_block(0.5, 0.25));
  ASSERT_EQ(result.status, Status::kSolved);
  EXPECT_DOUBLE_EQ(result.z[1], -0.25);
  EXPECT_DOUBLE_EQ(result.w[1], 0.0);
}

TEST(Pgs, CoupledLimitsOnManyRowsSatisfyTheCoupledCertificate) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const FactoredMatrix A = random_factored(12, 30, false, seed);
    Problem problem = problem_of(A, feasible_q(A, seed + 50));
    for (int row = 1; row < 30; row += 3) {
      problem.limits.push_back({row, row - 1, 0.3});
      problem.limits.push_back({row + 1, row - 1, 0.3});
    }
    for (const Problem& form : {problem, with_matrix(problem, A.form())}) {
      const Result result = solve(form, limited(100000));
      ASSERT_EQ(result.status, Status::kSolved) << "seed " << seed << ": " << result.detail;
      EXPECT_LE(definition_residual(form, result.z), 1e-8) << "seed " << seed;
      for (const CoupledLimit& limit : problem.limits) {  // -+ mu z_n of the row's last visit
        EXPECT_LE(std::abs(result.z[limit.row]), 0.3 * result.z[limit.normal_row] + 1e-7);
      }
    }
  }
}

TEST(Pgs, StarvedOfSweepsEndsAtTheIterationLimit) {
  const FactoredMatrix A = random_factored(5, 30, false, kSeed);
  const Problem problem = problem_of(A, feasible_q(A, kSeed));
  for (const int sweeps : {0, 1}) {
    const Result result = solve(problem, limited(sweeps));
    EXPECT_EQ(result.status, Status::kIterationLimit);
    EXPECT_EQ(result.statistics.iterations, sweeps);
    EXPECT_TRUE(result.z.allFinite());
    EXPECT_GT(result.certificate.unit_free_residual, 1e-8);
  }
}

TEST(Pgs, OutOfTimeEndsAtTheTimeLimit) {
  const FactoredMatrix A = random_factored(5, 30, false, kSeed);
  const Problem problem = problem_of(A, feasible_q(A, kSeed));
  PgsSettings settings;
  settings.time_limit = 1e-9;
  const Result result = solve(problem, settings);
  EXPECT_EQ(result.status, Status::kTimeLimit);
  EXPECT_TRUE(result.z.allFinite());
}

TEST(Pgs, WarmStartFromSolutionTakesNoSweep) {
  const FactoredMatrix A = random_factored(5, 30, false, kSeed);
  const Problem problem = problem_of(A, feasible_q(A, kSeed));
  const Result cold = solve(problem, limited(200000));
  ASSERT_EQ(cold.status, Status::kSolved);
  EXPECT_GT(cold.statistics.iterations, 1);
  const Result warm = solve(problem, {}, &cold.z);
  EXPECT_EQ(warm.status, Status::kSolved);
  EXPECT_EQ(warm.statistics.iterations, 0);
  EXPECT_EQ(warm.z, cold.z);
}

TEST(Pgs, WarmStartOutsideTheBoundsIsProjected) {
  Problem problem = dense_problem(Matrix::Identity(2, 2), Vector::Constant(2, 1.0));
  const Vector start = Eigen::Vector2d(-5.0, 7.0);
  const Result result = solve(problem, limited(0), &start);
  EXPECT_EQ(result.z, Vector(Eigen::Vector2d(0.0, 7.0)));
  EXPECT_EQ(result.status, Status::kIterationLimit);
}

TEST(Pgs, WarmStartThatOverflowsIsABreakdownAndNotAnAnswer) {
  const Problem problem = dense_problem(Matrix::Constant(1, 1, 1e10), Vector::Constant(1, -1.0));
  const Vector start = Vector::Constant(1, 1e300);
  const Result result = solve(problem, {}, &start);
  EXPECT_EQ(result.status, Status::kNumericalBreakdown);
  EXPECT_TRUE(result.z.allFinite());
}

TEST(Pgs, ZeroRowWithNegativeQIsStalledNeverSolved) {
  for (const double diagonal : {0.0, -1.0}) {
    Matrix M = Matrix::Identity(3, 3);
    M(1, 1) = diagonal;
    const Result result = solve(dense_problem(M, Vector::Constant(3, -1.0)));
    EXPECT_EQ(result.status, Status::kStalled);
    EXPECT_TRUE(result.z.allFinite());
    EXPECT_EQ(result.z, Vector(Eigen::Vector3d(1.0, 0.0, 1.0)));  // the other rows are answered
    EXPECT_NE(result.detail.find("row 1: no positive diagonal, w = -1"), std::string::npos)
        << result.detail;
  }
}

TEST(Pgs, ZeroRowIsSolvedByTheBoundThatWPointsTo) {
  Problem problem = dense_problem(Matrix::Zero(3, 3), Eigen::Vector3d(1.0, -1.0, 0.0));
  problem.lower = Vector::Constant(3, -2.0);
  problem.upper = Vector::Constant(3, 4.0);
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.z, Vector(Eigen::Vector3d(-2.0, 4.0, 0.0)));
}

TEST(Pgs, DiagonalTooSmallToInvertCountsAsZero) {
  Matrix M = Matrix::Identity(2, 2);
  M(0, 0) = 1e-310;
  const Result result = solve(dense_problem(M, Eigen::Vector2d(-1.0, -1.0)));
  EXPECT_EQ(result.status, Status::kStalled);
  EXPECT_TRUE(result.z.allFinite());
}

TEST(Pgs, DivergenceIsABreakdownWithTheBestIterate) {
  Problem problem = dense_problem((Matrix(2, 2) << 1.0, 10.0, 10.0, 1.0).finished(),
                                  Eigen::Vector2d(-1.0, -1.0));  // indefinite
  problem.lower = Vector::Constant(2, -kInfinity);
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kNumericalBreakdown);
  EXPECT_EQ(result.z, Vector(Vector::Zero(2)));  // each sweep is worse than the start
  EXPECT_NE(result.detail.find("diverged"), std::string::npos) << result.detail;
}

TEST(Pgs, OverflowWithinOneSweepIsABreakdownWithAFiniteIterate) {
  Problem problem = dense_problem((Matrix(2, 2) << 1e-200, 0.0, 1e300, 1.0).finished(),
                                  Vector::Constant(2, -1.0));
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kNumericalBreakdown);
  EXPECT_TRUE(result.z.allFinite());
}

/// Free rows with M = [1 1; -1 1] (positive definite, not symmetric): z_2 <- 2 - z_2 for ever.
TEST(Pgs, ExactCycleIsStalled) {
  Problem problem =
      dense_problem((Matrix(2, 2) << 1.0, 1.0, -1.0, 1.0).finished(), Eigen::Vector2d(-1.0, -1.0));
  problem.lower = Vector::Constant(2, -kInfinity);
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kStalled);
  EXPECT_LT(result.statistics.iterations, 200);
  EXPECT_NE(result.detail.find("repeats"), std::string::npos) << result.detail;
}

TEST(Pgs, InfeasibleSemidefiniteProblemEndsUnsolved) {
  const Problem problem =
      dense_problem((Matrix(2, 2) << 1.0, -1.0, -1.0, 1.0).finished(), Vector::Constant(2, -1.0));
  const Result result = solve(problem, limited(1000));
  EXPECT_EQ(result.status, Status::kIterationLimit);
}

/// Asked for less than rounding allows, on a problem with large |M||z| beside |q|.
TEST(Pgs, ToleranceBelowTheRoundingFloorIsSolvedToRounding) {
  const Problem problem = dense_problem((Matrix(2, 2) << 1.0, 0.3, 0.3, 0.7).finished(),
                                        Eigen::Vector2d(-1.0 / 3.0, -1.0 / 7.0));
  const Result result = solve(problem, limited(-1, 1e-300));
  EXPECT_EQ(result.status, Status::kSolvedToRounding) << result.detail;
}

TEST(Pgs, ComplianceIsPartOfTheDiagonal) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(1, 1));
  A.add_row(3.0);
  A.add_entry(0, Vector::Ones(1));
  const Problem problem = problem_of(std::move(A), Vector::Constant(1, -2.0));
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_DOUBLE_EQ(result.z[0], 0.5);
}

TEST(Pgs, OneRowTakesOneSweep) {
  const Result pushed =
      solve(dense_problem(Matrix::Constant(1, 1, 4.0), Vector::Constant(1, -2.0)));
  EXPECT_EQ(pushed.status, Status::kSolved);
  EXPECT_EQ(pushed.statistics.iterations, 1);
  EXPECT_DOUBLE_EQ(pushed.z[0], 0.5);
  const Result parting = solve(dense_problem(Matrix::Constant(1, 1, 4.0), Vector::Ones(1)));
  EXPECT_EQ(parting.statistics.iterations, 0);
  EXPECT_EQ(parting.z[0], 0.0);
}

TEST(Pgs, EmptyProblemIsSolved) {
  EXPECT_EQ(solve(dense_problem(Matrix(0, 0), Vector(0))).status, Status::kSolved);
  EXPECT_EQ(solve(Problem{FactoredMatrix{}, Vector(0), {}, {}, {}}).status, Status::kSolved);
}

TEST(Pgs, NaNInTheProblemIsInvalidInput) {
  const Result result = solve(dense_problem(Matrix::Constant(1, 1, kNaN), Vector::Ones(1)));
  EXPECT_EQ(result.status, Status::kInvalidInput);
  EXPECT_EQ(result.detail, "M(0, 0) is nan");
}

TEST(Pgs, UsedAgainGivesTheBitsOfAFreshSolver) {
  const FactoredMatrix A = random_factored(9, 50, false, kSeed);
  const Problem large = problem_of(A, feasible_q(A, kSeed));
  const FactoredMatrix B = random_factored(5, 12, true, kSeed + 5);
  const Problem small = problem_of(B, feasible_q(B, kSeed));
  Pgs pgs;
  Result result;
  pgs.solve(large, result);
  pgs.solve(small, result);
  EXPECT_EQ(result.z, solve(small).z);
  pgs.solve(large, result);
  EXPECT_EQ(result.z, solve(large).z);
}

TEST(Pgs, SettingsOutOfRangeAreNamed) {
  const auto message = [](PgsSettings settings) -> std::string {
    try {
      const Pgs pgs(settings);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  PgsSettings settings;
  settings.check_period = 0;
  EXPECT_NE(message(settings).find("check_period: must be >= 1, got 0"), std::string::npos);
  settings = {};
  settings.tolerance = kNaN;
  EXPECT_NE(message(settings).find("tolerance"), std::string::npos);
}

}  // namespace
}  // namespace signorini::lcp
