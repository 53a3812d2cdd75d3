#include <signorini/lcp/active_set_polish.h>
#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/lemke.h>
#include <signorini/lcp/scaled_lcp.h>

#include "definition_residual.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Problem lcp(const Matrix& M, const Vector& q) {
  Problem problem;
  problem.M = M;
  problem.q = q;
  return problem;
}

Result solve(const Problem& problem, const LemkeSettings& settings = {},
             const Vector* warm_start = nullptr) {
  Lemke lemke(settings);
  Result result;
  lemke.solve(problem, result, warm_start);
  return result;
}

/// Upper unit triangular, 2 above the diagonal, q = -1: 2^n - 1 pivots with the cover (1, .., 1)
/// and powers of two in q (Murty 1978; Cottle, Pang, Stone 2009, 6.2).
Problem murty(int n) {
  Matrix M = Matrix::Identity(n, n);
  M.triangularView<Eigen::StrictlyUpper>().setConstant(2.0);
  Vector q(n);
  for (int i = 0; i < n; ++i) {
    q[i] = -std::ldexp(1.0, i);
  }
  return lcp(M, q);
}

/// M = L L^T of Murty's L, q = -1 (Fathi 1979).
Problem fathi(int n) {
  const Matrix L = std::get<Matrix>(murty(n).M);
  return lcp(L.transpose() * L, Vector::Constant(n, -1.0));
}

/// A unit cube on a plane with `contacts` points on a circle under it, falling and turning: rank 3.
Problem box_on_plane(int contacts, bool factored) {
  FactoredMatrix A;
  Vector inverse_mass{{1.0, 1.0, 1.0, 6.0, 6.0, 6.0}};
  A.mass.add_inverse(inverse_mass.asDiagonal().toDenseMatrix());
  const Vector v{{0.1, 0.0, -1.0, 0.3, 0.2, 0.0}};
  Vector q(contacts);
  for (int i = 0; i < contacts; ++i) {
    const double angle = 2.0 * 3.14159265358979323846 * i / contacts;
    const double x = 0.5 * std::cos(angle);
    const double y = 0.5 * std::sin(angle);
    A.add_row();
    const Vector row{{0.0, 0.0, 1.0, y, -x, 0.0}};  // N, r x N
    A.add_entry(0, row);
    q[i] = row.dot(v);
  }
  Problem problem;
  problem.q = q;
  problem.M = factored ? MatrixForm(A) : MatrixForm(Matrix(A.form()));
  return problem;
}

/// One contact, four friction directions (Stewart and Trinkle 1996), a sliding point of mass 1.
Problem pyramid_friction(double mu, double slide) {
  Matrix M = Matrix::Zero(6, 6);
  M.topLeftCorner(5, 5) << 1, 0, 0, 0, 0,  //
      0, 1, -1, 0, 0,                      //
      0, -1, 1, 0, 0,                      //
      0, 0, 0, 1, -1,                      //
      0, 0, 0, -1, 1;
  M.col(5).segment(1, 4).setOnes();
  M.row(5) << mu, -1, -1, -1, -1, 0;
  return lcp(M, Vector{{-1.0, slide, -slide, 0.5 * slide, -0.5 * slide, 0.0}});
}

struct Named {
  const char* name;
  Problem problem;
  Status expected;
};

std::vector<Named> named_problems() {
  const Matrix I1 = Matrix::Identity(1, 1);
  const Matrix O1 = Matrix::Zero(1, 1);
  const Status solved = Status::kSolved;
  const Status infeasible = Status::kInfeasible;
  return {
      {"Empty", lcp(Matrix(0, 0), Vector(0)), solved},
      {"OnePushed", lcp(2.0 * I1, Vector{{-3.0}}), solved},
      {"OneFree", lcp(2.0 * I1, Vector{{3.0}}), solved},
      {"OneTouching", lcp(2.0 * I1, Vector{{0.0}}), solved},
      {"OneZeroRowFeasible", lcp(O1, Vector{{1.0}}), solved},
      {"OneZeroRowDegenerate", lcp(O1, Vector{{0.0}}), solved},
      {"OneZeroRowInfeasible", lcp(O1, Vector{{-1.0}}), infeasible},
      {"OneNegativeInfeasible", lcp(-I1, Vector{{-1.0}}), infeasible},
      {"OneNegativeFeasible", lcp(-I1, Vector{{1.0}}), solved},
      {"ZeroRowBesideAnother", lcp(Matrix{{1, 0}, {0, 0}}, Vector{{-1, -1}}), infeasible},
      {"OppositeWalls", lcp(Matrix{{1, -1}, {-1, 1}}, Vector{{-1, -1}}), infeasible},
      {"OppositeWallsThirds", lcp(Matrix{{1, -3}, {-3, 9}}, Vector{{-1, -1}}), infeasible},
      {"OppositeWallsAtRest", lcp(Matrix{{1, -1}, {-1, 1}}, Vector{{-1, 1}}), solved},
      {"DuplicatedRows", lcp(Matrix::Ones(5, 5), Vector::Constant(5, -1.0)), solved},
      {"Wedge",
       lcp(Matrix{{1, -1 / std::sqrt(10.0)}, {-1 / std::sqrt(10.0), 1}},
           -2 * Vector{{1 / std::sqrt(2.0), 1 / std::sqrt(5.0)}}),
       solved},
      {"Skew", lcp(Matrix{{0, -1}, {1, 0}}, Vector{{1, -1}}), solved},
      // Kostreva's and the book's cycling example (Cottle, Pang, Stone 2009, 4.9 ff.)
      {"Cycling", lcp(Matrix{{1, 2, 0}, {0, 1, 2}, {2, 0, 1}}, Vector{{-1, -1, -1}}), solved},
      {"BimatrixGame",
       lcp(Matrix{{0, 0, 10, 20}, {0, 0, 30, 15}, {10, 20, 0, 0}, {30, 15, 0, 0}},
           Vector::Constant(4, -1.0)),
       solved},
      {"Murty6", murty(6), solved},
      {"Murty11", murty(11), solved},
      {"Fathi6", fathi(6), solved},
      {"Fathi10", fathi(10), solved},
      {"FourContacts", box_on_plane(4, false), solved},
      {"FiveContacts", box_on_plane(5, false), solved},
      {"SixteenContacts", box_on_plane(16, false), solved},
      {"SixteenContactsFactored", box_on_plane(16, true), solved},
      {"FrictionSliding", pyramid_friction(0.25, 4.0), solved},
      {"FrictionSticking", pyramid_friction(1.0, 0.25), solved},
      {"FrictionNone", pyramid_friction(0.0, 1.0), solved},
  };
}

class NamedProblem : public ::testing::TestWithParam<Named> {};

TEST_P(NamedProblem, EndsAsItMust) {
  const Result result = solve(GetParam().problem);
  EXPECT_EQ(result.status, GetParam().expected)
      << to_string(result.status) << ", " << result.detail;
  EXPECT_EQ(result.solver, "lemke");
  EXPECT_TRUE(result.z.allFinite());
  if (GetParam().expected == Status::kInfeasible) {
    EXPECT_EQ(result.ray_bound, kInfinity);
    EXPECT_EQ(result.ray.size(), GetParam().problem.size());
  } else {
    EXPECT_EQ(result.ray.size(), 0);
    EXPECT_LE(result.certificate.unit_free_residual, 1e-12);
  }
}

TEST_P(NamedProblem, EndsTheSameWithItsRowsReversed) {
  const Problem& problem = GetParam().problem;
  const Matrix M = to_dense(problem.M);
  const Problem reversed = lcp(M.colwise().reverse().rowwise().reverse(), problem.q.reverse());
  EXPECT_EQ(solve(reversed).status, GetParam().expected);
}

TEST_P(NamedProblem, EndsTheSameInOtherUnits) {
  const Problem& problem = GetParam().problem;
  const Matrix M = to_dense(problem.M);
  for (const auto& [z_unit, w_unit] : {std::pair{1e-100, 1e50}, {1e150, 1.0}, {1e3, 1e-150}}) {
    const Problem scaled = lcp(M * (w_unit / z_unit), problem.q * w_unit);
    const Result result = solve(scaled);
    // Rounding of w_unit / z_unit leaves opposite walls only nearly parallel.
    if (GetParam().expected == Status::kInfeasible) {
      EXPECT_FALSE(is_solved(result.status));
      EXPECT_GT(result.ray_bound, 0.0);
    } else {
      EXPECT_TRUE(is_solved(result.status)) << z_unit << ' ' << to_string(result.status);
    }
  }
}

TEST_P(NamedProblem, IsOneInEveryForm) {
  const Problem& problem = GetParam().problem;
  Problem sparse;
  sparse.M = SparseMatrix(to_dense(problem.M).sparseView());
  sparse.q = problem.q;
  const Result expected = solve(lcp(to_dense(problem.M), problem.q));
  const Result result = solve(sparse);
  EXPECT_EQ(result.status, expected.status);
  EXPECT_LE((result.z - expected.z).lpNorm<Eigen::Infinity>(),
            1e-12 * (1.0 + expected.z.lpNorm<Eigen::Infinity>()));
}

TEST_P(NamedProblem, WarmStartFromItsSolutionTakesNoPivots) {
  const Result cold = solve(GetParam().problem);
  const Result warm = solve(GetParam().problem, {}, &cold.z);
  EXPECT_EQ(warm.status, cold.status);
  if (is_solved(cold.status)) {
    EXPECT_LE(warm.statistics.pivots, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Lemke, NamedProblem, ::testing::ValuesIn(named_problems()),
                         [](const auto& param) { return param.param.name; });

// The least-norm part of w is unique for positive semidefinite A: w does not depend on the order.
TEST(Lemke, VelocitiesDoNotDependOnTheOrderOfRedundantContacts) {
  const Problem problem = box_on_plane(8, false);
  const Vector w = solve(problem).w;
  std::vector<int> order(8);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 10; ++trial) {
    std::shuffle(order.begin(), order.end(), random);
    Eigen::PermutationMatrix<Eigen::Dynamic> P(Eigen::Map<Eigen::VectorXi>(order.data(), 8));
    const Result result =
        solve(lcp(P * std::get<Matrix>(problem.M) * P.transpose(), P * problem.q));
    ASSERT_TRUE(is_solved(result.status));
    EXPECT_LE((P.transpose() * result.w - w).lpNorm<Eigen::Infinity>(), 1e-13);
  }
}

// The cone row of a sliding contact is active and has q = 0: at z = 0 nothing measures its error.
TEST(ActiveSetPolish, SolvesAnActiveSetWithRowsOfZeroQ) {
  for (const double mass : {1.0, 1e3, 1e6}) {
    SCOPED_TRACE(mass);
    Problem problem = pyramid_friction(0.25, 4.0);
    Matrix M = to_dense(problem.M);
    M.topLeftCorner(5, 5) /= mass;
    problem.M = M;
    ScaledLcp scaled;
    ASSERT_TRUE(scaled.assign(problem));
    // Normal, the direction against the sliding, the slip speed.
    std::vector<char> active{1, 0, 1, 0, 0, 1};
    BestIterate best;
    best.reset(problem, 1e-12);
    ActiveSetPolish polish;
    polish.reset_counts();
    EXPECT_TRUE(
        polish.run(problem, scaled, {.tolerance = 1e-12}, Deadline(kInfinity), active, best));
    EXPECT_EQ(polish.counts().rounds, 0);
    EXPECT_FALSE(polish.counts().orthogonal);
    EXPECT_NEAR(best.z()[0], mass, 1e-14 * mass);
    EXPECT_NEAR(best.z()[2], 0.25 * mass, 1e-14 * mass);
    EXPECT_NEAR(best.z()[5], 3.75, 1e-14 * 3.75);
  }
}

TEST(Lemke, SolvesRandomRedundantAndFrictionProblemsToRounding) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    const Index n = 1 + trial % 30;
    const Index rank = 1 + trial % 7;
    Matrix G(n, rank);
    Vector v(rank);
    for (double& value : G.reshaped()) value = normal(random);
    for (double& value : v) value = normal(random);
    // Feasible: z = 0 leaves w = G v, and there is a z with G G^T z = -G v + something >= 0.
    const Result result = solve(lcp(G * G.transpose(), G * v));
    EXPECT_TRUE(is_solved(result.status)) << "trial " << trial << ": " << to_string(result.status);
    EXPECT_LE(result.certificate.unit_free_residual,
              std::max(1e-12, 4.0 * result.certificate.rounding_floor));
  }
}

Problem random_positive_definite(int n) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  Matrix G(n, n);
  Vector q(n);
  for (double& value : G.reshaped()) value = normal(random);
  for (double& value : q) value = normal(random);
  return lcp(G * G.transpose(), q);
}

TEST(Lemke, TakesManyPivotsAcrossFactorisations) {
  const Problem problem = random_positive_definite(150);
  for (const int period : {1, 7, 1000}) {
    LemkeSettings settings;
    settings.refactorisation_period = period;
    const Result result = solve(problem, settings);
    EXPECT_EQ(result.status, Status::kSolved) << "period " << period;
    EXPECT_GT(result.statistics.pivots, 50);
    if (period == 1) {
      EXPECT_GE(result.statistics.factorizations, result.statistics.pivots);
    }
  }
}

TEST(Lemke, OneSolverSolvesOneProblemAfterAnotherAsAFreshOneDoes) {
  Lemke lemke;
  Result result;
  for (const Named& named : named_problems()) {
    lemke.solve(named.problem, result);
    const Result fresh = solve(named.problem);
    EXPECT_EQ(result.status, fresh.status) << named.name;
    EXPECT_EQ(result.z, fresh.z) << named.name;
    EXPECT_EQ(result.statistics.pivots, fresh.statistics.pivots) << named.name;
  }
}

// The rows that tie are kept in a matrix, which once doubled with every problem larger than the
// last.
TEST(Lemke, ProblemsThatGrowDoNotDoubleItsMemory) {
  Lemke solver;
  Result result;
  for (Index n = 2; n <= 64; ++n) {
    Problem problem;  // every row but the first ties at zero
    problem.M = Matrix(Matrix::Identity(n, n));
    problem.q = Vector::Zero(n);
    problem.q[0] = -1.0;
    ASSERT_NO_THROW(solver.solve(problem, result)) << "n = " << n;
    EXPECT_EQ(result.status, Status::kSolved) << "n = " << n;
  }
}

TEST(Lemke, StarvedOfPivotsKeepsAFiniteIterateAndSaysIterationLimit) {
  for (const int limit : {0, 1, 10}) {
    LemkeSettings settings;
    settings.max_iterations = limit;
    const Result result = solve(random_positive_definite(60), settings);
    EXPECT_EQ(result.status, Status::kIterationLimit) << limit;
    EXPECT_EQ(result.statistics.pivots, limit);
    EXPECT_TRUE(result.z.allFinite());
    EXPECT_LE(result.certificate.unit_free_residual, 1.0);  // no worse than z = 0
  }
}

TEST(Lemke, OutOfTimeSaysTimeLimit) {
  LemkeSettings settings;
  settings.time_limit = 1e-12;
  const Result result = solve(fathi(10), settings);
  EXPECT_EQ(result.status, Status::kTimeLimit);
  EXPECT_TRUE(result.z.allFinite());
}

TEST(Lemke, NanIsInvalidInput) {
  const Result result = solve(lcp(Matrix{{std::nan("")}}, Vector{{-1.0}}));
  EXPECT_EQ(result.status, Status::kInvalidInput);
  EXPECT_EQ(result.detail, "M(0, 0) is nan");
  EXPECT_TRUE(result.z.array().isNaN().all());
}

// A_ii = 1e320 is no double, though J and W are.
TEST(Lemke, AMatrixThatOverflowsWhenFormedIsABreakdown) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(1, 1));
  A.add_row();
  A.add_entry(0, Vector{{1e160}});
  Problem problem;
  problem.M = A;
  problem.q = Vector{{-1.0}};
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kNumericalBreakdown);
  EXPECT_EQ(result.z, Vector::Zero(1));
  EXPECT_NE(result.detail.find("not finite"), std::string::npos);
}

// M = -I is not copositive: a ray that proves nothing, while z = (1, 1) is feasible with w = 0.
TEST(Lemke, RayThatProvesNothingIsUnproven) {
  LemkeSettings settings;
  settings.restarts = 0;
  const Result result = solve(lcp(Matrix{{0, 2}, {1, -1}}, Vector{{-1, 0.25}}), settings);
  EXPECT_FALSE(is_solved(result.status));
  EXPECT_NE(result.status, Status::kInfeasible);
  EXPECT_EQ(result.ray.size(), 2);
}

TEST(Lemke, RestartsAreNamedInTheDetail) {
  const Problem game = lcp(Matrix{{0, 0, 10, 20}, {0, 0, 30, 15}, {10, 20, 0, 0}, {30, 15, 0, 0}},
                           Vector::Constant(4, -1.0));
  EXPECT_NE(solve(game).detail.find("restarts"), std::string::npos);
  LemkeSettings plain;
  plain.restarts = 0;
  EXPECT_FALSE(is_solved(solve(game, plain).status));
}

TEST(Lemke, AWrongOrUselessWarmStartDoesNoHarm) {
  for (const Named& named : named_problems()) {
    const Vector ones = Vector::Constant(named.problem.size(), 1.0);
    const Vector infinite = Vector::Constant(named.problem.size(), kInfinity);
    EXPECT_EQ(solve(named.problem, {}, &ones).status, named.expected) << named.name;
    EXPECT_EQ(solve(named.problem, {}, &infinite).status, named.expected) << named.name;
  }
}

TEST(Lemke, RefusesCones) {
  Problem problem = fathi(3);
  problem.cones.push_back({0, 3, 0.5});
  Lemke lemke;
  Result result;
  EXPECT_NE(lemke.refuses(problem), "");
  EXPECT_THROW(lemke.solve(problem, result), std::invalid_argument);
  EXPECT_EQ(result.status, Status::kNotRun);
}

/// The lexicographic path from the cover (1, .., 1) takes 2^n - 1 pivots on these; the random cover
/// of the first run takes at most n + 1.
TEST(Lemke, ExponentialExamplesTakeFewPivots) {
  for (const int n : {5, 10, 20, 30}) {
    Problem turned = murty(n);
    turned.q.reverseInPlace();
    Problem other = fathi(n);
    const Matrix L = std::get<Matrix>(murty(n).M);
    other.M = Matrix(L * L.transpose());
    Problem powers = fathi(n);
    powers.q = murty(n).q;
    for (const Problem& problem : {murty(n), turned, fathi(n), other, powers}) {
      const Result result = solve(problem);
      EXPECT_EQ(result.status, Status::kSolved) << n;
      EXPECT_LE(result.statistics.pivots, 2 * n) << n;
    }
  }
}

/// Lower unit triangular, 2 below the diagonal, q_i = -(2^n + .. + 2^(n-i)): with the cover
/// (1, .., 1) the lexicographic path takes all 2^n - 1 complementary bases (Murty 1978).
TEST(Lemke, AnExponentialPathIsGivenUpForAnotherCover) {
  for (const int n : {10, 15, 20}) {
    Problem problem = lcp(std::get<Matrix>(murty(n).M).transpose(), Vector(n));
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      problem.q[i] = sum -= std::ldexp(1.0, n - i);
    }
    const int budget = 50 + 10 * n;
    LemkeSettings textbook;
    textbook.textbook_cover = true;
    const Result result = solve(problem, textbook);
    EXPECT_EQ(result.status, Status::kSolved) << n << ": " << result.detail;
    EXPECT_LE(result.certificate.unit_free_residual, 1e-12);
    EXPECT_GT(result.statistics.pivots, budget) << "the first path is given up";
    EXPECT_LE(result.statistics.pivots, 4 * budget) << n;
    EXPECT_NE(result.detail.find("given up after " + std::to_string(budget)), std::string::npos)
        << result.detail;
    EXPECT_LE(solve(problem).statistics.pivots, budget) << "the random cover needs no second try";
    if (n == 10) {
      textbook.path_budget = 0;
      const Result whole = solve(problem, textbook);
      EXPECT_GT(whole.statistics.pivots, 1000) << "2^10 bases";
      EXPECT_EQ(whole.detail.find("given up"), std::string::npos);
    }
  }
}

/// The budget doubles: a path that needs more than the first one is not given up for ever.
TEST(Lemke, SmallBudgetsOnlyCostPivots) {
  LemkeSettings settings;
  settings.path_budget = 1;
  for (const int n : {60, 120}) {
    const Problem problem = fathi(n);
    EXPECT_EQ(solve(problem, settings).status, solve(problem).status) << n;
  }
}

Matrix random_semidefinite(int n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Matrix J = Matrix::NullaryExpr(n, (n + 1) / 2, [&] { return normal(random); });
  return J * J.transpose();
}

/// Boxes with and without ends, free rows, a skew part; solvable by construction, M singular.
TEST(Lemke, MixedProblemsWithBounds) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform;
  for (int trial = 0; trial < 100; ++trial) {
    const int n = 2 + trial % 12;
    Matrix M = random_semidefinite(n, random);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        const double skew = uniform(random) - 0.5;
        M(i, j) += skew;
        M(j, i) -= skew;
      }
    }
    Problem problem = lcp(M, Vector::Zero(n));
    problem.lower.setZero(n);
    problem.upper.setConstant(n, kInfinity);
    Vector x(n);
    Vector r = Vector::Zero(n);
    for (int i = 0; i < n; ++i) {
      const double kind = uniform(random);
      problem.lower[i] = kind < 0.3 ? -kInfinity : -uniform(random);
      problem.upper[i] = kind < 0.15 || kind > 0.7 ? kInfinity : uniform(random);
      const bool is_low = problem.lower[i] > -kInfinity && uniform(random) < 0.3;
      const bool is_high = !is_low && problem.upper[i] < kInfinity && uniform(random) < 0.3;
      x[i] = is_low ? problem.lower[i] : is_high ? problem.upper[i] : 0.0;
      r[i] = is_low ? uniform(random) : is_high ? -uniform(random) : 0.0;
    }
    problem.q = r - M * x;
    const Result result = solve(problem);
    EXPECT_TRUE(is_solved(result.status))
        << trial << ": " << to_string(result.status) << ", " << result.detail;
    const Result warm = solve(problem, {}, &result.z);
    EXPECT_TRUE(is_solved(warm.status)) << trial;
  }
}

/// M on the free rows is zero (a constraint and its multiplier): z_0 alone makes no basis.
TEST(Lemke, AFreeRowWithoutADiagonalTakesAnotherRowIntoTheBasis) {
  Problem problem = lcp(Matrix{{0, 1}, {-1, 2}}, Vector{{-3.0, 1.0}});
  problem.lower = Vector{{-kInfinity, 0.0}};
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_LE(definition_residual(problem, result.z), 1e-15);
  EXPECT_NEAR(result.z[1], 3.0, 1e-15);
  EXPECT_NEAR(result.z[0], 7.0, 1e-15);
}

TEST(Lemke, DependentFreeColumnsAreNamed) {
  Problem problem = lcp(Matrix{{1, 1}, {1, 1}}, Vector{{-1.0, -2.0}});
  problem.lower = Vector{{-kInfinity, -kInfinity}};
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kNumericalBreakdown);
  EXPECT_NE(result.detail.find("free rows are dependent"), std::string::npos) << result.detail;
}

/// |z_t| <= mu z_n with the z_n of the solution, exactly: sticking, sliding, off the ground.
TEST(Lemke, CoupledLimitsAreSolvedExactly) {
  const Matrix M{{2, 0.3, 0}, {0.3, 1, 0.1}, {0, 0.1, 1}};
  for (const double slide : {0.0, 0.1, 0.4, -5.0}) {
    for (const double normal : {-1.0, 1.0}) {
      Problem problem = lcp(M, Vector{{normal, slide, -0.5 * slide}});
      problem.limits = {{1, 0, 0.5}, {2, 0, 0.5}};
      const Result result = solve(problem);
      EXPECT_EQ(result.status, Status::kSolved) << slide << ", " << normal;
      EXPECT_LE(definition_residual(problem, result.z), 1e-15) << slide << ", " << normal;
      EXPECT_LE(result.z.tail(2).cwiseAbs().maxCoeff(), 0.5 * result.z[0] + 1e-15);
      const Result warm = solve(problem, {}, &result.z);
      EXPECT_EQ(warm.status, Status::kSolved);
    }
  }
}

TEST(Lemke, RefusesSettingsOutOfRangeByName) {
  const auto refused = [](auto change) -> std::string {
    LemkeSettings settings;
    change(settings);
    try {
      const Lemke lemke(settings);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  using S = LemkeSettings;
  const auto names = [](const std::string& message, const char* what) {
    return message.find(what) != std::string::npos;
  };
  EXPECT_TRUE(names(refused([](S& s) { s.pivot_tolerance = 0.0; }), "pivot_tolerance"));
  EXPECT_TRUE(names(refused([](S& s) { s.tie_tolerance = std::nan(""); }), "tie_tolerance"));
  EXPECT_TRUE(names(refused([](S& s) { s.refactorisation_period = 0; }), "refactorisation"));
  EXPECT_TRUE(names(refused([](S& s) { s.refinements_per_solve = -1; }), "refinements"));
  EXPECT_TRUE(names(refused([](S& s) { s.cover_tolerance = 0.5; }), "cover_tolerance"));
  EXPECT_TRUE(names(refused([](S& s) { s.restarts = -1; }), "restarts"));
  EXPECT_TRUE(names(refused([](S& s) { s.polish_rounds = -1; }), "polish_rounds"));
  EXPECT_TRUE(names(refused([](S& s) { s.tolerance = 1.0; }), "got 1"));
  EXPECT_TRUE(names(refused([](S& s) { s.time_limit = 0.0; }), "time_limit"));
  EXPECT_TRUE(names(refused([](S& s) { s.max_iterations = -2; }), "max_iterations"));
}

TEST(MakeSolver, KnowsItsNamesAndListsThemForOthers) {
  for (const std::string_view name : solver_names()) {
    EXPECT_EQ(make_solver(name)->name(), name);
  }
  try {
    static_cast<void>(make_solver("simplex"));
    FAIL() << "an unknown name was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("lemke"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace signorini::lcp
