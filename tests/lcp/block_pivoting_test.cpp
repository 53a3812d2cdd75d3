#include <signorini/lcp/block_pivoting.h>

#include "allocation_count.h"
#include "definition_residual.h"

#include <bench/contact_families.h>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <tuple>
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

Problem box(const Matrix& M, const Vector& q, const Vector& lower, const Vector& upper) {
  Problem problem = lcp(M, q);
  problem.lower = lower;
  problem.upper = upper;
  return problem;
}

Result solve(const Problem& problem, const BlockPivotingSettings& settings = {},
             const Vector* warm_start = nullptr) {
  BlockPivoting solver(settings);
  Result result;
  solver.solve(problem, result, warm_start);
  return result;
}

/// Upper unit triangular, 2 above the diagonal (Murty 1978).
Matrix murty(int n) {
  Matrix M = Matrix::Identity(n, n);
  M.triangularView<Eigen::StrictlyUpper>().setConstant(2.0);
  return M;
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
       Status::kStalled},
      {"SameRowTwiceOneBoxed", box(same, Vector{{-3.0, -3.0}}, Vector{{0, 0}}, Vector{{1, 9}}),
       solved},
      {"NonsymmetricP", lcp(Matrix{{1, 2}, {0, 1}}, Vector{{-2.0, -1.0}}), solved},
      {"Skew", lcp(Matrix{{0, 1}, {-1, 0}}, Vector{{-1.0, 2.0}}), solved},
      {"Murty20", lcp(murty(20), Vector::Constant(20, -1.0)), solved},
      {"Fathi20", lcp(murty(20).transpose() * murty(20), Vector::Constant(20, -1.0)), solved},
      {"NotANumber", lcp(I1, Vector{{std::nan("")}}), Status::kInvalidInput},
      {"Infinite", lcp(kInfinity * I1, Vector{{1.0}}), Status::kInvalidInput},
      {"CrossedBounds", box(I1, Vector{{1.0}}, Vector{{1.0}}, Vector{{0.0}}),
       Status::kInvalidInput},
      {"Tiny", lcp(1e-150 * I1, Vector{{-1e-150}}), solved},
      {"Huge", lcp(1e150 * I1, Vector{{-1e150}}), solved},
  };
}

class BlockPivotingEnds : public testing::TestWithParam<Named> {};

TEST_P(BlockPivotingEnds, AsExpected) {
  const Result result = solve(GetParam().problem);
  EXPECT_EQ(result.status, GetParam().expected)
      << to_string(result.status) << ": " << result.detail;
  EXPECT_EQ(result.ray.size() > 0, GetParam().expected == Status::kInfeasible);
  if (is_solved(result.status)) {
    EXPECT_LE(definition_residual(GetParam().problem, result.z), 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(BlockPivoting, BlockPivotingEnds, testing::ValuesIn(named_problems()),
                         [](const auto& tested) { return std::string(tested.param.name); });

using Family = std::tuple<std::string, int, double>;
class BlockPivotingSolves : public testing::TestWithParam<Family> {};

/// Redundant contacts and mass ratios, moving and at rest; body space against the M given whole.
TEST_P(BlockPivotingSolves, ContactFamilies) {
  const auto& [family, size, ratio] = GetParam();
  for (const bool at_rest : {false, true}) {
    Problem problem = bench::make_family(
        {.family = family, .size = size, .mass_ratio = ratio, .at_rest = at_rest});
    const Result result = solve(problem);
    EXPECT_TRUE(is_solved(result.status)) << to_string(result.status) << ", " << result.detail;
    problem.M = std::get<FactoredMatrix>(problem.M).form();
    const Result given = solve(problem);
    EXPECT_TRUE(is_solved(given.status)) << to_string(given.status) << ", " << given.detail;
  }
}

INSTANTIATE_TEST_SUITE_P(BlockPivotingTowers, BlockPivotingSolves,
                         testing::Combine(testing::Values("tower4"), testing::Values(1, 4, 16),
                                          testing::Values(1.0, 1e3)));
INSTANTIATE_TEST_SUITE_P(BlockPivotingPiles, BlockPivotingSolves,
                         testing::Combine(testing::Values("spheres"), testing::Values(16, 64),
                                          testing::Values(1.0, 1e3)));
INSTANTIATE_TEST_SUITE_P(BlockPivotingPyramids, BlockPivotingSolves,
                         testing::Combine(testing::Values("pyramid2d", "pyramid3d", "wall",
                                                          "tower8"),
                                          testing::Values(2, 4), testing::Values(1.0)));

Matrix random_matrix(int rows, int columns, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Matrix::NullaryExpr(rows, columns, [&] { return normal(random); });
}

/// M of full or half rank, with and without a skew part; boxes with and without ends; solvable by
/// construction.
TEST(BlockPivoting, RandomBoxProblems) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 2 + trial % 30;
    const Matrix J = random_matrix(n, trial % 2 == 0 ? n : (n + 1) / 2, random);
    Matrix M = J * J.transpose();
    if (trial % 3 == 0) {
      const Matrix R = random_matrix(n, n, random);
      M += 0.3 * (R - R.transpose());
    }
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
    const Result result = solve(box(M, r - M * x, lower, upper));
    EXPECT_TRUE(is_solved(result.status))
        << trial << ": " << to_string(result.status) << ", " << result.detail;
  }
}

/// Without block trials every failure goes to Murty's rule, which ends by itself.
TEST(BlockPivoting, MurtysRuleAloneSolvesPMatrices) {
  std::mt19937 random(7);
  int single = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const int n = 2 + trial % 12;
    const Matrix J = random_matrix(n, n, random);
    const Problem problem =
        lcp(J * J.transpose() + 0.01 * Matrix::Identity(n, n), random_matrix(n, 1, random));
    BlockPivotingSettings settings;
    settings.block_trials = 0;
    const Result result = solve(problem, settings);
    EXPECT_EQ(result.status, Status::kSolved) << trial << ": " << result.detail;
    single += result.detail.find("single exchanges") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(single, 0);
}

/// Block exchanges alone go round on this P-matrix (after Júdice and Pires 1994: all rows wrong,
/// then all rows wrong the other way); single exchanges end that, and the result says so.
TEST(BlockPivoting, ACycleOfBlocksIsEndedBySingleExchanges) {
  std::mt19937 random(3);
  int found = 0;
  for (int trial = 0; trial < 2000 && found == 0; ++trial) {
    const Matrix J = random_matrix(6, 6, random);
    const Problem problem =
        lcp(J * J.transpose() + 1e-3 * Matrix::Identity(6, 6), random_matrix(6, 1, random));
    BlockPivotingSettings patient;
    patient.block_trials = 1000;
    patient.max_iterations = 500;
    if (solve(problem, patient).status == Status::kIterationLimit) {
      ++found;
      const Result result = solve(problem);
      EXPECT_EQ(result.status, Status::kSolved) << result.detail;
      EXPECT_NE(result.detail.find("single exchanges by least index"), std::string::npos);
    }
  }
  EXPECT_EQ(found, 1) << "no cycle found";
}

TEST(BlockPivoting, SaysHowItSolved) {
  const Result result = solve(lcp(Matrix{{1, 1}, {1, 1}}, Vector{{-1.0, -1.0}}));
  EXPECT_NE(result.detail.find("proximal rounds of weight 1e-10"), std::string::npos)
      << result.detail;
  EXPECT_EQ(result.statistics.pivots, 2 + result.statistics.iterations - 1);
  // The least z: the proximal steps from 0 stay in the range of M.
  EXPECT_NEAR(result.z[0], result.z[1], 1e-5);
}

TEST(BlockPivoting, WarmStartFromTheSolutionTakesOneSet) {
  const Problem problem = bench::make_family({.family = "tower4", .size = 8});
  const Result cold = solve(problem);
  ASSERT_TRUE(is_solved(cold.status));
  const Result warm = solve(problem, {}, &cold.z);
  EXPECT_TRUE(is_solved(warm.status));
  EXPECT_LE(warm.statistics.factorizations, 2);
  EXPECT_LT(warm.statistics.factorizations, cold.statistics.factorizations);
}

TEST(BlockPivoting, EndsAtItsLimits) {
  const Problem problem = bench::make_family({.family = "tower4", .size = 8});
  BlockPivotingSettings settings;
  settings.max_iterations = 1;
  const Result few = solve(problem, settings);
  EXPECT_EQ(few.status, Status::kIterationLimit);
  EXPECT_EQ(few.statistics.pivots, 1);
  settings = {};
  settings.time_limit = 1e-12;
  EXPECT_EQ(solve(problem, settings).status, Status::kTimeLimit);
}

TEST(BlockPivoting, AnIndefiniteMatrixEndsAndIsNotCalledSolvedUnlessItIs) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 1 + trial % 8;
    const Result result = solve(lcp(random_matrix(n, n, random), random_matrix(n, 1, random)));
    EXPECT_TRUE(!is_solved(result.status) || result.certificate.unit_free_residual <= 1e-5);
  }
}

TEST(BlockPivoting, SolvingAgainAllocatesNothing) {
  const Problem problem = bench::make_family({.family = "tower4", .size = 20});
  Problem other = problem;
  other.q *= 1.5;
  Problem bounded = problem;
  bounded.lower = Vector::Zero(problem.size());
  bounded.upper = Vector::Constant(problem.size(), 0.3);
  BlockPivoting solver;
  Result result;
  Result warm;
  solver.solve(bounded, result);
  solver.solve(problem, result);
  solver.solve(problem, warm, &result.z);
  const AllocationCount allocations;
  solver.solve(other, result);
  EXPECT_EQ(allocations.count(), 0) << "cold";
  solver.solve(problem, warm, &result.z);
  EXPECT_EQ(allocations.count(), 0) << "warm";
  solver.solve(bounded, result);
  EXPECT_EQ(allocations.count(), 0) << "with bounds";
}

/// Asked for, certificates of islands cost no memory either.
TEST(BlockPivoting, CertifyingIslandsAgainAllocatesNothing) {
  const Problem problem = bench::make_family({.family = "spheres", .size = 60});
  BlockPivotingSettings settings;
  settings.certify_islands = true;
  BlockPivoting solver(settings);
  Result result;
  solver.solve(problem, result);
  const std::vector<Certificate> first = result.island_certificates;
  ASSERT_FALSE(first.empty());
  ASSERT_EQ(result.island_of_row.size(), static_cast<std::size_t>(problem.size()));
  const AllocationCount allocations;
  solver.solve(problem, result);
  EXPECT_EQ(allocations.count(), 0);
  double worst = 0.0;
  for (const Certificate& certificate : result.island_certificates) {
    worst = std::max(worst, certificate.natural_residual);
  }
  EXPECT_GE(worst, result.certificate.natural_residual) << "each against its own q";
  EXPECT_EQ(first.size(), result.island_certificates.size());
}

TEST(BlockPivoting, RefusesCoupledLimitsAndCones) {
  BlockPivoting solver;
  Problem coupled = lcp(Matrix::Identity(2, 2), Vector::Zero(2));
  coupled.limits = {{1, 0, 0.5}};
  EXPECT_NE(solver.refuses(coupled).find("row 1"), std::string::npos);
  Problem cone = lcp(Matrix::Identity(3, 3), Vector::Zero(3));
  cone.cones = {{0, 3, 0.5}};
  EXPECT_NE(solver.refuses(cone).find("row 0"), std::string::npos);
}

TEST(BlockPivoting, SettingsAreChecked) {
  BlockPivotingSettings settings;
  settings.proximal = 0.0;
  EXPECT_THROW(BlockPivoting{settings}, std::invalid_argument);
  settings = {};
  settings.block_trials = -1;
  EXPECT_THROW(BlockPivoting{settings}, std::invalid_argument);
  settings = {};
  settings.proximal_steps = 0;
  EXPECT_THROW(BlockPivoting{settings}, std::invalid_argument);
}

TEST(BlockPivoting, SameProblemSameBitsWhateverWasSolvedBefore) {
  const Problem problem = bench::make_family({.family = "pyramid2d", .size = 5});
  const Result fresh = solve(problem);
  BlockPivoting used;
  Result result;
  used.solve(bench::make_family({.family = "spheres", .size = 40}), result);
  used.solve(problem, result);
  EXPECT_EQ(result.z, fresh.z);
}

}  // namespace
}  // namespace signorini::lcp
