#include <signorini/lcp/structured_lemke.h>

#include <bench/contact_families.h>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#ifdef SIGNORINI_HAS_GMP
#include <signorini/lcp/exact_lemke.h>
#endif

namespace signorini::lcp {
namespace {

Problem lcp(const Matrix& M, const Vector& q) {
  Problem problem;
  problem.M = M;
  problem.q = q;
  return problem;
}

Result solve(const Problem& problem, const StructuredLemkeSettings& settings = {},
             const Vector* warm_start = nullptr) {
  StructuredLemke solver(settings);
  Result result;
  solver.solve(problem, result, warm_start);
  return result;
}

StructuredLemkeSettings with_sweeps(int sweeps) {
  StructuredLemkeSettings settings;
  settings.crash_sweeps = sweeps;
  return settings;
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
  const Status solved = Status::kSolved;
  return {
      {"Empty", lcp(Matrix(0, 0), Vector(0)), solved},
      {"OnePushed", lcp(2.0 * I1, Vector{{-3.0}}), solved},
      {"OneFree", lcp(2.0 * I1, Vector{{3.0}}), solved},
      {"OneTouching", lcp(2.0 * I1, Vector{{0.0}}), solved},
      {"OneZeroRowFeasible", lcp(O1, Vector{{1.0}}), solved},
      {"OneZeroRowDegenerate", lcp(O1, Vector{{0.0}}), solved},
      {"OneZeroRowInfeasible", lcp(O1, Vector{{-1.0}}), Status::kInfeasible},
      {"OppositeWallsClosing", lcp(walls, Vector{{-1.0, -1.0}}), Status::kInfeasible},
      {"OppositeWallsAgreeing", lcp(walls, Vector{{-1.0, 1.0}}), solved},
      {"OppositeWallsOpening", lcp(walls, Vector{{-1.0, 2.0}}), solved},
      {"SameRowTwice", lcp(same, Vector{{-1.0, -1.0}}), solved},
      {"SameRowTwiceTheSecondStronger", lcp(same, Vector{{-1.0, -2.0}}), solved},
      {"NotANumber", lcp(I1, Vector{{std::nan("")}}), Status::kInvalidInput},
      {"Tiny", lcp(1e-150 * I1, Vector{{-1e-150}}), solved},
      {"Huge", lcp(1e150 * I1, Vector{{-1e150}}), solved},
  };
}

class StructuredLemkeEnds : public testing::TestWithParam<Named> {};

TEST_P(StructuredLemkeEnds, AsExpectedWithAndWithoutAFirstBasis) {
  for (const int sweeps : {0, 20}) {
    const Result result = solve(GetParam().problem, with_sweeps(sweeps));
    EXPECT_EQ(result.status, GetParam().expected) << sweeps << " sweeps: " << result.detail;
  }
}

INSTANTIATE_TEST_SUITE_P(StructuredLemke, StructuredLemkeEnds, testing::ValuesIn(named_problems()),
                         [](const auto& tested) { return std::string(tested.param.name); });

using Family = std::tuple<std::string, int, double>;
class StructuredLemkeSolves : public testing::TestWithParam<Family> {};

/// Redundant contacts and mass ratios, moving and at rest, from z = 0 and from a first basis.
TEST_P(StructuredLemkeSolves, ContactFamilies) {
  const auto& [family, size, ratio] = GetParam();
  for (const bool at_rest : {false, true}) {
    const Problem problem = bench::make_family(
        {.family = family, .size = size, .mass_ratio = ratio, .at_rest = at_rest});
    for (const int sweeps : {0, 20}) {
      const Result result = solve(problem, with_sweeps(sweeps));
      EXPECT_TRUE(is_solved(result.status)) << to_string(result.status) << ", " << result.detail;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Towers, StructuredLemkeSolves,
                         testing::Combine(testing::Values("tower4"), testing::Values(1, 4, 16, 60),
                                          testing::Values(1.0, 1e3, 1e6)));
INSTANTIATE_TEST_SUITE_P(Piles, StructuredLemkeSolves,
                         testing::Combine(testing::Values("spheres"), testing::Values(16, 64, 250),
                                          testing::Values(1.0, 1e3, 1e6)));
INSTANTIATE_TEST_SUITE_P(Pyramids, StructuredLemkeSolves,
                         testing::Combine(testing::Values("pyramid2d", "pyramid3d", "wall",
                                                          "tower8"),
                                          testing::Values(2, 4), testing::Values(1.0, 1e6)));

/// The sweeps guess most of the basis (measured: 48 and 391 pivots).
TEST(StructuredLemke, AFirstBasisSavesPivots) {
  const Problem problem = bench::make_family({.family = "spheres", .size = 256});
  const Result cold = solve(problem, with_sweeps(0));
  const Result crash = solve(problem);
  EXPECT_LT(4 * crash.statistics.pivots, cold.statistics.pivots);
  EXPECT_NE(crash.detail.find("from a first basis of"), std::string::npos) << crash.detail;
}

TEST(StructuredLemke, WarmStartFromASolutionTakesNoPivots) {
  for (const int size : {32, 256}) {  // tableau and factor
    const Problem problem = bench::make_family({.family = "spheres", .size = size});
    const Result cold = solve(problem);
    ASSERT_EQ(cold.status, Status::kSolved);
    const Result warm = solve(problem, {}, &cold.z);
    EXPECT_EQ(warm.status, Status::kSolved);
    EXPECT_EQ(warm.statistics.pivots, 0);
  }
}

#ifdef SIGNORINI_HAS_GMP
/// Small integers: degenerate and redundant throughout, exact ties, many infeasible.
TEST(StructuredLemke, SmallIntegerProblemsAgreeWithExactArithmetic) {
  std::mt19937 random(5);
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
    const Result result = solve(problem, with_sweeps(trial % 2 == 0 ? 0 : 20));
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

TEST(StructuredLemke, EndsAtItsLimits) {
  const Problem problem = bench::make_family({.family = "tower4", .size = 8});
  StructuredLemkeSettings settings = with_sweeps(0);
  settings.max_iterations = 3;
  const Result few = solve(problem, settings);
  EXPECT_EQ(few.status, Status::kIterationLimit);
  EXPECT_EQ(few.statistics.pivots, 3);
  settings = with_sweeps(0);
  settings.time_limit = 1e-12;
  EXPECT_EQ(solve(problem, settings).status, Status::kTimeLimit);
}

TEST(StructuredLemke, RefusesWhatItCannotTake) {
  const Matrix I = Matrix::Identity(3, 3);
  const Vector q = Vector::Constant(3, -1.0);
  EXPECT_THROW(solve(lcp(Matrix{{2, 1}, {0, 2}}, Vector{{-1.0, -2.0}})), std::invalid_argument);
  Problem boxed = lcp(I, q);
  boxed.upper = Vector::Ones(3);
  EXPECT_THROW(solve(boxed), std::invalid_argument);
  Problem cone = lcp(I, q);
  cone.cones.push_back({0, 3, 0.5});
  EXPECT_THROW(solve(cone), std::invalid_argument);
}

TEST(StructuredLemke, SettingsAreChecked) {
  StructuredLemkeSettings settings;
  settings.stop_tolerance = 0.1;
  EXPECT_THROW(StructuredLemke{settings}, std::invalid_argument);
  settings = with_sweeps(-1);
  EXPECT_THROW(StructuredLemke{settings}, std::invalid_argument);
}

TEST(StructuredLemke, SameProblemSameBitsWhateverWasSolvedBefore) {
  const Problem problem = bench::make_family({.family = "pyramid2d", .size = 7, .mass_ratio = 1e3});
  StructuredLemke used;
  Result again;
  used.solve(bench::make_family({.family = "spheres", .size = 300}), again);
  used.solve(problem, again);
  const Result fresh = solve(problem);
  EXPECT_TRUE(again.z == fresh.z);
  EXPECT_EQ(again.statistics.pivots, fresh.statistics.pivots);
}

}  // namespace
}  // namespace signorini::lcp
