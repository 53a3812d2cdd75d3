#include <signorini/lcp/interior_point.h>
#include <signorini/lcp/nncg.h>

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
  EXPECT_GT(result.statistics.factor_bytes, 0);
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

Problem perturbed(const Problem& problem, std::uint64_t seed);

/// A family whose rows are made free (joints), boxed from both sides, bounded from above alone or
/// fixed, in turn; 0 stays between the bounds, so that free fall is admissible.
Problem bounded_family(const FamilySpec& spec) {
  Problem problem = make_family(spec);
  const Index n = problem.size();
  const double infinity = std::numeric_limits<double>::infinity();
  problem.lower.setZero(n);
  problem.upper.setConstant(n, infinity);
  for (Index i = 0; i < n; ++i) {
    switch (i % 7) {
      case 1: problem.lower[i] = -infinity; break;
      case 3: problem.lower[i] = -0.01 * spec.mass_ratio; [[fallthrough]];
      case 4: problem.upper[i] = 0.02; break;
      case 5: problem.lower[i] = -infinity, problem.upper[i] = 0.0; break;
      case 6: problem.upper[i] = i % 2 == 0 ? 0.0 : infinity; break;
      default: break;
    }
  }
  return problem;
}

TEST_P(InteriorPointOnFamilies, BoundsAndFreeRowsAreCertified) {
  const Problem problem = bounded_family(GetParam().spec);
  InteriorPoint solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_TRUE(is_solved(result.status)) << to_string(result.status) << " " << result.detail
                                        << ", residual " << result.certificate.unit_free_residual;
  EXPECT_LE((problem.lower - result.z).maxCoeff(), 0.0);
  EXPECT_LE((result.z - problem.upper).maxCoeff(), 0.0);
}

TEST_P(InteriorPointOnFamilies, TheFormedMatrixIsCertifiedAsWell) {
  for (const bool bounded : {false, true}) {
    Problem problem = bounded ? bounded_family(GetParam().spec) : make_family(GetParam().spec);
    problem.M = SparseMatrix(std::get<FactoredMatrix>(problem.M).form());
    InteriorPoint solver;
    Result result;
    solver.solve(problem, result);
    EXPECT_TRUE(is_solved(result.status))
        << to_string(result.status) << " " << result.detail << ", residual "
        << result.certificate.unit_free_residual << (bounded ? ", bounded" : "");
  }
}

/// Random monotone M = B B^T + K, K skew, dense and as a sparse matrix, with every kind of bound.
TEST(InteriorPoint, NonsymmetricMonotoneMatrices) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const double infinity = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < 40; ++trial) {
    const Index n = 1 + trial;
    const Matrix B = Matrix::NullaryExpr(n, 1 + n / 2, [&] { return normal(random); });
    const Matrix C = Matrix::NullaryExpr(n, n, [&] { return normal(random); });
    Problem problem;
    problem.M = Matrix(B * B.transpose() + Matrix::Identity(n, n) + C - C.transpose());
    problem.q = Vector::NullaryExpr(n, [&] { return normal(random); });
    if (trial % 2 == 1) {
      problem.lower = Vector::Constant(n, -0.1);
      problem.upper = Vector::Constant(n, 0.2);
      problem.upper[0] = infinity;
      problem.lower[n - 1] = -infinity;
    }
    for (const bool sparse : {false, true}) {
      if (sparse) {
        problem.M = SparseMatrix(std::get<Matrix>(problem.M).sparseView());
      }
      InteriorPoint solver;
      Result result;
      solver.solve(problem, result);
      EXPECT_EQ(result.status, Status::kSolved)
          << n << " rows, residual " << result.certificate.unit_free_residual;
      EXPECT_LE(definition_residual(problem, result.z), 1e-8) << n;
    }
  }
}

/// Two free rows that are the same: without a proximal term there is no factor.
TEST(InteriorPoint, ARaisedProximalTermIsInTheResult) {
  Problem problem;
  problem.M = Matrix{{1.0, 1.0}, {1.0, 1.0}};
  problem.q = Vector{{-1.0, -1.0}};
  problem.lower = Vector::Constant(2, -std::numeric_limits<double>::infinity());
  InteriorPointSettings settings;
  settings.proximal = 0.0;
  InteriorPoint solver(settings);
  Result result;
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved) << result.detail;
  EXPECT_NE(result.detail.find("proximal term raised"), std::string::npos) << result.detail;
  InteriorPoint usual;
  usual.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.detail, "");
}

TEST(InteriorPoint, FreeRowsAloneAreALinearSystem) {
  Problem problem = make_family({"tower4", 5});
  problem.lower.setConstant(problem.size(), -std::numeric_limits<double>::infinity());
  InteriorPoint solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_LE(result.w.cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LE(definition_residual(problem, result.z), 1e-8);
}

TEST(InteriorPoint, FixedRowsStayWhereTheyAre) {
  Problem problem = make_family({"tower4", 3});
  problem.lower.setConstant(problem.size(), 0.25);
  problem.upper = problem.lower;
  InteriorPoint solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.z, problem.lower);
}

/// The velocities of the bodies change by 1 % of their spread: q + J dv.
Problem perturbed(const Problem& problem, std::uint64_t seed) {
  Problem other = problem;
  const auto& A = std::get<FactoredMatrix>(problem.M);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 0.01 * 0.1);
  const Vector dv = Vector::NullaryExpr(A.degrees_of_freedom(), [&] { return normal(random); });
  const Vector none = Vector::Zero(A.rows());
  Vector dq(A.rows());
  A.times(dv.data(), none.data(), dq.data());
  other.q += dq;
  return other;
}

struct Counts {
  FamilySpec spec;
  int cold;  // factorisations, at most; a fifth above what is measured
  int warm;
};

class FactorizationCounts : public testing::TestWithParam<Counts> {};

TEST_P(FactorizationCounts, ColdWarmAndToTheLastDigits) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the counts are checked without sanitizers";
#endif
  const Problem problem = make_family(GetParam().spec);
  InteriorPoint solver;
  Result cold;
  solver.solve(problem, cold);
  EXPECT_TRUE(is_solved(cold.status)) << to_string(cold.status);
  EXPECT_LE(cold.statistics.factorizations, GetParam().cold);
  Result warm;
  solver.solve(perturbed(problem, 5), warm, &cold.z);
  EXPECT_TRUE(is_solved(warm.status)) << to_string(warm.status);
  EXPECT_LE(warm.statistics.factorizations, GetParam().warm);
  InteriorPoint exact({{.tolerance = 1e-12}});
  Result last_digits;
  exact.solve(problem, last_digits);
  EXPECT_TRUE(is_solved(last_digits.status)) << to_string(last_digits.status);
  EXPECT_LE(last_digits.statistics.factorizations, cold.statistics.factorizations + 2);
}

INSTANTIATE_TEST_SUITE_P(
    Families, FactorizationCounts,
    testing::Values(Counts{{"tower4", 250}, 10, 2}, Counts{{"tower8", 125}, 1, 2},
                    Counts{{"pyramid2d", 16}, 18, 4}, Counts{{"pyramid2d", 30}, 32, 8},
                    Counts{{"pyramid3d", 6}, 11, 2}, Counts{{"pyramid3d", 9}, 24, 8},
                    Counts{{"wall", 11}, 11, 4}, Counts{{"spheres", 1000}, 15, 5},
                    Counts{{.family = "tower4", .size = 250, .at_rest = true}, 1, 2},
                    Counts{{.family = "pyramid2d", .size = 16, .at_rest = true}, 2, 4},
                    Counts{{.family = "pyramid3d", .size = 6, .at_rest = true}, 1, 2}),
    [](const auto& tested) {
      return std::string(tested.param.spec.family) + std::to_string(tested.param.spec.size) +
             (tested.param.spec.at_rest ? "AtRest" : "");
    });

/// The second problem has the size and the contacts of the first, and other velocities; the third
/// is the first again, from the second's answer.
TEST_P(InteriorPointOnFamilies, SolvingAgainAllocatesNothing) {
  const Problem problem = make_family(GetParam().spec);
  const Problem other = perturbed(problem, 6);
  const Problem bounded = bounded_family(GetParam().spec);
  InteriorPoint solver;
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
  solver.solve(bounded, warm);
  EXPECT_EQ(allocations.count(), 0) << "with bounds";
}

/// Where the active set of a warm start fails, smoothing goes on from it and no interior iteration
/// is needed, whatever the masses are.
TEST(InteriorPoint, AFailedWarmSetIsGoneOnFromBySmoothing) {
  for (const FamilySpec& spec :
       {FamilySpec{"pyramid2d", 30}, FamilySpec{"pyramid3d", 12}, FamilySpec{"pyramid3d", 12, 1e3},
        FamilySpec{"pyramid2d", 28, 1e6}}) {
    const Problem problem = make_family(spec);
    const Problem other = perturbed(problem, 5);
    InteriorPoint solver;
    Result cold;
    Result warm;
    solver.solve(problem, cold);
    solver.solve(other, warm, &cold.z);
    EXPECT_EQ(warm.status, Status::kSolved);
    EXPECT_EQ(warm.statistics.iterations, 0);
    EXPECT_LE(definition_residual(other, warm.z), 1e-7);
    InteriorPoint limited({{.max_iterations = 0}});
    Result set_alone;
    limited.solve(other, set_alone, &cold.z);
    EXPECT_EQ(set_alone.status, Status::kIterationLimit);
    EXPECT_LT(set_alone.statistics.factorizations, warm.statistics.factorizations)
        << "the set was enough";
    EXPECT_LE(warm.statistics.factorizations, 10) << "14 to 36 by the interior point";
  }
}

/// What a few sweeps leave is small everywhere and right nowhere: a start from there costs a few
/// factorisations more than none.
TEST(InteriorPoint, AWarmStartThatIsWrongEverywhereIsLeftEarly) {
  const Problem problem = make_family({.family = "pyramid3d", .size = 10});
  NncgSettings few;
  few.max_iterations = 30;
  few.tolerance = 1e-12;
  Result swept;
  Nncg(few).solve(problem, swept);
  ASSERT_LT(swept.certificate.unit_free_residual, 0.01);
  InteriorPoint solver;
  Result cold;
  Result warm;
  solver.solve(problem, cold);
  solver.solve(problem, warm, &swept.z);
  EXPECT_EQ(warm.status, Status::kSolved);
  EXPECT_LE(warm.statistics.factorizations, cold.statistics.factorizations + 5);
}

/// Where a factorisation costs much, sweeps find the set first: 13 factorisations without them.
TEST(InteriorPoint, StartsLargePilesFromSweeps) {
  const Problem problem = make_family({.family = "spheres", .size = 4000});
  InteriorPoint solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.detail, "started from 200 sweeps");
  EXPECT_LE(result.statistics.factorizations, 4);
  const AllocationCount allocations;
  solver.solve(problem, result);
  EXPECT_EQ(allocations.count(), 0);
  InteriorPointSettings at_once;
  at_once.time_limit = 1e-9;
  InteriorPoint(at_once).solve(problem, result);
  EXPECT_EQ(result.status, Status::kTimeLimit);
  EXPECT_EQ(result.detail, "");  // no sweeps
}

TEST(InteriorPoint, SolvesPilesThatSweepsDoNotSettle) {
  for (const double ratio : {100.0, 1000.0}) {  // sweeps fail; and are not tried
    const Problem problem =
        make_family({.family = "spheres", .size = 3500, .mass_ratio = ratio, .at_rest = true});
    InteriorPoint solver;
    Result result;
    solver.solve(problem, result);
    EXPECT_EQ(result.status, Status::kSolved) << ratio;
    EXPECT_EQ(result.detail, ratio == 100.0 ? "started from 200 sweeps" : "");
  }
}

TEST(InteriorPoint, RefusesCoupledLimitsAndCones) {
  InteriorPoint solver;
  Result result;
  Problem coupled = one_row(1.0, -1.0);
  coupled.limits = {{0, 0, 0.5}};
  EXPECT_FALSE(solver.refuses(coupled).empty());
  Problem cone = make_family({"tower4", 1});
  cone.cones = {{0, 3, 0.5}};
  EXPECT_THROW(solver.solve(cone, result), std::invalid_argument);
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
