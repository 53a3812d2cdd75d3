#include <signorini/lcp/apgd.h>
#include <signorini/lcp/interior_point.h>

#include "allocation_count.h"
#include "definition_residual.h"

#include <bench/contact_families.h>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>

namespace signorini::lcp {
namespace {

using bench::make_family;

class ApgdOnFamilies : public testing::TestWithParam<std::string_view> {};

TEST_P(ApgdOnFamilies, AgreesWithInteriorPointInVelocity) {
  const int size = GetParam() == "spheres" ? 60 : 4;
  const Problem problem = make_family({GetParam(), size});
  Apgd apgd;
  Result result;
  apgd.solve(problem, result);
  ASSERT_TRUE(is_solved(result.status)) << to_string(result.status);
  InteriorPoint exact({{.tolerance = 1e-14}});
  Result reference;
  exact.solve(problem, reference);
  ASSERT_TRUE(is_solved(reference.status)) << to_string(reference.status);
  // w = A z + q is unique. For monotone A, |dw| is bounded by the residual times a conditioning of
  // a few hundred on piles this small.
  EXPECT_LE((result.w - reference.w).cwiseAbs().maxCoeff(), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(All, ApgdOnFamilies, testing::ValuesIn(bench::family_names()),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(Apgd, HonoursBoxesAndFreeRows) {
  Problem problem = make_family({"spheres", 60});
  problem.lower = Vector::Zero(60);
  problem.upper = Vector::Constant(60, 0.02);
  problem.lower[7] = -std::numeric_limits<double>::infinity();
  problem.upper[7] = std::numeric_limits<double>::infinity();
  Apgd solver;
  Result result;
  solver.solve(problem, result);
  ASSERT_TRUE(is_solved(result.status)) << to_string(result.status);
  EXPECT_NEAR(result.w[7], 0.0, 1e-7);
  EXPECT_LE(definition_residual(problem, result.z), 1e-8);
  int at_upper = 0;
  for (Index i = 0; i < 60; ++i) {
    if (i != 7) {
      EXPECT_GE(result.z[i], 0.0);
      EXPECT_LE(result.z[i], 0.02);
      at_upper += result.z[i] == 0.02;
    }
  }
  EXPECT_GT(at_upper, 0) << "the box was never active: the test shows nothing";
}

TEST(Apgd, AnUnderestimatedLipschitzConstantIsCaught) {
  ApgdSettings settings;
  settings.power_iterations = 1;
  settings.lipschitz_margin = 1.0;
  Apgd solver(settings);
  Result result;
  solver.solve(make_family({"tower4", 6}), result);
  EXPECT_TRUE(is_solved(result.status)) << to_string(result.status);
}

TEST(Apgd, WarmStartFromTheSolutionTakesNoIterations) {
  const Problem problem = make_family({"wall", 4});
  Apgd solver;
  Result cold;
  solver.solve(problem, cold);
  ASSERT_TRUE(is_solved(cold.status));
  Result warm;
  solver.solve(problem, warm, &cold.z);
  EXPECT_EQ(warm.statistics.iterations, 0);
  EXPECT_TRUE(is_solved(warm.status));
}

TEST(Apgd, StarvationIsAnIterationLimit) {
  Apgd solver({{.max_iterations = 3}});
  Result result;
  solver.solve(make_family({"tower4", 10}), result);
  EXPECT_EQ(result.status, Status::kIterationLimit);
  EXPECT_TRUE(result.z.allFinite());
}

TEST(Apgd, ZeroMatrixAndNoRows) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix{{1.0}});
  A.add_row();
  Problem problem;
  problem.M = A;
  problem.q = Vector{{-1.0}};
  Apgd solver({{.max_iterations = 50}});
  Result result;
  solver.solve(problem, result);
  EXPECT_FALSE(is_solved(result.status));
  problem.q = Vector{{1.0}};
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  Problem none;
  none.M = FactoredMatrix();
  solver.solve(none, result);
  EXPECT_EQ(result.status, Status::kSolved);
}

TEST(Apgd, RefusesCoupledLimitsAndAMatrixGivenWhole) {
  Apgd solver;
  Result result;
  Problem coupled = make_family({"tower4", 2});
  coupled.limits = {{1, 0, 0.5}};
  EXPECT_THROW(solver.solve(coupled, result), std::invalid_argument);
  Problem dense;
  dense.M = Matrix{{1.0}};
  dense.q = Vector{{-1.0}};
  EXPECT_THROW(solver.solve(dense, result), std::invalid_argument);
}

TEST(Apgd, SettingsOutOfRangeAreNamed) {
  const auto with = [](auto field, auto value) {
    ApgdSettings settings;
    settings.*field = value;
    return settings;
  };
  EXPECT_THROW(Apgd(with(&ApgdSettings::power_iterations, 0)), std::invalid_argument);
  EXPECT_THROW(Apgd(with(&ApgdSettings::lipschitz_margin, 0.5)), std::invalid_argument);
  EXPECT_THROW(Apgd(with(&ApgdSettings::check_period, 0)), std::invalid_argument);
}

TEST(Apgd, SolvingAgainAllocatesNothing) {
  const Problem problem = bench::make_family({"pyramid2d", 5});
  const Problem other = bench::make_family({"pyramid2d", 5, 1.0, 2});
  Apgd solver;
  Result result;
  Result warm;
  solver.solve(problem, result);
  solver.solve(problem, warm, &result.z);
  const AllocationCount allocations;
  solver.solve(other, result);
  solver.solve(problem, warm, &result.z);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace signorini::lcp
