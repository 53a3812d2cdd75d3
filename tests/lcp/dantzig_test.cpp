#include <signorini/lcp/dantzig.h>

#include "definition_residual.h"

#include <Eigen/Geometry>
#include <bench/contact_families.h>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#ifdef SIGNORINI_HAS_GMP
#include <signorini/lcp/exact_lemke.h>
#endif

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Problem lcp(const Matrix& M, const Vector& q) {
  Problem problem;
  problem.M = M;
  problem.q = q;
  return problem;
}

Problem box(const Matrix& M, const Vector& q, const Vector& lower, const Vector& upper) {
  Problem problem = lcp(M, q);
  problem.lower = lower;
  problem.upper = upper;
  return problem;
}

Result solve(const Problem& problem, const DantzigSettings& settings = {},
             const Vector* warm_start = nullptr) {
  Dantzig dantzig(settings);
  Result result;
  dantzig.solve(problem, result, warm_start);
  return result;
}

struct Named {
  const char* name;
  Problem problem;
  Status expected;
};

void PrintTo(const Named& named, std::ostream* stream) {
  *stream << named.name;
}

std::vector<Named> named_problems() {
  const Matrix I1 = Matrix::Identity(1, 1);
  const Matrix O1 = Matrix::Zero(1, 1);
  const Matrix walls{{1, -1}, {-1, 1}};
  const Matrix same{{1, 1}, {1, 1}};
  const Vector none = Vector::Constant(2, -kInfinity);
  const Vector all = Vector::Constant(2, kInfinity);
  const Status solved = Status::kSolved;
  return {
      {"Empty", lcp(Matrix(0, 0), Vector(0)), solved},
      {"OnePushed", lcp(2.0 * I1, Vector{{-3.0}}), solved},
      {"OneFree", lcp(2.0 * I1, Vector{{3.0}}), solved},
      {"OneTouching", lcp(2.0 * I1, Vector{{0.0}}), solved},
      {"OneZeroRowFeasible", lcp(O1, Vector{{1.0}}), solved},
      {"OneZeroRowDegenerate", lcp(O1, Vector{{0.0}}), solved},
      {"OneZeroRowInfeasible", lcp(O1, Vector{{-1.0}}), Status::kInfeasible},
      {"OneInItsBox", box(2.0 * I1, Vector{{-1.0}}, Vector{{0.0}}, Vector{{1.0}}), solved},
      {"OneAtItsUpperBound", box(2.0 * I1, Vector{{-4.0}}, Vector{{0.0}}, Vector{{1.0}}), solved},
      {"OneAtItsLowerBound", box(2.0 * I1, Vector{{4.0}}, Vector{{-1.0}}, Vector{{1.0}}), solved},
      {"OneFixed", box(2.0 * I1, Vector{{4.0}}, Vector{{-1.0}}, Vector{{-1.0}}), solved},
      {"OneOnlyBelow", box(I1, Vector{{4.0}}, Vector{{-kInfinity}}, Vector{{-1.0}}), solved},
      {"ZeroRowInABox", box(O1, Vector{{-4.0}}, Vector{{-1.0}}, Vector{{2.0}}), solved},
      {"OppositeWallsClosing", lcp(walls, Vector{{-1.0, -1.0}}), Status::kInfeasible},
      {"OppositeWallsAgreeing", lcp(walls, Vector{{-1.0, 1.0}}), solved},
      {"OppositeWallsOpening", lcp(walls, Vector{{-1.0, 2.0}}), solved},
      {"SameRowTwice", lcp(same, Vector{{-1.0, -1.0}}), solved},
      {"SameRowTwiceTheSecondStronger", lcp(same, Vector{{-1.0, -2.0}}), solved},
      {"SameRowFreeTwice", box(same, Vector{{-1.0, -1.0}}, none, all), solved},
      {"SameRowFreeTwiceContradicting", box(same, Vector{{-1.0, -2.0}}, none, all),
       Status::kRayUnproven},
      {"SameRowTwiceOneBoxed", box(same, Vector{{-3.0, -3.0}}, Vector{{0, 0}}, Vector{{1, 9}}),
       solved},
      {"NegativeMatrix", lcp(-I1, Vector{{-1.0}}), Status::kInfeasible},
      {"NotANumber", lcp(I1, Vector{{std::nan("")}}), Status::kInvalidInput},
      {"Infinite", lcp(kInfinity * I1, Vector{{1.0}}), Status::kInvalidInput},
      {"CrossedBounds", box(I1, Vector{{1.0}}, Vector{{1.0}}, Vector{{0.0}}),
       Status::kInvalidInput},
      {"Tiny", lcp(1e-150 * I1, Vector{{-1e-150}}), solved},
      {"Huge", lcp(1e150 * I1, Vector{{-1e150}}), solved},
  };
}

class DantzigEnds : public testing::TestWithParam<Named> {};

TEST_P(DantzigEnds, AsExpected) {
  const Result result = solve(GetParam().problem);
  EXPECT_EQ(result.status, GetParam().expected) << result.detail;
  if (is_solved(result.status)) {
    EXPECT_LE(definition_residual(GetParam().problem, result.z), 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(Dantzig, DantzigEnds, testing::ValuesIn(named_problems()),
                         [](const auto& tested) { return std::string(tested.param.name); });

using Family = std::tuple<std::string, int, double>;
class DantzigSolves : public testing::TestWithParam<Family> {};

/// Redundant contacts (four a face, three independent) and mass ratios, moving and at rest.
TEST_P(DantzigSolves, ContactFamilies) {
  const auto& [family, size, ratio] = GetParam();
  for (const bool at_rest : {false, true}) {
    const Problem problem = bench::make_family(
        {.family = family, .size = size, .mass_ratio = ratio, .at_rest = at_rest});
    const Result result = solve(problem);
    EXPECT_TRUE(is_solved(result.status)) << to_string(result.status) << ", " << result.detail;
    EXPECT_LE(result.statistics.pivots, 3 * problem.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Dantzig, DantzigSolves,
                         testing::Combine(testing::Values("tower4"), testing::Values(1, 4, 16, 60),
                                          testing::Values(1.0, 1e3, 1e6)));
INSTANTIATE_TEST_SUITE_P(DantzigPiles, DantzigSolves,
                         testing::Combine(testing::Values("spheres"), testing::Values(16, 64, 250),
                                          testing::Values(1.0, 1e3, 1e6)));
INSTANTIATE_TEST_SUITE_P(DantzigPyramids, DantzigSolves,
                         testing::Combine(testing::Values("pyramid2d", "pyramid3d", "wall",
                                                          "tower8"),
                                          testing::Values(2, 4), testing::Values(1.0, 1e6)));

Matrix random_matrix(int rows, int columns, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Matrix::NullaryExpr(rows, columns, [&] { return normal(random); });
}

/// Random semidefinite M of half rank; q = -M x + r with x in the box and r on its right side
/// (so that a solution exists), boxes with and without ends.
TEST(Dantzig, RandomBoxProblemsOfHalfRank) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  for (int trial = 0; trial < 100; ++trial) {
    const int n = 2 + trial % 30;
    const Matrix J = random_matrix(n, (n + 1) / 2, random);
    Vector lower(n);
    Vector upper(n);
    Vector x(n);
    Vector r(n);
    for (int i = 0; i < n; ++i) {
      const double kind = uniform(random);
      lower[i] = kind < 0.2 ? -kInfinity : -uniform(random);
      upper[i] = kind < 0.1 || kind > 0.8 ? kInfinity : uniform(random);
      const bool is_low = lower[i] > -kInfinity && uniform(random) < 0.3;
      const bool is_high = !is_low && upper[i] < kInfinity && uniform(random) < 0.3;
      x[i] = is_low ? lower[i] : is_high ? upper[i] : 0.0;
      r[i] = is_low ? uniform(random) : is_high ? -uniform(random) : 0.0;
    }
    const Matrix M = J * J.transpose();
    const Result result = solve(box(M, r - M * x, lower, upper));
    EXPECT_TRUE(is_solved(result.status)) << trial << ": " << result.detail;
  }
}

#ifdef SIGNORINI_HAS_GMP
/// Small integers: degenerate and redundant throughout, exact ties, half of them infeasible. What
/// is not solved is proven infeasible, and the exact method agrees.
TEST(Dantzig, SmallIntegerProblemsAgreeWithExactArithmetic) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> entry(-2, 2);
  ExactLemke exact;
  Result reference;
  int infeasible = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const int n = 1 + trial % 8;
    const int rank = 1 + trial % 3;
    const Matrix J = Matrix::NullaryExpr(n, rank, [&] { return double(entry(random)); });
    const Vector q = Vector::NullaryExpr(n, [&] { return double(entry(random)); });
    const Problem problem = lcp(J * J.transpose(), q);
    const Result result = solve(problem);
    exact.solve(problem, reference);
    EXPECT_EQ(is_solved(result.status), is_solved(reference.status))
        << "trial " << trial << ": " << to_string(result.status) << ", " << result.detail;
    EXPECT_TRUE(is_solved(result.status) || result.status == Status::kInfeasible)
        << "trial " << trial << ": " << to_string(result.status) << ", " << result.detail;
    infeasible += result.status == Status::kInfeasible ? 1 : 0;
  }
  EXPECT_GT(infeasible, 100);
}
#endif

/// A sliding block on three contacts with two coupled friction rows each.
Problem sliding_block(double mu) {
  FactoredMatrix A;
  const Vector inverse_mass{{1.0, 1.0, 1.0, 6.0, 6.0, 6.0}};
  A.mass.add_inverse(inverse_mass.asDiagonal().toDenseMatrix());
  const Vector v{{0.4, 0.1, -1.0, 0.3, 0.2, 0.1}};
  Problem problem;
  std::vector<double> q;
  const auto add = [&](const Eigen::Vector3d& arm, const Eigen::Vector3d& along) {
    Vector row(6);
    row << along, arm.cross(along);
    A.add_row();
    A.add_entry(0, row);
    q.push_back(row.dot(v));
  };
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3d arm(0.5 * std::cos(2.1 * c), 0.5 * std::sin(2.1 * c), -0.3);
    add(arm, Eigen::Vector3d::UnitZ());
    for (const int axis : {0, 1}) {
      problem.limits.push_back({A.rows(), 3 * c, mu});
      add(arm, Eigen::Vector3d::Unit(axis));
    }
  }
  problem.q = Eigen::Map<const Vector>(q.data(), static_cast<Index>(q.size()));
  problem.M = std::move(A);
  return problem;
}

TEST(Dantzig, CoupledLimitsAreThoseOfTheReturnedNormals) {
  for (const double mu : {0.0, 0.1, 0.5}) {
    const Result result = solve(sliding_block(mu));
    EXPECT_EQ(result.status, Status::kSolved) << mu << ": " << result.detail;
    EXPECT_LE(definition_residual(sliding_block(mu), result.z), 1e-8) << mu;
    EXPECT_NE(result.detail.find("coupled limits: solved "), std::string::npos);
    for (int c = 0; c < 3; ++c) {
      EXPECT_LE(result.z.segment(3 * c + 1, 2).cwiseAbs().maxCoeff(), mu * result.z[3 * c] + 1e-9);
    }
  }
}

TEST(Dantzig, OneRoundOfCoupledLimitsIsNotCalledSolved) {
  DantzigSettings settings;
  settings.limit_rounds = 1;
  const Result result = solve(sliding_block(0.5), settings);
  EXPECT_EQ(result.status, Status::kStalled);
  EXPECT_GT(result.certificate.unit_free_residual, 1e-8);
  EXPECT_GT(definition_residual(sliding_block(0.5), result.z), 1e-8);
}

TEST(Dantzig, WarmStartFromASolutionDrivesNothing) {
  const Problem problem = bench::make_family({.family = "spheres", .size = 64});
  const Result cold = solve(problem);
  ASSERT_EQ(cold.status, Status::kSolved);
  const Result warm = solve(problem, {}, &cold.z);
  EXPECT_EQ(warm.status, Status::kSolved);
  EXPECT_EQ(warm.statistics.pivots, (cold.z.array() > 0.0).count());
}

TEST(Dantzig, AWrongWarmStartOnlyCostsPivots) {
  for (const int size : {4, 60}) {  // dense and sparse
    const Problem problem = bench::make_family({.family = "tower4", .size = size});
    const Vector everything = Vector::Ones(problem.size());
    EXPECT_EQ(solve(problem, {}, &everything).status, Status::kSolved);
  }
}

TEST(Dantzig, NoPivotsWhereZeroSolves) {
  const Result result = solve(lcp(Matrix::Identity(3, 3), Vector{{1.0, 0.0, 2.0}}));
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.statistics.pivots, 0);
}

TEST(Dantzig, EndsAtItsLimits) {
  const Problem problem = bench::make_family({.family = "tower4", .size = 8});
  DantzigSettings settings;
  settings.max_iterations = 3;
  const Result few = solve(problem, settings);
  EXPECT_EQ(few.status, Status::kIterationLimit);
  EXPECT_EQ(few.statistics.pivots, 3);
  settings = {};
  settings.time_limit = 1e-12;
  EXPECT_EQ(solve(problem, settings).status, Status::kTimeLimit);
}

TEST(Dantzig, EndsWhereOnlyRoundingDrivesADependentRowBetweenFarBounds) {
  // Row 0 depends on the free row 1 and goes 1e61 along the null direction; w_0 is then rounding of
  // 1e45, which may send it to its other bound, and back.
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  int stalled = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Vector u = Vector::NullaryExpr(2, [&] { return normal(random); });
    const Vector q = Vector::NullaryExpr(2, [&] { return normal(random); });
    const Problem problem =
        box(u * u.transpose(), q, Vector{{-2.9e62, -kInfinity}}, Vector{{1.6e61, kInfinity}});
    const Result result = solve(problem, {{.max_iterations = 300}});
    EXPECT_TRUE(result.status == Status::kStalled || result.status == Status::kIterationLimit ||
                is_solved(result.status))
        << trial << ": " << to_string(result.status) << ", " << result.detail;
    EXPECT_TRUE(!is_solved(result.status) || result.certificate.unit_free_residual <= 1e-5);
    stalled += result.status == Status::kStalled ? 1 : 0;
  }
  EXPECT_GT(stalled, 0);
}

TEST(Dantzig, AnIndefiniteMatrixIsNotCalledSolvedUnlessItIs) {
  const Result small = solve(lcp(Matrix{{1, 2}, {2, 1}}, Vector{{-1.0, -1.0}}));
  EXPECT_TRUE(small.status != Status::kSolved || small.certificate.unit_free_residual <= 1e-8);
  SparseMatrix M(200, 200);
  M.setIdentity();
  M.coeffRef(3, 7) = M.coeffRef(7, 3) = 2.0;
  Problem sparse;
  sparse.M = M;
  sparse.q = Vector::Constant(200, -1.0);
  sparse.q[3] = sparse.q[7] = -1.0;
  const Result large = solve(sparse);
  EXPECT_TRUE(large.status != Status::kSolved || large.certificate.unit_free_residual <= 1e-8);
}

TEST(Dantzig, ANearlySymmetricMatrixIsRefinedAndNamed) {
  const Result result = solve(lcp(Matrix{{2, 1.001}, {1, 2}}, Vector{{-1.0, -2.0}}));
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_LE(result.certificate.unit_free_residual, 1e-15);
  EXPECT_NE(result.detail.find("M is symmetric to 0.000"), std::string::npos) << result.detail;
}

TEST(Dantzig, RefusesAnAsymmetricMatrix) {
  EXPECT_THROW(solve(lcp(Matrix{{2, 1}, {0, 2}}, Vector{{-1.0, -2.0}})), std::invalid_argument);
}

TEST(Dantzig, RefusesCones) {
  Problem problem = lcp(Matrix::Identity(3, 3), Vector::Constant(3, -1.0));
  problem.cones.push_back({0, 3, 0.5});
  EXPECT_THROW(solve(problem), std::invalid_argument);
}

TEST(Dantzig, SettingsAreChecked) {
  DantzigSettings settings;
  settings.dependence_tolerance = 0.0;
  EXPECT_THROW(Dantzig{settings}, std::invalid_argument);
  settings = {};
  settings.limit_rounds = 0;
  EXPECT_THROW(Dantzig{settings}, std::invalid_argument);
}

TEST(Dantzig, SameProblemSameBitsWhateverWasSolvedBefore) {
  const Problem problem = bench::make_family({.family = "pyramid2d", .size = 7, .mass_ratio = 1e3});
  Dantzig used;
  Result again;
  used.solve(bench::make_family({.family = "spheres", .size = 300}), again);
  used.solve(problem, again);
  const Result fresh = solve(problem);
  EXPECT_TRUE(again.z == fresh.z);
  EXPECT_EQ(again.statistics.pivots, fresh.statistics.pivots);
}

}  // namespace
}  // namespace signorini::lcp
