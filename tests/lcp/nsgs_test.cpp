#include <signorini/lcp/nsgs.h>

#include "allocation_count.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace signorini::lcp {
namespace {

Result solve(const Problem& problem, const NsgsSettings& settings = {},
             const Vector* warm_start = nullptr) {
  Result result;
  Nsgs(settings).solve(problem, result, warm_start);
  return result;
}

Problem one_contact(const Vector& q, double mu) {
  Problem problem;
  problem.M = Matrix(2.0 * Matrix::Identity(q.size(), q.size()));
  problem.q = q;
  problem.cones = {{.normal_row = 0, .dimension = static_cast<int>(q.size()), .coefficient = mu}};
  return problem;
}

/// Contacts of one body of six freedoms and the ground: redundant from the third on.
Problem contacts(unsigned seed, int count) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(6, 6));
  A.mass.add_inverse(2.0 * Matrix::Identity(6, 6));
  Problem problem;
  for (int c = 0; c < count; ++c) {
    problem.cones.push_back({A.rows(), 3, 0.3});
    for (int k = 0; k < 3; ++k) {
      A.add_row();
      for (int body = 0; body < 2; ++body) {
        Vector values(6);
        for (double& value : values) value = normal(random);
        A.add_entry(body, values);
      }
    }
  }
  Vector v(12);
  for (double& value : v) value = normal(random);
  problem.q.setZero(A.rows());
  for (int i = 0; i < A.rows(); ++i) {
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      for (int k = 0; k < 6; ++k) problem.q[i] += A.values(entry)[k] * v[6 * entry.block + k];
    }
  }
  problem.M = A;
  return problem;
}

TEST(Nsgs, SeparatesSticksAndSlides) {
  EXPECT_EQ(solve(one_contact(Vector{{1, 5, 5}}, 0.5)).z, Vector::Zero(3));
  EXPECT_LE((solve(one_contact(Vector{{-4, 1, 1}}, 1.0)).z - Vector{{2, -0.5, -0.5}}).norm(), 1e-8);
  const Result slides = solve(one_contact(Vector{{-4, 3, 4}}, 0.5));
  EXPECT_EQ(slides.status, Status::kSolved);
  EXPECT_LE((slides.z - Vector{{2, -0.6, -0.8}}).norm(), 1e-7);
  EXPECT_LE((solve(one_contact(Vector{{-4, 5}}, 0.5)).z - Vector{{2, -1}}).norm(), 1e-7);
  Problem associated = one_contact(Vector{{-4, 3, 4}}, 0.5);
  associated.friction_law = FrictionLaw::kAssociated;
  EXPECT_LE((solve(associated).z - Vector{{2.6, -0.78, -1.04}}).norm(), 1e-7);
}

TEST(Nsgs, SolvesFactoredSparseAndDenseAlike) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Problem problem = contacts(seed, 3);
    NsgsSettings settings;
    settings.tolerance = 1e-6;
    const Result factored = solve(problem, settings);
    const SparseMatrix formed = std::get<FactoredMatrix>(problem.M).form();
    problem.M = formed;
    const Result sparse = solve(problem, settings);
    problem.M = Matrix(formed);
    const Result dense = solve(problem, settings);
    EXPECT_EQ(factored.status, Status::kSolved) << seed;
    EXPECT_EQ(sparse.status, Status::kSolved) << seed;
    EXPECT_EQ(dense.z, sparse.z);
    EXPECT_LE((factored.w - sparse.w).norm(), 1e-3 * (1.0 + factored.w.norm()));
  }
}

TEST(Nsgs, TakesBoundsAndFreeRowsAndRefusesCoupledLimits) {
  Problem problem;
  problem.M = Matrix{{2, 1}, {1, 2}};
  problem.q = Vector{{-9, 1}};
  problem.lower = Vector{{0, -std::numeric_limits<double>::infinity()}};
  problem.upper = Vector{{1, std::numeric_limits<double>::infinity()}};
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_NEAR(result.z[0], 1.0, 1e-8);
  EXPECT_NEAR(result.z[1], -1.0, 1e-7);
  problem.limits = {{.row = 1, .normal_row = 0, .coefficient = 0.5}};
  EXPECT_NE(Nsgs().refuses(problem), "");
}

TEST(Nsgs, EndsAtItsLimitsAndStallsOnlyWhereNothingMoves) {
  NsgsSettings settings;
  settings.max_iterations = 2;
  settings.tolerance = 1e-12;
  EXPECT_EQ(solve(contacts(1, 6), settings).status, Status::kIterationLimit);
  settings.max_iterations = -1;
  settings.time_limit = 1e-9;
  EXPECT_EQ(solve(contacts(1, 6), settings).status, Status::kTimeLimit);
  Problem impossible;  // w = -1 whatever z
  impossible.M = Matrix{{1, -1}, {-1, 1}};
  impossible.q = Vector{{-1, -1}};
  EXPECT_FALSE(is_solved(solve(impossible).status));
}

TEST(Nsgs, StartsWarmTakesNoRowsAndRefusesNaN) {
  NsgsSettings settings;
  settings.tolerance = 1e-6;
  const Problem problem = contacts(2, 3);
  const Result cold = solve(problem, settings);
  ASSERT_EQ(cold.status, Status::kSolved);
  EXPECT_EQ(solve(problem, settings, &cold.z).statistics.iterations, 0);
  Problem none;
  none.M = Matrix(0, 0);
  none.q = Vector(0);
  EXPECT_EQ(solve(none).status, Status::kSolved);
  Problem bad = contacts(2, 3);
  bad.q[0] = std::nan("");
  EXPECT_EQ(solve(bad).status, Status::kInvalidInput);
}

TEST(Nsgs, RefusesSettingsOutOfRange) {
  NsgsSettings settings;
  settings.check_period = 0;
  EXPECT_THROW(Nsgs{settings}, std::invalid_argument);
  settings = {};
  settings.local_iterations = 0;
  EXPECT_THROW(Nsgs{settings}, std::invalid_argument);
}

TEST(Nsgs, AllocatesNothingTheSecondTime) {
  Problem problem = contacts(3, 5);
  const FactoredMatrix A = std::get<FactoredMatrix>(problem.M);
  for (const MatrixForm& M : {MatrixForm(A), MatrixForm(A.form()), MatrixForm(Matrix(A.form()))}) {
    problem.M = M;
    Nsgs solver;
    Result result;
    solver.solve(problem, result);
    ASSERT_EQ(result.status, Status::kSolved);
    problem.q *= 1.5;  // another problem of the same size
    const AllocationCount allocations;
    solver.solve(problem, result);
    EXPECT_EQ(allocations.count(), 0) << M.index();
    EXPECT_EQ(allocations.back_end_count(), 0);
  }
}

}  // namespace
}  // namespace signorini::lcp
