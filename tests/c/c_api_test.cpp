#include <signorini/c/signorini.h>

#include "c_testing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

using signorini::testing_tools::expect_refused;
using signorini::testing_tools::kHuge;
using signorini::testing_tools::kInfinity;
using signorini::testing_tools::kNaN;

struct Destroy {
  void operator()(signorini_problem* p) const { signorini_problem_destroy(p); }
  void operator()(signorini_solver* p) const { signorini_solver_destroy(p); }
  void operator()(signorini_result* p) const { signorini_result_destroy(p); }
};
using Problem = std::unique_ptr<signorini_problem, Destroy>;
using Solver = std::unique_ptr<signorini_solver, Destroy>;
using Result = std::unique_ptr<signorini_result, Destroy>;

Problem make_problem() {
  signorini_problem* made = nullptr;
  EXPECT_EQ(signorini_problem_create(&made), SIGNORINI_OK);
  return Problem(made);
}

Solver make_solver(const char* name) {
  signorini_solver* made = nullptr;
  EXPECT_EQ(signorini_solver_create(name, &made), SIGNORINI_OK) << signorini_last_error();
  return Solver(made);
}

Result make_result() {
  signorini_result* made = nullptr;
  EXPECT_EQ(signorini_result_create(&made), SIGNORINI_OK);
  return Result(made);
}

const double kM[] = {2.0, 1.0, 1.0, 2.0};
const double kQ[] = {-5.0, -6.0};

/// w = M z + q with M = [2 1; 1 2], q = (-5, -6): z = (4/3, 7/3).
Problem small_problem() {
  Problem problem = make_problem();
  EXPECT_EQ(signorini_problem_set_dense(problem.get(), 2, SIGNORINI_COLUMN_MAJOR, kM, kQ),
            SIGNORINI_OK);
  return problem;
}

std::vector<double> solve(const signorini_problem* problem, const char* name = "auto") {
  const Solver solver = make_solver(name);
  const Result result = make_result();
  EXPECT_EQ(signorini_solver_solve(solver.get(), problem, nullptr, result.get()), SIGNORINI_OK)
      << signorini_last_error();
  EXPECT_TRUE(signorini_is_solved(signorini_result_status(result.get())))
      << signorini_result_detail(result.get());
  const double* z = signorini_result_z(result.get());
  return {z, z + signorini_result_size(result.get())};
}

void expect_small_answer(const std::vector<double>& z) {
  ASSERT_EQ(z.size(), 2u);
  EXPECT_NEAR(z[0], 4.0 / 3.0, 1e-9);
  EXPECT_NEAR(z[1], 7.0 / 3.0, 1e-9);
}

TEST(CApi, DenseSparseAndFactoredGiveTheSameAnswer) {
  expect_small_answer(solve(small_problem().get()));

  const Problem sparse = make_problem();
  const std::int32_t start[] = {0, 2, 4};
  const std::int32_t index[] = {1, 0, 0, 1};  // not sorted
  const double value[] = {1.0, 2.0, 1.0, 2.0};
  for (const signorini_order order : {SIGNORINI_COLUMN_MAJOR, SIGNORINI_ROW_MAJOR}) {
    ASSERT_EQ(signorini_problem_set_sparse(sparse.get(), 2, order, 4, start, index, value, kQ),
              SIGNORINI_OK);
    expect_small_answer(solve(sparse.get()));
  }

  // J = [1 1; 1 0], W = I, c = (0, 1): J J^T + diag(c) = [2 1; 1 2].
  const std::int32_t j_start[] = {0, 2, 3};
  const std::int32_t j_index[] = {0, 1, 0};
  const double j_value[] = {1.0, 1.0, 1.0};
  const double compliance[] = {0.0, 1.0};
  const double identity[] = {1.0, 0.0, 0.0, 1.0};
  const std::int32_t one_block[] = {2};
  const std::int32_t two_blocks[] = {1, 1};
  for (const signorini_mass_kind kind : {SIGNORINI_INVERSE_MASS, SIGNORINI_MASS}) {
    ASSERT_EQ(signorini_problem_set_factored(sparse.get(), 2, 3, j_start, j_index, j_value, 1,
                                             one_block, kind, identity, compliance, kQ),
              SIGNORINI_OK);
    expect_small_answer(solve(sparse.get()));
    const double ones[] = {1.0, 1.0};
    ASSERT_EQ(signorini_problem_set_factored(sparse.get(), 2, 3, j_start, j_index, j_value, 2,
                                             two_blocks, kind, ones, compliance, kQ),
              SIGNORINI_OK);
    expect_small_answer(solve(sparse.get(), "interior-point"));
  }
}

TEST(CApi, OrderMattersForNonsymmetricM) {
  // M = [1 2; 0 1], q = (-4, -1): z_2 = 1, z_1 = 2. M^T: z_1 = 4, w_2 = 7, z_2 = 0.
  const double by_rows[] = {1.0, 2.0, 0.0, 1.0};
  const double q[] = {-4.0, -1.0};
  const Problem problem = make_problem();
  ASSERT_EQ(signorini_problem_set_dense(problem.get(), 2, SIGNORINI_ROW_MAJOR, by_rows, q), 0);
  EXPECT_NEAR(solve(problem.get(), "lemke")[1], 1.0, 1e-12);
  ASSERT_EQ(signorini_problem_set_dense(problem.get(), 2, SIGNORINI_COLUMN_MAJOR, by_rows, q), 0);
  EXPECT_NEAR(solve(problem.get(), "lemke")[1], 0.0, 1e-12);
  const std::int32_t start[] = {0, 2, 3};
  const std::int32_t index[] = {0, 1, 1};
  const double value[] = {1.0, 2.0, 1.0};
  ASSERT_EQ(signorini_problem_set_sparse(problem.get(), 2, SIGNORINI_ROW_MAJOR, 3, start, index,
                                         value, q),
            0);
  EXPECT_NEAR(solve(problem.get(), "lemke")[1], 1.0, 1e-12);
  ASSERT_EQ(signorini_problem_set_sparse(problem.get(), 2, SIGNORINI_COLUMN_MAJOR, 3, start, index,
                                         value, q),
            0);
  EXPECT_NEAR(solve(problem.get(), "lemke")[1], 0.0, 1e-12);
}

TEST(CApi, BoundsLimitsAndCones) {
  const double identity[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const double q[] = {-2.0, -5.0, 0.0};
  const Problem problem = make_problem();
  const auto reset = [&] {
    ASSERT_EQ(signorini_problem_set_dense(problem.get(), 3, SIGNORINI_ROW_MAJOR, identity, q), 0);
  };
  reset();
  const double lower[] = {0.0, -kInfinity, -1.0};
  const double upper[] = {0.5, kInfinity, 1.0};
  ASSERT_EQ(signorini_problem_set_bounds(problem.get(), 3, lower, upper), 0);
  EXPECT_EQ(solve(problem.get()), (std::vector<double>{0.5, 5.0, 0.0}));
  ASSERT_EQ(signorini_problem_set_bounds(problem.get(), 3, nullptr, nullptr), 0);
  EXPECT_EQ(solve(problem.get()), (std::vector<double>{2.0, 5.0, 0.0}));

  const std::int32_t row[] = {1, 2};
  const std::int32_t normal[] = {0, 0};
  const double mu[] = {0.5, 0.5};
  ASSERT_EQ(signorini_problem_set_limits(problem.get(), 2, row, normal, mu), 0);
  EXPECT_NEAR(solve(problem.get())[1], 1.0, 1e-9);

  reset();  // forgets the limits; Coulomb slides with z_T = mu z_N
  const std::int32_t cone_row[] = {0};
  const std::int32_t dimension[] = {3};
  ASSERT_EQ(
      signorini_problem_set_cones(problem.get(), 1, cone_row, dimension, mu, SIGNORINI_COULOMB), 0);
  std::vector<double> z = solve(problem.get());
  EXPECT_NEAR(z[0], 2.0, 1e-7);
  EXPECT_NEAR(z[1], 1.0, 1e-7);
  ASSERT_EQ(
      signorini_problem_set_cones(problem.get(), 1, cone_row, dimension, mu, SIGNORINI_ASSOCIATED),
      0);
  z = solve(problem.get());
  EXPECT_NEAR(z[1], 0.5 * z[0], 1e-7);
  EXPECT_GT(z[0], 2.0 + 1e-3);  // it separates: w_N = mu |w_T|
}

TEST(CApi, ResultSaysEverything) {
  const Problem problem = small_problem();
  const Solver solver = make_solver("auto");
  const Result result = make_result();
  EXPECT_EQ(signorini_result_status(result.get()), SIGNORINI_NOT_RUN);
  EXPECT_EQ(signorini_result_size(result.get()), 0);
  ASSERT_EQ(signorini_solver_set_number(solver.get(), "certify_islands", 1), 0);
  const double start[] = {1.0, 2.0};
  ASSERT_EQ(signorini_solver_solve(solver.get(), problem.get(), start, result.get()), 0);
  EXPECT_EQ(signorini_result_status(result.get()), SIGNORINI_SOLVED);
  EXPECT_STREQ(signorini_status_text(SIGNORINI_SOLVED), "solved");
  EXPECT_EQ(std::string(signorini_result_solver(result.get())).rfind("auto: ", 0), 0u);
  EXPECT_STREQ(signorini_result_detail(result.get()), "");
  EXPECT_NEAR(signorini_result_w(result.get())[0], 0.0, 1e-12);
  EXPECT_EQ(signorini_result_ray(result.get()), nullptr);
  EXPECT_EQ(signorini_result_ray_bound(result.get()), 0.0);
  signorini_certificate certificate{};
  ASSERT_EQ(signorini_result_certificate(result.get(), &certificate, sizeof certificate), 0);
  EXPECT_LE(certificate.unit_free_residual, 1e-8);
  EXPECT_NEAR(certificate.min_z, 4.0 / 3.0, 1e-9);
  signorini_statistics statistics{};
  ASSERT_EQ(signorini_result_statistics(result.get(), &statistics, sizeof statistics), 0);
  EXPECT_GE(statistics.solve_seconds, 0.0);
  ASSERT_EQ(signorini_result_attempt_count(result.get()), 1);
  signorini_attempt attempt{};
  ASSERT_EQ(signorini_result_attempt(result.get(), 0, &attempt, sizeof attempt), 0);
  EXPECT_EQ(attempt.status, SIGNORINI_SOLVED);
  EXPECT_EQ("auto: " + std::string(attempt.solver), signorini_result_solver(result.get()));
  EXPECT_NE(std::string(attempt.reason), "");
  expect_refused(signorini_result_attempt(result.get(), 1, &attempt, sizeof attempt), "number");
  ASSERT_EQ(signorini_result_island_count(result.get()), 1);
  EXPECT_EQ(signorini_result_island_of_row(result.get())[1], 0);
  ASSERT_EQ(signorini_result_island_certificate(result.get(), 0, &certificate, sizeof certificate),
            0);
  expect_refused(
      signorini_result_island_certificate(result.get(), -1, &certificate, sizeof certificate),
      "island");
}

TEST(CApi, ASmallerStructIsFilledToItsSizeAlone) {
  const Result result = make_result();
  double numbers[sizeof(signorini_certificate) / sizeof(double)];
  std::fill(std::begin(numbers), std::end(numbers), 7.0);
  auto* room = reinterpret_cast<signorini_certificate*>(numbers);
  ASSERT_EQ(signorini_result_certificate(result.get(), room, 2 * sizeof(double)), 0);
  EXPECT_TRUE(std::isnan(numbers[1]));
  EXPECT_EQ(numbers[2], 7.0);
  expect_refused(signorini_result_certificate(result.get(), room, 0), "bytes");
  expect_refused(signorini_result_certificate(result.get(), room, 12), "bytes");
}

TEST(CApi, InfeasibleComesWithItsRay) {
  // w_2 = -1 whatever z is.
  const double M[] = {1.0, 0.0, 0.0, 0.0};
  const double q[] = {1.0, -1.0};
  const Problem problem = make_problem();
  ASSERT_EQ(signorini_problem_set_dense(problem.get(), 2, SIGNORINI_ROW_MAJOR, M, q), 0);
  const Solver solver = make_solver("lemke");
  const Result result = make_result();
  ASSERT_EQ(signorini_solver_solve(solver.get(), problem.get(), nullptr, result.get()), 0);
  EXPECT_EQ(signorini_result_status(result.get()), SIGNORINI_INFEASIBLE);
  ASSERT_NE(signorini_result_ray(result.get()), nullptr);
  EXPECT_GT(signorini_result_ray(result.get())[1], 0.0);
}

TEST(CApi, QAndMAreWrittenInPlace) {
  const Problem problem = small_problem();
  std::int64_t count = -1;
  double* M = signorini_problem_matrix(problem.get(), &count);
  ASSERT_EQ(count, 4);
  M[0] = 4.0;  // z = (4/7, 19/7)
  EXPECT_NEAR(solve(problem.get())[0], 4.0 / 7.0, 1e-9);
  signorini_problem_q(problem.get())[0] = 1.0;  // z = (0, 3)
  EXPECT_NEAR(solve(problem.get())[1], 3.0, 1e-9);
  EXPECT_EQ(signorini_problem_matrix(problem.get(), nullptr), M);
}

TEST(CApi, EverySolverIsMadeAndEverySettingIsReadAndRefused) {
  int count = 0;
  for (const char* const* name = signorini_solver_names(); *name != nullptr; ++name, ++count) {
    make_solver(*name);
  }
  EXPECT_GE(count, 18);
  const Solver solver = make_solver("pgs");
  ASSERT_EQ(signorini_solver_set_number(solver.get(), "max_iterations", 1), 0);
  ASSERT_EQ(signorini_solver_set_number(solver.get(), "tolerance", 1e-12), 0);
  ASSERT_EQ(signorini_solver_set_number(solver.get(), "time_limit", 100.0), 0);
  for (const auto& [name, value] : {std::pair{"tolerance", 0.0},
                                    {"tolerance", kNaN},
                                    {"max_iterations", 0.5},
                                    {"max_iterations", -2.0},
                                    {"max_iterations", 1e300},
                                    {"max_iterations", kNaN},
                                    {"time_limit", 0.0},
                                    {"certify_islands", 2.0},
                                    {"quick_certificate", kNaN}}) {
    expect_refused(signorini_solver_set_number(solver.get(), name, value), name);
  }
  expect_refused(signorini_solver_set_number(solver.get(), "tolerence", 1.0), "tolerence");
  expect_refused(signorini_solver_set_text(solver.get(), "dumb", ""), "dumb");
  expect_refused(signorini_solver_set_text(solver.get(), "dump", nullptr), "value");
  const Problem problem = small_problem();
  const Result result = make_result();
  ASSERT_EQ(signorini_solver_solve(solver.get(), problem.get(), nullptr, result.get()), 0);
  EXPECT_EQ(signorini_result_status(result.get()), SIGNORINI_ITERATION_LIMIT);  // as set
  signorini_solver* none = solver.get();
  expect_refused(signorini_solver_create("lemkee", &none), "lemkee");
  EXPECT_EQ(none, nullptr);
}

TEST(CApi, DumpWritesWhatCanBeReplayed) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "c_api_dump";
  std::filesystem::remove_all(folder);
  const Solver solver = make_solver("lemke");
  const signorini_error made =
      signorini_solver_set_text(solver.get(), "dump", folder.string().c_str());
  if (made != SIGNORINI_OK) {
    ASSERT_NE(std::string(signorini_last_error()).find("SIGNORINI_BUILD_IO"), std::string::npos);
    GTEST_SKIP() << signorini_last_error();
  }
  const Problem problem = small_problem();
  const Result result = make_result();
  ASSERT_EQ(signorini_solver_solve(solver.get(), problem.get(), nullptr, result.get()), 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "000001" / "W.mtx"));
  ASSERT_EQ(signorini_solver_set_text(solver.get(), "dump", ""), 0);
  ASSERT_EQ(signorini_solver_solve(solver.get(), problem.get(), nullptr, result.get()), 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "000002"));
  expect_refused(signorini_solver_set_text(solver.get(), "dump", "x:no"), "no");
}

TEST(CApi, NullEverywhereIsAnErrorOrNothing) {
  signorini_problem_destroy(nullptr);
  signorini_solver_destroy(nullptr);
  signorini_result_destroy(nullptr);
  expect_refused(signorini_problem_create(nullptr), "problem");
  expect_refused(signorini_problem_set_dense(nullptr, 0, SIGNORINI_ROW_MAJOR, nullptr, nullptr),
                 "problem");
  expect_refused(signorini_problem_set_bounds(nullptr, 0, nullptr, nullptr), "problem");
  expect_refused(signorini_problem_set_limits(nullptr, 0, nullptr, nullptr, nullptr), "problem");
  expect_refused(signorini_solver_create("lemke", nullptr), "solver");
  signorini_solver* solver = nullptr;
  expect_refused(signorini_solver_create(nullptr, &solver), "name");
  expect_refused(signorini_solver_set_number(nullptr, "tolerance", 1e-8), "solver");
  expect_refused(signorini_solver_solve(nullptr, nullptr, nullptr, nullptr), "solver");
  expect_refused(signorini_result_create(nullptr), "result");
  expect_refused(signorini_result_certificate(nullptr, nullptr, 0), "result");
  EXPECT_EQ(signorini_problem_size(nullptr), 0);
  EXPECT_EQ(signorini_problem_q(nullptr), nullptr);
  EXPECT_EQ(signorini_result_status(nullptr), SIGNORINI_NOT_RUN);
  EXPECT_STREQ(signorini_result_detail(nullptr), "");
  EXPECT_EQ(signorini_result_z(nullptr), nullptr);
  EXPECT_EQ(signorini_result_attempt_count(nullptr), 0);
  EXPECT_STREQ(signorini_status_text(99), "unknown status");
}

TEST(CApi, SizesThatCannotBeAreRefusedAtOnce) {
  const Problem problem = small_problem();
  signorini_problem* p = problem.get();
  const std::int32_t start[] = {0, 1, 2};
  const std::int32_t index[] = {0, 1};
  const double ones[] = {1.0, 1.0};
  const auto dense = [&](std::int64_t n) {
    return signorini_problem_set_dense(p, n, SIGNORINI_ROW_MAJOR, kM, kQ);
  };
  expect_refused(dense(-1), "n: must be in [0, 46340], got -1");
  expect_refused(dense(kHuge), "got 1000000000");
  expect_refused(dense(std::numeric_limits<std::int64_t>::max()), "n: ");
  expect_refused(dense(std::numeric_limits<std::int64_t>::min()), "n: ");
  const auto sparse = [&](std::int64_t n, std::int64_t entries, const std::int32_t* at) {
    return signorini_problem_set_sparse(p, n, SIGNORINI_ROW_MAJOR, entries, at, index, ones, kQ);
  };
  expect_refused(sparse(-1, 2, start), "n: ");
  expect_refused(sparse(std::int64_t{1} << 40, 2, start), "n: ");
  expect_refused(sparse(2, -1, start), "entries");
  expect_refused(sparse(2, std::int64_t{1} << 40, start), "entries");
  expect_refused(sparse(2, 3, start), "start[2]");
  const std::int32_t falls[] = {0, 2, 1};
  expect_refused(sparse(2, 2, falls), "start[2]");
  const std::int32_t negative[] = {0, -1, 2};
  expect_refused(sparse(2, 2, negative), "start[1] is -1");
  const std::int32_t beyond[] = {0, 1000000000, 2};
  expect_refused(sparse(2, 2, beyond), "start[1] is 1000000000");
  const std::int32_t twice_start[] = {0, 2, 2};
  const std::int32_t twice[] = {1, 1};
  expect_refused(
      signorini_problem_set_sparse(p, 2, SIGNORINI_COLUMN_MAJOR, 2, twice_start, twice, ones, kQ),
      "index 1 is given twice");
  for (const std::int32_t wrong : {-1, 2, 2147483647}) {
    const std::int32_t out[] = {0, wrong};
    expect_refused(signorini_problem_set_sparse(p, 2, SIGNORINI_ROW_MAJOR, 2, start, out, ones, kQ),
                   "index[1]");
  }
  const auto factored = [&](std::int64_t blocks, std::vector<std::int32_t> sizes,
                            const double* mass) {
    return signorini_problem_set_factored(p, 2, 2, start, index, ones, blocks, sizes.data(),
                                          SIGNORINI_INVERSE_MASS, mass, nullptr, kQ);
  };
  expect_refused(factored(-1, {1, 1}, ones), "blocks");
  expect_refused(factored(std::int64_t{1} << 40, {1, 1}, ones), "blocks");
  expect_refused(factored(2, {1, 0}, ones), "block_size[1] is 0");
  expect_refused(factored(2, {1, -6}, ones), "block_size[1] is -6");
  expect_refused(factored(2, {1, 1000000000}, ones), "block_size[1] is 1000000000");
  expect_refused(factored(1, {1}, ones), "index[1]");
  expect_refused(factored(2, {1, 1}, nullptr), "block_value");
  const double bad[] = {1.0, -1.0};
  expect_refused(factored(2, {1, 1}, bad), "block 1");
  const double nan[] = {kNaN, 1.0};
  expect_refused(factored(2, {1, 1}, nan), "block 0");
  const double rigid[] = {0.0, 0.0};
  expect_refused(
      signorini_problem_set_factored(p, 2, 2, start, index, ones, 2, index, 7, rigid, nullptr, kQ),
      "kind");
  expect_refused(signorini_problem_set_dense(p, 2, 7, kM, kQ), "order");
  expect_refused(signorini_problem_set_dense(p, 2, SIGNORINI_ROW_MAJOR, nullptr, kQ), "M: is null");
  expect_refused(signorini_problem_set_dense(p, 2, SIGNORINI_ROW_MAJOR, kM, nullptr), "q: is null");
  expect_refused(signorini_problem_set_bounds(p, 3, ones, ones), "n: ");
  expect_refused(signorini_problem_set_limits(p, 3, index, index, ones), "count");
  expect_refused(signorini_problem_set_limits(p, -1, index, index, ones), "count");
  const std::int32_t far[] = {7, 1};
  expect_refused(signorini_problem_set_limits(p, 2, far, index, ones), "limits");
  const std::int32_t dimension[] = {3, 3};
  expect_refused(signorini_problem_set_cones(p, 1, index, dimension, ones, SIGNORINI_COULOMB),
                 "cones");
  const std::int32_t plane[] = {2};
  expect_refused(signorini_problem_set_cones(p, 1, index, plane, ones, 3), "law");
  expect_small_answer(solve(p));  // nothing of all that changed the problem
}

TEST(CApi, ValuesThatCannotBeSolvedEndInTheStatus) {
  const Solver solver = make_solver("auto");
  const Result result = make_result();
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    const Problem problem = small_problem();
    signorini_problem_q(problem.get())[1] = bad;
    ASSERT_EQ(signorini_solver_solve(solver.get(), problem.get(), nullptr, result.get()), 0);
    EXPECT_EQ(signorini_result_status(result.get()), SIGNORINI_INVALID_INPUT);
    EXPECT_NE(std::string(signorini_result_detail(result.get())).find("q[1]"), std::string::npos);
    EXPECT_TRUE(std::isnan(signorini_result_z(result.get())[0]));
  }
  const Problem problem = small_problem();
  const double start[] = {kNaN, 1.0};
  ASSERT_EQ(signorini_solver_solve(solver.get(), problem.get(), start, result.get()), 0);
  EXPECT_EQ(signorini_result_status(result.get()), SIGNORINI_SOLVED);
  EXPECT_NE(std::string(signorini_result_detail(result.get())), "");
}

TEST(CApi, NoRowsAreSolvedAndAWrongSolverIsRefused) {
  const Problem problem = make_problem();
  EXPECT_TRUE(solve(problem.get()).empty());
  ASSERT_EQ(
      signorini_problem_set_sparse(problem.get(), 0, SIGNORINI_ROW_MAJOR, 0,
                                   std::vector<std::int32_t>{0}.data(), nullptr, nullptr, nullptr),
      0);
  EXPECT_TRUE(solve(problem.get()).empty());
  const double M[] = {1.0, 2.0, 0.0, 1.0};
  ASSERT_EQ(signorini_problem_set_dense(problem.get(), 2, SIGNORINI_ROW_MAJOR, M, kQ), 0);
  const Solver dantzig = make_solver("dantzig");
  const Result result = make_result();
  expect_refused(signorini_solver_solve(dantzig.get(), problem.get(), nullptr, result.get()),
                 "dantzig");
  EXPECT_EQ(signorini_result_status(result.get()), SIGNORINI_NOT_RUN);
}

TEST(CApi, ErrorsBelongToTheirThread) {
  expect_refused(signorini_problem_create(nullptr), "problem");
  const Problem problem = small_problem();
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k) {
    threads.emplace_back([&problem] {
      EXPECT_STREQ(signorini_last_error(), "");
      for (int times = 0; times < 20; ++times) {
        expect_small_answer(solve(problem.get()));  // one problem, a solver a thread
      }
      expect_refused(signorini_result_create(nullptr), "result");
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(std::string(signorini_last_error()), "problem: is null");
}

TEST(CApi, ALongMessageIsCut) {
  signorini_solver* none = nullptr;
  const std::string name(5000, 'x');
  expect_refused(signorini_solver_create(name.c_str(), &none), "xxxx");
  EXPECT_EQ(std::strlen(signorini_last_error()), 1023u);
}

}  // namespace
