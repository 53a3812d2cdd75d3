#include <signorini/lcp/interior_point.h>

#include <bench/contact_families.h>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace signorini::lcp {
namespace {

using bench::FamilySpec;
using bench::make_family;

struct Case {
  FamilySpec spec;
  [[nodiscard]] std::string name() const {
    return std::string(spec.family) + "_" + std::to_string(spec.size) + "_R" +
           std::to_string(static_cast<int>(std::log10(spec.mass_ratio))) +
           (spec.at_rest ? "_rest" : "");
  }
};

class InteriorPointOnFamilies : public testing::TestWithParam<Case> {};

TEST_P(InteriorPointOnFamilies, IsCertified) {
  const Problem problem = make_family(GetParam().spec);
  InteriorPoint solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_TRUE(is_solved(result.status)) << to_string(result.status) << " " << result.detail
                                        << ", residual " << result.certificate.unit_free_residual;
  EXPECT_GE(result.z.minCoeff(), 0.0);
  EXPECT_LE(result.statistics.factorizations, 80);
}

TEST_P(InteriorPointOnFamilies, PolishReachesTheRoundingFloor) {
  const Problem problem = make_family(GetParam().spec);
  InteriorPoint solver({{.tolerance = 1e-15}});
  Result result;
  solver.solve(problem, result);
  EXPECT_TRUE(is_solved(result.status))
      << to_string(result.status) << ", residual " << result.certificate.unit_free_residual
      << ", floor " << result.certificate.rounding_floor;
}

INSTANTIATE_TEST_SUITE_P(All, InteriorPointOnFamilies,
                         testing::Values(Case{{"tower4", 16}}, Case{{"tower4", 16, 1e6}},
                                         Case{{"tower8", 20, 1e3}}, Case{{"pyramid2d", 6}},
                                         Case{{"pyramid2d", 6, 1e6}}, Case{{"pyramid3d", 4}},
                                         Case{{"wall", 5}}, Case{{"wall", 5, 1e3}},
                                         Case{{"spheres", 100}}, Case{{"spheres", 100, 1e6}},
                                         Case{{"spheres", 100, 1.0, 1, true}}),
                         [](const auto& tested) { return tested.param.name(); });

/// One block of one degree of freedom, A = [a], q = [b].
Problem one_row(double a, double b) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix{{1.0}});
  A.add_row();
  A.add_entry(0, Vector{{std::sqrt(a)}});
  Problem problem;
  problem.M = A;
  problem.q = Vector{{b}};
  return problem;
}

TEST(InteriorPoint, OneRowOfEitherSign) {
  InteriorPoint solver;
  Result result;
  solver.solve(one_row(4.0, -2.0), result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_NEAR(result.z[0], 0.5, 1e-9);
  solver.solve(one_row(4.0, 2.0), result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_NEAR(result.z[0], 0.0, 1e-9);
}

TEST(InteriorPoint, ComplianceOfARowIsAdded) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix{{1.0}});
  A.add_row(3.0);
  A.add_entry(0, Vector{{1.0}});
  Problem problem;
  problem.M = A;
  problem.q = Vector{{-2.0}};
  InteriorPoint solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_NEAR(result.z[0], 0.5, 1e-8);
}

TEST(InteriorPoint, InfeasibleOppositeRowsAreNotCalledSolved) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix{{1.0}});
  for (const double sign : {1.0, -1.0}) {
    A.add_row();
    A.add_entry(0, Vector{{sign}});
  }
  Problem problem;
  problem.M = A;
  problem.q = Vector{{-1.0, -1.0}};
  InteriorPoint solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_FALSE(is_solved(result.status));
  EXPECT_TRUE(result.z.allFinite());
  EXPECT_GT(result.certificate.unit_free_residual, 0.1);
}

TEST(InteriorPoint, StarvationIsAnIterationLimit) {
  InteriorPoint solver({{.max_iterations = 2}});
  Result result;
  solver.solve(make_family({"spheres", 60}), result);
  EXPECT_EQ(result.status, Status::kIterationLimit);
  EXPECT_TRUE(result.z.allFinite());
}

TEST(InteriorPoint, WarmStartFromTheSolutionCostsLess) {
  const Problem problem = make_family({"pyramid2d", 6});
  InteriorPoint solver;
  Result cold;
  solver.solve(problem, cold);
  Result warm;
  solver.solve(problem, warm, &cold.z);
  EXPECT_TRUE(is_solved(warm.status));
  EXPECT_LT(warm.statistics.factorizations, cold.statistics.factorizations / 2);
}

TEST(InteriorPoint, SolvingAgainGivesTheSameBits) {
  const Problem problem = make_family({"spheres", 80, 1e3});
  InteriorPoint solver;
  Result first;
  solver.solve(problem, first);
  Result other;
  solver.solve(make_family({"wall", 4}), other);
  Result second;
  solver.solve(problem, second);
  EXPECT_EQ(first.z, second.z);
}

TEST(InteriorPoint, RefusesAMatrixThatIsGivenWholeAndBounds) {
  InteriorPoint solver;
  Result result;
  Problem dense;
  dense.M = Matrix{{1.0}};
  dense.q = Vector{{-1.0}};
  EXPECT_THROW(solver.solve(dense, result), std::invalid_argument);
  Problem bounded = one_row(1.0, -1.0);
  bounded.upper = Vector{{0.5}};
  EXPECT_THROW(solver.solve(bounded, result), std::invalid_argument);
}

TEST(InteriorPoint, NoRowsAndNotANumber) {
  InteriorPoint solver;
  Result result;
  Problem none;
  none.M = FactoredMatrix();
  solver.solve(none, result);
  EXPECT_EQ(result.status, Status::kSolved);
  solver.solve(one_row(1.0, std::numeric_limits<double>::quiet_NaN()), result);
  EXPECT_EQ(result.status, Status::kInvalidInput);
}

TEST(InteriorPoint, SettingsOutOfRangeAreNamed) {
  const auto with = [](auto field, auto value) {
    InteriorPointSettings settings;
    settings.*field = value;
    return settings;
  };
  EXPECT_THROW(InteriorPoint(with(&InteriorPointSettings::step_fraction, 1.0)),
               std::invalid_argument);
  EXPECT_THROW(InteriorPoint(with(&InteriorPointSettings::proximal, -1.0)), std::invalid_argument);
  EXPECT_THROW(InteriorPoint(with(&InteriorPointSettings::polish_proximal, 0.0)),
               std::invalid_argument);
  EXPECT_THROW(InteriorPoint(with(&InteriorPointSettings::max_polish_steps, -1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace signorini::lcp
