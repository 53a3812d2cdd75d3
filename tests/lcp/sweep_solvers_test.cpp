#include <signorini/lcp/nncg.h>
#include <signorini/lcp/pgs.h>
#include <signorini/lcp/psor.h>
#include <signorini/lcp/symmetric_pgs.h>

#include "definition_residual.h"
#include "tests/lcp/allocation_count.h"
#include "tests/lcp/sweep_problems.h"

#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Make = std::unique_ptr<Solver> (*)(const SweepSettings&);

template <typename Made, typename Settings>
std::unique_ptr<Solver> make(const SweepSettings& settings) {
  Settings own;
  static_cast<SweepSettings&>(own) = settings;
  return std::make_unique<Made>(own);
}

struct Method {
  std::string name;
  Make make;
  RowOrder order;
};
void PrintTo(const Method& method, std::ostream* out) {
  *out << method.name;
}

const std::vector<Method> kMethods = {
    {"Pgs", &make<Pgs, PgsSettings>, RowOrder::kNatural},
    {"PgsColoured", &make<Pgs, PgsSettings>, RowOrder::kColoured},
    {"SymmetricPgs", &make<SymmetricPgs, SymmetricPgsSettings>, RowOrder::kNatural},
    {"SymmetricPgsColoured", &make<SymmetricPgs, SymmetricPgsSettings>, RowOrder::kColoured},
    {"Psor", &make<Psor, PsorSettings>, RowOrder::kNatural},
    {"PsorColoured", &make<Psor, PsorSettings>, RowOrder::kColoured},
    {"Nncg", &make<Nncg, NncgSettings>, RowOrder::kNatural},
    {"NncgColoured", &make<Nncg, NncgSettings>, RowOrder::kColoured},
};

class SweepSolvers : public testing::TestWithParam<Method> {
 protected:
  [[nodiscard]] static SweepSettings settings(Precision precision = Precision::kDouble) {
    SweepSettings settings;
    settings.row_order = GetParam().order;
    settings.precision = precision;
    settings.max_iterations = 200000;
    settings.tolerance = precision == Precision::kFloat ? 1e-3 : 1e-8;
    return settings;
  }
  [[nodiscard]] static Result solve(const Problem& problem, const SweepSettings& settings,
                                    const Vector* warm_start = nullptr) {
    Result result;
    GetParam().make(settings)->solve(problem, result, warm_start);
    return result;
  }
};
INSTANTIATE_TEST_SUITE_P(Methods, SweepSolvers, testing::ValuesIn(kMethods),
                         [](const auto& method) { return method.param.name; });

/// `problem` with its matrix formed, whole or by columns.
Problem with_matrix(const Problem& problem, MatrixForm M) {
  Problem other = problem;
  other.M = std::move(M);
  return other;
}

const std::vector<SweepProblemSpec> kSolvable = {
    {.seed = 1},
    {.bodies = 12, .rows = 60, .rows_a_pair = 4, .seed = 2},
    {.bodies = 9, .rows = 30, .articulated = true, .seed = 3},
    {.bodies = 9, .rows = 30, .compliant = true, .bounded = true, .seed = 4},
    {.bodies = 12, .rows = 30, .rows_a_pair = 3, .coupled = true, .seed = 5},
    {.bodies = 12, .rows = 30, .coupled = true, .seed = 6},
    {.bodies = 12, .rows = 24, .semidefinite = true, .seed = 7},
};

TEST_P(SweepSolvers, CertifyRedundantBoundedAndCoupledProblemsInEveryForm) {
  for (const SweepProblemSpec& spec : kSolvable) {
    const Problem problem = sweep_problem(spec);
    const SparseMatrix formed = std::get<FactoredMatrix>(problem.M).form();
    for (const Problem& form :
         {problem, with_matrix(problem, formed), with_matrix(problem, Matrix(formed))}) {
      const Result result = solve(form, settings());
      EXPECT_TRUE(is_solved(result.status))
          << "seed " << spec.seed << ", form " << form.M.index() << ": " << to_string(result.status)
          << " " << result.detail << ", residual " << result.certificate.unit_free_residual;
      EXPECT_LE(result.certificate.unit_free_residual, 1e-8);
      EXPECT_LE(definition_residual(form, result.z), 1e-8) << "seed " << spec.seed;
    }
  }
}

/// The iterate is float, the certificate is of the caller's data in long double.
TEST_P(SweepSolvers, ReachSmallResidualsInFloat) {
  for (const SweepProblemSpec& spec : kSolvable) {
    const Problem problem = sweep_problem(spec);
    const Problem dense = with_matrix(problem, to_dense(problem.M));
    for (const Problem& form : {problem, dense}) {
      const Result result = solve(form, settings(Precision::kFloat));
      EXPECT_EQ(result.status, Status::kSolved)
          << "seed " << spec.seed << ": " << result.detail << ", residual "
          << result.certificate.unit_free_residual;
      EXPECT_TRUE(result.solver.ends_with("-float")) << result.solver;
    }
  }
}

TEST_P(SweepSolvers, FloatThatCannotReachTheToleranceSaysSo) {
  const Problem problem = sweep_problem({.seed = 11});
  SweepSettings wanted = settings(Precision::kFloat);
  wanted.tolerance = 1e-12;
  wanted.max_iterations = 3000;
  const Result result = solve(problem, wanted);
  EXPECT_FALSE(is_solved(result.status));
  EXPECT_TRUE(result.status == Status::kStalled || result.status == Status::kIterationLimit)
      << to_string(result.status);
  EXPECT_GT(result.certificate.unit_free_residual, 1e-12);
  EXPECT_LT(result.certificate.unit_free_residual, 1e-3);
}

TEST_P(SweepSolvers, AllocateNothingTheSecondTime) {
  const Problem factored = sweep_problem({.bodies = 20, .rows = 80, .rows_a_pair = 2, .seed = 8});
  const Problem coupled = sweep_problem({.bodies = 20, .rows = 60, .coupled = true, .seed = 9});
  for (const Problem& problem :
       {factored, coupled, with_matrix(factored, to_dense(factored.M)),
        with_matrix(factored, std::get<FactoredMatrix>(factored.M).form())}) {
    for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
      SweepSettings starved = settings(precision);
      starved.max_iterations = 100;
      starved.tolerance = 1e-13;
      const auto solver = GetParam().make(starved);
      Result result;
      solver->solve(problem, result);
      const AllocationCount allocations;
      solver->solve(problem, result);
      EXPECT_EQ(allocations.count(), 0) << "form " << problem.M.index();
    }
  }
}

TEST_P(SweepSolvers, UsedAgainGiveTheBitsOfAFreshSolver) {
  const Problem large = sweep_problem({.bodies = 12, .rows = 60, .rows_a_pair = 4, .seed = 12});
  const Problem small = sweep_problem({.bodies = 4, .rows = 9, .bounded = true, .seed = 13});
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    const auto solver = GetParam().make(settings(precision));
    Result result;
    for (const Problem* problem : {&large, &small, &large}) {
      solver->solve(*problem, result);
      const Result fresh = solve(*problem, settings(precision));
      EXPECT_EQ(result.z, fresh.z);
      EXPECT_EQ(result.statistics.iterations, fresh.statistics.iterations);
    }
  }
}

TEST_P(SweepSolvers, AnyNumberOfThreadsGivesTheSameBits) {
  const Problem problem =
      sweep_problem({.bodies = 80, .rows = 240, .rows_a_pair = 3, .coupled = true, .seed = 20});
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    SweepSettings starved = settings(precision);
    starved.max_iterations = 20;
    starved.tolerance = 1e-13;
    const Result alone = solve(problem, starved);
    for (const int threads : {2, 3}) {
      starved.threads = threads;
      const auto solver = GetParam().make(starved);
      Result result;
      solver->solve(problem, result);
      EXPECT_EQ(result.z, alone.z) << threads << " threads";
      const AllocationCount allocations;
      solver->solve(problem, result);
      EXPECT_EQ(allocations.count(), 0);
      EXPECT_EQ(result.z, alone.z);
    }
  }
}

TEST_P(SweepSolvers, WarmStartFromTheSolutionTakesNoIteration) {
  const Problem problem = sweep_problem({.seed = 14});
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    const Result cold = solve(problem, settings(precision));
    ASSERT_EQ(cold.status, Status::kSolved);
    EXPECT_GT(cold.statistics.iterations, 0);
    const Result warm = solve(problem, settings(precision), &cold.z);
    EXPECT_EQ(warm.status, Status::kSolved);
    EXPECT_EQ(warm.statistics.iterations, 0);
    EXPECT_EQ(warm.z, cold.z);
  }
}

TEST_P(SweepSolvers, StarvedEndAtTheirLimits) {
  const Problem problem = sweep_problem({.seed = 15});
  SweepSettings starved = settings();
  for (const int iterations : {0, 1}) {
    starved.max_iterations = iterations;
    const Result result = solve(problem, starved);
    EXPECT_EQ(result.status, Status::kIterationLimit);
    EXPECT_EQ(result.statistics.iterations, iterations);
    EXPECT_TRUE(result.z.allFinite());
  }
  starved = settings();
  starved.time_limit = 1e-9;
  EXPECT_EQ(solve(problem, starved).status, Status::kTimeLimit);
}

/// One free body pushed along and across a direction in which no row holds it.
Problem zero_row_problem(double q_of_zero_row) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(6, 6));
  A.add_row();
  A.add_entry(0, Vector::Unit(6, 2));
  A.add_row();
  A.add_entry(0, Vector::Zero(6));
  A.add_row();
  Problem problem;
  problem.M = std::move(A);
  problem.q = Eigen::Vector3d(-1.0, q_of_zero_row, 1.0);
  return problem;
}

TEST_P(SweepSolvers, ZeroRowsAreSolvedWhereTheyCanBeAndNamedWhereNot) {
  EXPECT_EQ(solve(zero_row_problem(1.0), settings()).status, Status::kSolved);
  const Result result = solve(zero_row_problem(-1.0), settings());
  EXPECT_EQ(result.status, Status::kStalled);
  EXPECT_NEAR(result.z[0], 1.0, 1e-12);
  EXPECT_EQ(result.z[1], 0.0);
  EXPECT_NE(result.detail.find("row 1: no positive diagonal, w = -1"), std::string::npos)
      << result.detail;
}

TEST_P(SweepSolvers, OverflowIsABreakdownWithAFiniteIterate) {
  Problem problem;
  problem.M = Matrix((Matrix(2, 2) << 1e-200, 0.0, 1e300, 1.0).finished());
  problem.q = Vector::Constant(2, -1.0);
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    const Result result = solve(problem, settings(precision));
    EXPECT_EQ(result.status, Status::kNumericalBreakdown) << result.detail;
    EXPECT_TRUE(result.z.allFinite());
  }
}

TEST_P(SweepSolvers, InfeasibleProblemsAreNeverSolved) {
  Problem problem;
  problem.M = Matrix((Matrix(2, 2) << 1.0, -1.0, -1.0, 1.0).finished());
  problem.q = Vector::Constant(2, -1.0);
  SweepSettings limited = settings();
  limited.max_iterations = 2000;
  const Result result = solve(problem, limited);
  EXPECT_FALSE(is_solved(result.status));
  EXPECT_TRUE(result.z.allFinite());
}

TEST_P(SweepSolvers, EmptyProblemsAreSolvedAndBadValuesRefused) {
  Problem empty;
  empty.M = FactoredMatrix{};
  EXPECT_EQ(solve(empty, settings()).status, Status::kSolved);
  for (const double bad : {kNaN, kInfinity}) {
    Problem problem = sweep_problem({.seed = 16});
    problem.q[3] = bad;
    EXPECT_EQ(solve(problem, settings()).status, Status::kInvalidInput);
  }
}

TEST_P(SweepSolvers, ConesAreRefused) {
  Problem problem = sweep_problem({.bodies = 3, .rows = 3, .seed = 17});
  problem.cones.push_back({.normal_row = 0, .dimension = 3, .coefficient = 0.5});
  EXPECT_NE(GetParam().make(settings())->refuses(problem).find("cones"), std::string::npos);
}

/// In units 2^300 and more away, float still has the range.
TEST_P(SweepSolvers, FarUnitsAreNoTroubleInFloat) {
  Problem problem = sweep_problem({.seed = 18});
  const Result plain = solve(problem, settings(Precision::kFloat));
  problem.q *= 0x1p-400;
  const Result scaled = solve(problem, settings(Precision::kFloat));
  EXPECT_EQ(plain.status, Status::kSolved);
  EXPECT_EQ(scaled.status, Status::kSolved);
  EXPECT_GT(scaled.z.cwiseAbs().maxCoeff(), 0.0);
}

TEST(SweepSettings, OutOfRangeAreNamed) {
  const auto message = [](auto solver_of, auto settings) -> std::string {
    try {
      solver_of(settings);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const double relaxation : {0.0, 2.0, -1.0, kNaN}) {
    PsorSettings psor;
    psor.relaxation = relaxation;
    EXPECT_NE(message([](const auto& s) { Psor{s}; }, psor).find("relaxation: must be in (0, 2)"),
              std::string::npos);
    SymmetricPgsSettings symmetric;
    symmetric.relaxation = relaxation;
    EXPECT_NE(message([](const auto& s) { SymmetricPgs{s}; }, symmetric)
                  .find("relaxation: must be in (0, 2)"),
              std::string::npos);
  }
  NncgSettings nncg;
  nncg.check_period = 0;
  EXPECT_NE(message([](const auto& s) { Nncg{s}; }, nncg).find("check_period: must be >= 1, got 0"),
            std::string::npos);
  nncg = {};
  nncg.threads = 0;
  EXPECT_NE(message([](const auto& s) { Nncg{s}; }, nncg).find("threads: must be >= 1, got 0"),
            std::string::npos);
}

TEST(SweepSolversByName, AreTheirSettings) {
  const Problem problem = sweep_problem({.seed = 19});
  for (const std::string name : {"pgs", "pgs-float", "symmetric-pgs", "symmetric-pgs-float", "psor",
                                 "psor-float", "nncg", "nncg-float"}) {
    SolverSettings settings;
    settings.tolerance = 1e-3;
    const auto solver = make_solver(name, settings);
    EXPECT_EQ(solver->name(), name);
    Result result;
    solver->solve(problem, result);
    EXPECT_EQ(result.status, Status::kSolved) << name;
    EXPECT_EQ(result.solver, name);
  }
}

}  // namespace
}  // namespace signorini::lcp
