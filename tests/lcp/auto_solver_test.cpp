#include <signorini/lcp/auto_solver.h>

#include "allocation_count.h"
#include "bench/contact_families.h"
#include "definition_residual.h"
#include "family_with_friction.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Result solve(const Problem& problem, const AutoSettings& settings = {}) {
  Result result;
  AutoSolver(settings).solve(problem, result);
  return result;
}

Problem lcp(const Matrix& M, const Vector& q) {
  Problem problem;
  problem.M = M;
  problem.q = q;
  return problem;
}

Problem family(std::string_view name, int size, double mass_ratio = 1.0) {
  return bench::make_family({.family = name, .size = size, .mass_ratio = mass_ratio});
}

TEST(AutoSolver, SolvesASmallSymmetricProblemWithDantzigAlone) {
  const Result result = solve(lcp(Matrix{{2, 1}, {1, 2}}, Vector{{-3, -3}}));
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.solver, "auto: dantzig");
  ASSERT_EQ(result.attempts.size(), 1U);
  EXPECT_EQ(result.attempts[0].solver, "dantzig");
  EXPECT_EQ(result.attempts[0].reason, "symmetric and small");
  EXPECT_EQ(result.attempts[0].status, Status::kSolved);
  EXPECT_EQ(result.w, Vector::Zero(2));
}

TEST(AutoSolver, TakesMiddlingFactoredProblemsFromTheInsideUnlessItHasAStart) {
  const Result small = solve(family("tower4", 12));
  EXPECT_EQ(small.solver, "auto: dantzig");
  const Problem problem = family("tower4", 16);
  ASSERT_EQ(problem.size(), 64);
  const Result cold = solve(problem);
  EXPECT_EQ(cold.status, Status::kSolved);
  EXPECT_EQ(cold.solver, "auto: interior-point");
  Result warm;
  AutoSolver().solve(problem, warm, &cold.z);
  EXPECT_EQ(warm.status, Status::kSolved);
  EXPECT_EQ(warm.solver, "auto: dantzig");
  // A row of zeros whose w is -1 whatever z: dantzig, behind it, proves that there is no answer.
  Problem impossible = problem;
  std::get<FactoredMatrix>(impossible.M).add_row();
  impossible.q.conservativeResize(65);
  impossible.q[64] = -1.0;
  EXPECT_EQ(solve(impossible).status, Status::kInfeasible);
}

TEST(AutoSolver, CertificateIsThatOfItsZ) {
  for (const auto& [name, size] : {std::pair{"tower4", 8}, {"spheres", 40}, {"spheres", 64}}) {
    const Problem problem = family(name, size);
    const Result result = solve(problem);  // the last by one that hands over its own
    EXPECT_EQ(result.solver == "auto: structured-lemke", size == 64);
    Vector w;
    const Certificate again = certify(problem, result.z, &w);
    EXPECT_EQ(result.certificate.unit_free_residual, again.unit_free_residual);
    EXPECT_EQ(result.certificate.natural_residual, again.natural_residual);
    EXPECT_EQ(result.certificate.rounding_floor, again.rounding_floor);
    EXPECT_EQ(result.certificate.backward_error, again.backward_error);
    EXPECT_EQ(result.w, w);
    const Result quick = solve(problem, {{.tolerance = 1e-8, .quick_certificate = true}});
    const Certificate bound = Certifier().certify_quickly(problem, quick.z, 1e-8, &w);
    EXPECT_EQ(quick.status, Status::kSolved);
    EXPECT_EQ(quick.certificate.unit_free_residual, bound.unit_free_residual);
    EXPECT_EQ(quick.certificate.rounding_floor, bound.rounding_floor);
    EXPECT_TRUE(std::isnan(quick.certificate.backward_error));
    EXPECT_EQ(quick.w, w);
  }
}

TEST(AutoSolver, SolvesLargeFactoredProblems) {
  for (const double R : {1.0, 1e6}) {
    for (const char* name : {"tower4", "pyramid2d", "pyramid3d", "spheres"}) {
      const int size = name == std::string_view("tower4")      ? 60
                       : name == std::string_view("pyramid2d") ? 8
                       : name == std::string_view("pyramid3d") ? 5
                                                               : 300;
      const Result result = solve(family(name, size, R));
      EXPECT_TRUE(is_solved(result.status)) << name << ' ' << R << ' ' << to_string(result.status);
      EXPECT_FALSE(result.attempts.empty());
    }
  }
}

TEST(AutoSolver, SweepsAloneWhereTheyWin) {
  AutoSettings settings;
  settings.tolerance = 1e-3;
  const Result result = solve(family("pyramid3d", 5), settings);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.solver, "auto: nncg");
  EXPECT_EQ(result.statistics.factorizations, -1);
}

TEST(AutoSolver, DoesNotSweepWhereMassesDiffer) {
  const Result result = solve(family("tower4", 60, 1e6));
  EXPECT_EQ(result.attempts.front().solver, "interior-point");
}

TEST(AutoSolver, PivotsFromAGuessWhereAPairOfBodiesHasOneContact) {
  for (const int contacts : {49, 64, 160}) {
    const Result result = solve(family("spheres", contacts));
    EXPECT_EQ(result.status, Status::kSolved);
    EXPECT_EQ(result.solver, "auto: structured-lemke");
    EXPECT_EQ(result.attempts.front().reason, "one contact a pair of bodies");
    EXPECT_LE(result.statistics.pivots, 2 * contacts);
  }
  EXPECT_NE(solve(family("spheres", 48)).solver, "auto: structured-lemke");
  EXPECT_NE(solve(family("spheres", 181)).solver, "auto: structured-lemke");
  EXPECT_NE(solve(family("tower4", 16)).solver, "auto: structured-lemke");
}

TEST(AutoSolver, PivotsOnSmallPilesWhoseMassesDiffer) {
  for (const double ratio : {1e3, 1e6}) {
    const Problem problem = family("pyramid2d", 4, ratio);
    ASSERT_EQ(problem.size(), 64);
    const Result result = solve(problem);
    EXPECT_EQ(result.status, Status::kSolved);
    EXPECT_EQ(result.solver, "auto: dantzig");
  }
  EXPECT_EQ(solve(family("pyramid2d", 4)).solver, "auto: interior-point");
  EXPECT_EQ(solve(family("pyramid2d", 5, 1e3)).solver, "auto: interior-point");
  EXPECT_EQ(solve(family("tower4", 16, 1e3)).solver, "auto: interior-point");
}

TEST(AutoSolver, StatisticsAreSumsOverTheAttempts) {
  AutoSettings settings;
  settings.tolerance = 1e-5;
  const Result result = solve(family("tower4", 60), settings);
  ASSERT_GE(result.attempts.size(), 2U);
  int iterations = 0;
  for (const Attempt& attempt : result.attempts) {
    iterations += std::max(attempt.statistics.iterations, 0);
  }
  EXPECT_EQ(result.statistics.iterations, iterations);
}

/// G G^T + skew K for G of random numbers, n x freedom, and a q that bodies' motion gives.
Problem given_whole(int n, int freedom, double skew, double noise) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Matrix G(n, freedom);
  for (double& value : G.reshaped()) value = normal(random);
  Vector v(freedom);
  for (double& value : v) value = normal(random);
  Matrix M = G * G.transpose();
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < j; ++i) {
      const double entry = skew * normal(random);
      M(i, j) += entry;
      M(j, i) -= entry;
      M(i, j) *= 1.0 + noise * normal(random);  // as from a file with few digits
    }
  }
  return lcp(M, G * v);
}

TEST(AutoSolver, GoesByTheSymmetryOfAMatrixGivenWhole) {
  const Result symmetric = solve(given_whole(150, 160, 0.0, 0.0));
  EXPECT_EQ(symmetric.status, Status::kSolved);
  EXPECT_EQ(symmetric.solver, "auto: block-pivoting");
  EXPECT_EQ(solve(given_whole(150, 300, 0.0, 1e-4)).solver, "auto: block-pivoting");
  EXPECT_EQ(solve(given_whole(20, 40, 0.0, 1e-4)).solver, "auto: dantzig");
  for (const int n : {20, 150}) {
    const Result skew = solve(given_whole(n, 2 * n, 1.0, 0.0));
    EXPECT_EQ(skew.status, Status::kSolved);
    EXPECT_EQ(skew.solver, "auto: interior-point");
  }
}

TEST(AutoSolver, TakesLargeAssociatedConesAsTheConvexProgramTheyAre) {
  Problem problem = given_whole(150, 160, 0.0, 0.0);
  for (int row = 0; row < 150; row += 3) problem.cones.push_back({row, 3, 0.5});
  const Result coulomb = solve(problem);
  EXPECT_EQ(coulomb.status, Status::kSolved);
  EXPECT_EQ(coulomb.attempts[0].solver, "alart-curnier");
  problem.friction_law = FrictionLaw::kAssociated;
  const Result associated = solve(problem);
  EXPECT_EQ(associated.status, Status::kSolved);
  EXPECT_EQ(associated.solver, "auto: cone-interior-point");
}

/// The solvers tried for a pile that slides with Coulomb's cones, none of them allowed to get far.
std::vector<std::string> tried_for_cones(Problem problem, const AutoSettings& settings,
                                         const Vector* start = nullptr) {
  Result result;
  AutoSolver(settings).solve(problem, result, start);
  std::vector<std::string> names;
  for (const Attempt& attempt : result.attempts) {
    names.emplace_back(attempt.solver);
  }
  return names;
}

TEST(AutoSolver, TriesASmoothPathForCones) {
  using Names = std::vector<std::string>;
  Problem problem = family_with_friction({.family = "spheres", .size = 40}, 0.4);
  const AutoSettings few{{.max_iterations = 2}};
  const Vector zero = Vector::Zero(problem.size());
  EXPECT_EQ(tried_for_cones(problem, few), (Names{"cone-interior-point", "frictionless",
                                                  "cone-smoothing", "alart-curnier", "nsgs"}));
  EXPECT_EQ(tried_for_cones(problem, few, &zero),
            (Names{"sticking", "alart-curnier", "cone-smoothing", "frictionless", "nsgs"}));
  problem.M = to_dense(problem.M);
  EXPECT_EQ(tried_for_cones(problem, few),
            (Names{"alart-curnier", "cone-smoothing", "frictionless", "nsgs"}));
}

/// alart-curnier takes more than 1000 steps for it.
TEST(AutoSolver, SolvesAPileThatSlidesByTheSmoothPath) {
  const Problem problem =
      family_with_friction({.family = "spheres", .size = 200, .mass_ratio = 1e3}, 0.8);
  Result result;
  AutoSolver().solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.solver, "auto: cone-smoothing");
  EXPECT_LE(result.statistics.factorizations, 300);
}

TEST(AutoSolver, TakesConesFreeRowsBoundsAndCoupledLimits) {
  Problem problem = lcp(2.0 * Matrix::Identity(3, 3), Vector{{-4, 3, 4}});
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 0.5}};
  const Result cone = solve(problem);
  EXPECT_EQ(cone.status, Status::kSolved);
  EXPECT_EQ(cone.solver, "auto: alart-curnier");

  problem.cones.clear();
  problem.limits = {{.row = 1, .normal_row = 0, .coefficient = 0.5}};
  problem.lower = Vector{{0, 0, -kInfinity}};
  const Result limits = solve(problem);
  EXPECT_EQ(limits.status, Status::kSolved);
  EXPECT_LE(definition_residual(problem, limits.z), 1e-8);
  EXPECT_NEAR(limits.z[1], -1.0, 1e-8);
  EXPECT_NEAR(limits.z[2], -2.0, 1e-8);
}

TEST(AutoSolver, ProvesWhatIsInfeasible) {
  const Result result = solve(lcp(Matrix{{1, -1}, {-1, 1}}, Vector{{-1, -1}}));
  EXPECT_EQ(result.status, Status::kInfeasible);
  EXPECT_EQ(result.ray.size(), 2);
  EXPECT_EQ(result.ray_bound, kInfinity);
}

// w = -1 - z has a ray for every method that follows one and no solution.
/// A ball between closing walls whose normals are opposite but for rounding, in the plane.
TEST(AutoSolver, ProvesThatFrictionDoesNotHelpASqueezedBallBeforeItIterates) {
  for (const double slant : {0.0, 0x1p-50}) {
    FactoredMatrix A;
    const int ball = A.mass.add_mass(Matrix::Identity(2, 2));
    for (const Vector& axis :
         {Vector{{1.0, 0.0}}, Vector{{0.0, 1.0}}, Vector{{-1.0, slant}}, Vector{{slant, 1.0}}}) {
      A.add_row();
      A.add_entry(ball, axis);
    }
    Problem problem;
    problem.M = A;
    problem.q = Vector{{-1.0, 2.0, -1.0, 2.0}};
    problem.cones = {{0, 2, 0.5}, {2, 2, 0.5}};
    Result result;
    AutoSolver().solve(problem, result);
    EXPECT_EQ(result.status, slant == 0.0 ? Status::kInfeasible : Status::kNoSolutionBelow);
    EXPECT_GT(result.ray_bound, 1e14);
    ASSERT_FALSE(result.attempts.empty());
    EXPECT_EQ(result.attempts.back().solver, "frictionless");
    EXPECT_LE(result.attempts.size(), 2);
    EXPECT_EQ(result.detail.empty(), slant == 0.0);  // what was passed over is said
  }
}

TEST(AutoSolver, TriesEverySolverBeforeItGivesUp) {
  const Result result = solve(lcp(Matrix{{0, -1}, {-2, 0}}, Vector{{-1, -1}}));
  EXPECT_FALSE(is_solved(result.status));
  EXPECT_GE(result.attempts.size(), 2U);
  EXPECT_TRUE(result.z.allFinite());
}

TEST(AutoSolver, GivesTheSameBitsAgain) {
  const Problem problem = family("spheres", 300);
  AutoSolver solver;
  Result result;
  solver.solve(problem, result);
  const Vector first = result.z;
  solver.solve(family("tower4", 60), result);
  solver.solve(problem, result);
  EXPECT_EQ(result.z, first);
}

TEST(AutoSolver, StopsAtItsTimeLimit) {
  AutoSettings settings;
  settings.time_limit = 1e-9;
  const Result result = solve(family("spheres", 300), settings);
  EXPECT_EQ(result.status, Status::kTimeLimit);
  EXPECT_TRUE(result.z.allFinite());
}

TEST(AutoSolver, EndsWhereWhatItIsAPartOfHasNoTimeLeft) {
  const Problem problem = family("spheres", 300);
  AutoSolver solver;
  Result result;
  for (const double seconds : {0.0, -1.0, 1e-9}) {
    solver.solve_within(seconds, problem, result);
    EXPECT_EQ(result.status, Status::kTimeLimit) << seconds;
    EXPECT_TRUE(result.z.allFinite());
  }
  solver.solve_within(1e6, problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  solver.solve_within(std::numeric_limits<double>::infinity(), problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  AutoSettings settings;
  settings.time_limit = 1e-9;
  AutoSolver(settings).solve_within(1e6, problem, result);
  EXPECT_EQ(result.status, Status::kTimeLimit);
}

/// What a solve as a part of another is told, so that it can be replayed.
TEST(AutoSolver, RecordsTheTimeThatItHad) {
  struct : SolveRecorder {
    std::string record(const SolveRecord& solve) override {
      time_limit = solve.settings.time_limit;
      return {};
    }
    double time_limit = 0.0;
  } recorder;
  AutoSettings settings;
  settings.recorder = &recorder;
  settings.time_limit = 50.0;
  AutoSolver solver(settings);
  Result result;
  for (const auto& [seconds, recorded] : {std::pair{1e6, 50.0}, {20.0, 20.0}}) {
    solver.solve_within(seconds, family("tower4", 3), result);
    EXPECT_EQ(recorder.time_limit, recorded);
  }
  solver.solve_within(-1.0, family("tower4", 3), result);
  EXPECT_GT(recorder.time_limit, 0.0);
  EXPECT_LT(recorder.time_limit, 1e-300);
}

TEST(AutoSolver, TakesNoRowsAndRefusesNaN) {
  EXPECT_EQ(solve(lcp(Matrix(0, 0), Vector(0))).status, Status::kSolved);
  EXPECT_EQ(solve(lcp(Matrix{{std::nan("")}}, Vector{{1}})).status, Status::kInvalidInput);
}

/// What was solved before must not show in the answer to no rows, which runs no iteration.
TEST(EverySolver, AnswersNoRowsAfterAProblem) {
  const Problem before = family("tower4", 3);
  Problem none;
  none.M = FactoredMatrix();
  none.q = Vector(0);
  for (const std::string_view name : solver_names()) {
    const std::unique_ptr<Solver> solver = make_solver(name);
    Result result;
    if (solver->refuses(before).empty()) {
      solver->solve(before, result);
    }
    ASSERT_EQ(solver->refuses(none), "") << name;
    solver->solve(none, result);
    EXPECT_EQ(result.status, Status::kSolved) << name;
    EXPECT_EQ(result.z.size(), 0) << name;
    EXPECT_EQ(result.w.size(), 0) << name;
    EXPECT_EQ(result.certificate.worst_row, -1) << name;
    EXPECT_EQ(result.attempts.size(), 0U) << name;
  }
}

// Murty, Linear Complementarity (1988), section 6.2, and Fathi's symmetric form: 2^n - 1 pivots of
// the textbook methods.
TEST(AutoSolver, IsNotExponentialOnMurtysAndFathisExamples) {
  for (const int n : {4, 12, 20}) {
    Matrix murty = Matrix::Identity(n, n);
    Vector powers(n);
    double sum = 0.0;
    for (int i = n - 1; i >= 0; --i) {
      murty.row(i).tail(n - i - 1).setConstant(2.0);
      sum += std::ldexp(1.0, n - 1 - i);
      powers[i] = -sum;
    }
    for (const Matrix& M : {murty, Matrix(murty * murty.transpose())}) {
      for (const Vector& q : {powers, Vector(-Vector::Ones(n))}) {
        const Result result = solve(lcp(M, q));
        EXPECT_EQ(result.status, Status::kSolved) << n;
        EXPECT_LE(std::max(result.statistics.pivots, 0), 3 * n);
        EXPECT_LE(std::max(result.statistics.factorizations, 0), 3 * n);
      }
    }
  }
}

TEST(AutoSolver, AllocatesNothingTheSecondTimeOnSmallProblems) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Matrix G(16, 10);
  for (double& value : G.reshaped()) value = normal(random);
  Vector v(10);
  for (double& value : v) value = normal(random);
  const Problem random_psd = lcp(Matrix(G * G.transpose()), G * v);
  const Problem contacts = family("pyramid2d", 8);  // the interior point, whose start keeps sweeps
  for (const double seconds : {1e6, std::numeric_limits<double>::infinity()}) {
    for (const Problem& problem : {random_psd, contacts, family("spheres", 64)}) {
      AutoSettings settings;
      settings.time_limit = seconds;
      AutoSolver solver(settings);
      Result result;
      solver.solve(problem, result);
      ASSERT_EQ(result.status, Status::kSolved);
      const AllocationCount allocations;
      solver.solve(problem, result);
      EXPECT_EQ(allocations.count(), 0) << result.solver << ", at most " << seconds << " s";
    }
  }
}

}  // namespace
}  // namespace signorini::lcp
