#include <signorini/lcp/exact_lemke.h>
#include <signorini/lcp/exact_solution.h>

#include "bench/complementary_cones.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace signorini::lcp {
namespace {

using bench::find_in_complementary_cones;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Problem dense(const Matrix& M, const Vector& q) {
  return {.M = M, .q = q, .lower = {}, .upper = {}, .limits = {}};
}

Vector vector(std::initializer_list<double> values) {
  return Eigen::Map<const Vector>(values.begin(), static_cast<Index>(values.size()));
}

/// z >= 0, w = M z + q >= 0, z_i w_i = 0 in rationals, or what is wrong.
std::string violation(const ExactProblem& problem, const std::vector<mpq_class>& z) {
  for (int i = 0; i < problem.n; ++i) {
    mpq_class w = problem.q[i];
    for (int j = 0; j < problem.n; ++j) {
      w += problem.at(i, j) * z[j];
    }
    if (sgn(z[i]) < 0 || sgn(w) < 0 || sgn(z[i] * w) != 0) {
      return "row " + std::to_string(i) + ": z " + z[i].get_str() + ", w " + w.get_str();
    }
  }
  return {};
}

/// Random small integers in [-most, most].
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  int integer(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  double real() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  Matrix matrix(Index rows, Index columns, int most) {
    Matrix M(rows, columns);
    for (double& value : M.reshaped()) {
      value = integer(-most, most);
    }
    return M;
  }
  Vector vector(Index n, int most) { return matrix(n, 1, most); }

 private:
  std::mt19937_64 random_;
};

TEST(ComplementaryCones, FindsASolutionInASingularCone) {
  // z = (1, 0) is the only kind of solution, and no nonsingular complementary basis holds it.
  const ExactProblem problem = to_rational(dense(Matrix{{0.0, 0.0}, {1.0, -1.0}}, vector({0, -1})));
  const auto z = find_in_complementary_cones(problem);
  ASSERT_TRUE(z.has_value());
  EXPECT_EQ(violation(problem, *z), "");
}

TEST(ComplementaryCones, KnowsThatThereIsNone) {
  EXPECT_FALSE(find_in_complementary_cones(
      to_rational(dense(Matrix{{1.0, -1.0}, {-1.0, 1.0}}, vector({-1, -1})))));
}

TEST(SolveExactly, PositiveSemidefiniteMatricesAreDecidedAsByEnumeration) {
  Draw draw(1);
  int solved = 0;
  int infeasible = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const Index n = draw.integer(1, 4);
    const Matrix G = draw.matrix(draw.integer(1, static_cast<int>(n)), n, 2);
    Matrix M = G.transpose() * G;
    if (trial % 2 == 1) {  // positive semidefinite and nonsymmetric
      const Matrix S = draw.matrix(n, n, 1);
      M += S - S.transpose();
    }
    const Problem problem = dense(M, draw.vector(n, 3));
    const ExactProblem exact = to_rational(problem);
    const ExactSolution solution = solve_exactly(problem);
    if (find_in_complementary_cones(exact)) {
      ASSERT_EQ(solution.ending, ExactEnding::kSolution) << "trial " << trial << "\n" << M;
      ASSERT_EQ(violation(exact, solution.z), "") << "trial " << trial;
      ++solved;
    } else {
      ASSERT_EQ(solution.ending, ExactEnding::kRay) << "trial " << trial << "\n" << M;
      ASSERT_TRUE(solution.ray_proves_infeasible) << "trial " << trial << "\n" << M;
      ++infeasible;
    }
  }
  EXPECT_GT(solved, 300);
  EXPECT_GT(infeasible, 100);
}

TEST(SolveExactly, AnyMatrixASolutionIsASolutionAndAProofIsAProof) {
  Draw draw(2);
  int endings[2] = {0, 0};
  int unproven = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const Index n = draw.integer(1, 4);
    const Problem problem = dense(draw.matrix(n, n, 2), draw.vector(n, 2));
    const ExactProblem exact = to_rational(problem);
    const ExactSolution solution = solve_exactly(problem);
    const bool exists = find_in_complementary_cones(exact).has_value();
    if (solution.ending == ExactEnding::kSolution) {
      ASSERT_EQ(violation(exact, solution.z), "") << "trial " << trial;
      ASSERT_TRUE(exists);
      ++endings[0];
      continue;
    }
    ASSERT_EQ(solution.ending, ExactEnding::kRay);
    ++endings[1];
    if (solution.ray_proves_infeasible) {
      ASSERT_FALSE(exists) << "trial " << trial;
    } else {
      ++unproven;
    }
  }
  EXPECT_GT(endings[0], 300);
  EXPECT_GT(endings[1], 100);
  EXPECT_GT(unproven, 30);
}

TEST(SolveExactly, PMatricesAreAlwaysSolved) {
  Draw draw(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Index n = draw.integer(1, 8);
    Matrix M = draw.matrix(n, n, 3).triangularView<Eigen::StrictlyUpper>();
    M += Matrix::Identity(n, n);
    const Problem problem = dense(M, draw.vector(n, 3));
    const ExactSolution solution = solve_exactly(problem);
    ASSERT_EQ(solution.ending, ExactEnding::kSolution) << "trial " << trial << "\n" << M;
    ASSERT_EQ(violation(to_rational(problem), solution.z), "") << "trial " << trial;
  }
}

TEST(SolveExactly, FullyDegenerateProblemsEnd) {
  // Every ratio ties: without the lexicographic rule these may cycle.
  Draw draw(4);
  for (int trial = 0; trial < 300; ++trial) {
    const Index n = draw.integer(2, 10);
    const Matrix G = draw.matrix(draw.integer(1, 3), n, 1);
    const Problem problem = dense(G.transpose() * G, Vector::Constant(n, -1.0));
    const ExactSolution solution = solve_exactly(problem);
    if (solution.ending == ExactEnding::kSolution) {
      ASSERT_EQ(violation(to_rational(problem), solution.z), "") << "trial " << trial;
    } else {
      ASSERT_TRUE(solution.ray_proves_infeasible) << "trial " << trial;
    }
  }
}

TEST(SolveExactly, MultipliesAFactoredMatrixOutExactly) {
  Draw draw(5);
  FactoredMatrix A;
  const Matrix mass{{2.0, 0.1, 0.0}, {0.1, 3.0, 0.3}, {0.0, 0.3, 0.7}};
  const Matrix inverse_mass{{0.4, 0.1}, {0.1, 1.3}};
  A.mass.add_mass(mass);
  A.mass.add_inverse(inverse_mass);
  const Matrix J = Matrix::NullaryExpr(4, 5, [&] { return draw.real(); });
  for (Index i = 0; i < 4; ++i) {
    A.add_row(i == 2 ? 0.1 : 0.0);
    A.add_entry(0, J.row(i).head(3).transpose());
    A.add_entry(1, J.row(i).tail(2).transpose());
  }
  const ExactProblem exact =
      to_rational({.M = A, .q = Vector::Zero(4), .lower = {}, .upper = {}, .limits = {}});
  const Matrix L = mass.llt().matrixL();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      mpq_class expected = i == j && i == 2 ? 0.1 : 0.0;
      for (int k = 0; k < 2; ++k) {
        for (int m = 0; m < 2; ++m) {
          expected += mpq_class(J(i, 3 + k)) * inverse_mass(k, m) * mpq_class(J(j, 3 + m));
        }
      }
      // (L^-1 a).(L^-1 b), by forward substitution in rationals.
      std::vector<mpq_class> a(3);
      std::vector<mpq_class> b(3);
      for (int k = 0; k < 3; ++k) {
        a[k] = J(i, k);
        b[k] = J(j, k);
        for (int m = 0; m < k; ++m) {
          a[k] -= L(k, m) * a[m];
          b[k] -= L(k, m) * b[m];
        }
        a[k] /= L(k, k);
        b[k] /= L(k, k);
        expected += a[k] * b[k];
      }
      ASSERT_EQ(exact.at(i, j), expected) << i << ", " << j;
    }
  }
}

TEST(SolveExactly, SparseIsDense) {
  Draw draw(6);
  const Matrix M = draw.matrix(7, 7, 1);
  const Problem sparse{.M = SparseMatrix(M.sparseView()),
                       .q = Vector::Zero(7),
                       .lower = {},
                       .upper = {},
                       .limits = {}};
  EXPECT_EQ(to_rational(sparse).M, to_rational(dense(M, Vector::Zero(7))).M);
}

TEST(ToNearestDouble, RoundsToNearestAndNotTowardsZero) {
  EXPECT_EQ(to_nearest_double(mpq_class(2, 3)), 2.0 / 3.0);  // rounds up
  EXPECT_EQ(to_nearest_double(mpq_class(1, 3)), 1.0 / 3.0);
  EXPECT_EQ(to_nearest_double(mpq_class(-2, 3)), -2.0 / 3.0);
  EXPECT_EQ(to_nearest_double(0), 0.0);
  Draw draw(7);
  for (int trial = 0; trial < 2000; ++trial) {
    const double value = std::ldexp(draw.real(), draw.integer(-1080, 1000));
    ASSERT_EQ(to_nearest_double(mpq_class(value)), value);
    const double next = std::nextafter(value, kInfinity);
    const mpq_class third = (2 * mpq_class(value) + mpq_class(next)) / 3;
    ASSERT_EQ(to_nearest_double(third), value);
    ASSERT_EQ(to_nearest_double((mpq_class(value) + 2 * mpq_class(next)) / 3), next);
  }
}

TEST(ToNearestDouble, TiesGoToEvenAndTheLeastExcessBreaksThem) {
  const mpq_class tie = 1 + mpq_class(0x1p-53);
  EXPECT_EQ(to_nearest_double(tie), 1.0);
  EXPECT_EQ(to_nearest_double(tie + mpq_class(0x1p-900)), 1.0 + 0x1p-52);
  EXPECT_EQ(to_nearest_double(tie + mpq_class(0x1p-52)), 1.0 + 0x1p-51);
}

TEST(ToNearestDouble, OverflowIsInfinityAndUnderflowIsZero) {
  mpq_class huge = 3;
  mpq_mul_2exp(huge.get_mpq_t(), huge.get_mpq_t(), 100000);
  EXPECT_EQ(to_nearest_double(huge), kInfinity);
  EXPECT_EQ(to_nearest_double(-huge), -kInfinity);
  EXPECT_EQ(to_nearest_double(1 / huge), 0.0);
}

TEST(ScaleRay, SaysWhetherTheMultipleIsExact) {
  Vector rounded;
  EXPECT_TRUE(scale_ray({3, 0, mpq_class(0x1p60)}, rounded));
  EXPECT_EQ(rounded, vector({0x3p-61, 0.0, 0.5}));
  EXPECT_FALSE(scale_ray({1, mpq_class(0x1p60) + 1}, rounded));
  EXPECT_EQ(rounded, vector({0x1p-61, 0.5}));
}

TEST(ExactLemke, SolvesEveryMatrixForm) {
  FactoredMatrix A;
  A.mass.add_mass(Matrix{{4.0}});
  A.add_row();
  A.add_entry(0, vector({2.0}));
  const SparseMatrix sparse(Matrix{{1.0}}.sparseView());
  for (const MatrixForm& M : {MatrixForm(Matrix{{1.0}}), MatrixForm(sparse), MatrixForm(A)}) {
    ExactLemke solver;
    Result result;
    solver.solve({.M = M, .q = vector({-1.0}), .lower = {}, .upper = {}, .limits = {}}, result);
    EXPECT_EQ(result.status, Status::kSolved);
    EXPECT_EQ(result.z, vector({1.0}));
    EXPECT_EQ(result.certificate.unit_free_residual, 0.0);
  }
}

TEST(ExactLemke, NonNegativeQTakesNoPivot) {
  ExactLemke solver;
  Result result;
  solver.solve(dense(-Matrix::Identity(3, 3), vector({0.0, 1.0, 2.0})), result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.statistics.pivots, 0);
  EXPECT_EQ(result.z, Vector::Zero(3));
}

TEST(ExactLemke, NoRowsAreSolved) {
  ExactLemke solver;
  Result result;
  solver.solve(dense(Matrix(0, 0), Vector(0)), result);
  EXPECT_EQ(result.status, Status::kSolved);
}

TEST(ExactLemke, OppositeWallsAreProvenInfeasible) {
  ExactLemke solver;
  Result result;
  solver.solve(dense(Matrix{{1.0, -1.0}, {-1.0, 1.0}}, vector({-1.0, -1.0})), result);
  EXPECT_EQ(result.status, Status::kInfeasible);
  EXPECT_EQ(result.ray_bound, kInfinity);
  EXPECT_EQ(result.ray[0], result.ray[1]);
}

TEST(ExactLemke, NegativeScalarIsProvenInfeasible) {
  ExactLemke solver;
  Result result;
  solver.solve(dense(Matrix{{-1.0}}, vector({-1.0})), result);  // w = -z - 1
  EXPECT_EQ(result.status, Status::kInfeasible);
}

TEST(ExactLemke, RayThatProvesNothingIsUnproven) {
  Draw draw(8);
  ExactLemke solver;
  Result result;
  for (int trial = 0; trial < 500 && result.status != Status::kRayUnproven; ++trial) {
    solver.solve(dense(draw.matrix(3, 3, 2), draw.vector(3, 2)), result);
  }
  EXPECT_EQ(result.status, Status::kRayUnproven);
  EXPECT_NE(result.detail.find("proves nothing"), std::string::npos) << result.detail;
}

/// lcp_CPS_3 of the collection: a bimatrix game (nonnegative M with zero diagonal) on which Lemke
/// from the cover (1, .., 1) ends on its first ray, which proves nothing.
TEST(SolveExactly, StartsAgainFromAnotherBasisAfterARayThatProvesNothing) {
  const Problem game = dense(Matrix{{0, 0, 10, 20}, {0, 0, 30, 15}, {10, 20, 0, 0}, {30, 15, 0, 0}},
                             vector({-1.0, -1.0, -1.0, -1.0}));
  const Deadline never(std::numeric_limits<double>::infinity());
  const ExactSolution once = solve_exactly(game, -1, never, 0);
  EXPECT_EQ(once.ending, ExactEnding::kRay);
  EXPECT_FALSE(once.ray_proves_infeasible);
  const ExactSolution solution = solve_exactly(game);
  EXPECT_EQ(solution.ending, ExactEnding::kSolution);
  EXPECT_EQ(violation(to_rational(game), solution.z), "");
  EXPECT_GE(solution.restarts, 1);
  EXPECT_LE(solution.restarts, kExactRestarts);
  ExactLemke solver;
  Result result;
  solver.solve(game, result);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_NE(result.detail.find("restarts from another complementary basis"), std::string::npos);
  EXPECT_LE(solve_exactly(game, once.pivots, never).pivots, once.pivots) << "the limit is of all";
}

TEST(ExactLemke, RayWhoseMultiplesAreNotDoublesIsNotClaimed) {
  // Skew, so positive semidefinite; the null vector is (b d, 0, a d, 0, a c), without a common
  // factor: 106 bits.
  const double a = 0x1p53 - 339;
  const double b = 0x1p53 - 145;
  const double c = 0x1p53 - 183;
  const double d = 0x1p53 - 111;
  Matrix M = Matrix::Zero(5, 5);
  M(0, 1) = a;
  M(1, 2) = b;
  M(2, 3) = c;
  M(3, 4) = d;
  M -= M.transpose().eval();
  const Problem problem = dense(M, vector({-4.0, 1.0, 1.0, 1.0, 1.0}));
  ASSERT_TRUE(solve_exactly(problem).ray_proves_infeasible);
  ExactLemke solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_NE(result.detail.find("no multiple of it has double entries"), std::string::npos)
      << result.detail;
  EXPECT_EQ(result.status, Status::kNoSolutionBelow);
  EXPECT_GT(result.ray_bound, 0.0);
}

TEST(ExactLemke, PivotLimitKeepsTheBasicSolution) {
  const Matrix M{{2.0, 1.0, 0.0}, {1.0, 2.0, 1.0}, {0.0, 1.0, 2.0}};
  const Problem problem = dense(M, vector({-3.0, -4.0, -5.0}));
  ExactLemke unlimited;
  Result result;
  unlimited.solve(problem, result);
  ASSERT_EQ(result.status, Status::kSolved);
  const int pivots = result.statistics.pivots;
  for (int limit = 0; limit < pivots; ++limit) {
    ExactLemkeSettings settings;
    settings.max_iterations = limit;
    ExactLemke limited(settings);
    limited.solve(problem, result);
    EXPECT_EQ(result.status, Status::kIterationLimit);
    EXPECT_EQ(result.statistics.pivots, limit);
    EXPECT_TRUE(result.z.allFinite());
    EXPECT_GE(result.z.minCoeff(), 0.0);
  }
}

TEST(ExactLemke, TimeLimitKeepsTheBasicSolution) {
  const Index n = 120;
  Draw draw(9);
  const Matrix G = Matrix::NullaryExpr(n, n, [&] { return draw.real(); });
  ExactLemkeSettings settings;
  settings.time_limit = 0.05;
  ExactLemke solver(settings);
  Result result;
  solver.solve(dense(G.transpose() * G, Vector::Constant(n, -1.0)), result);
  EXPECT_EQ(result.status, Status::kTimeLimit);
  EXPECT_TRUE(result.z.allFinite());
  EXPECT_GE(result.z.minCoeff(), 0.0);
}

TEST(ExactLemke, SolutionBeyondDoubleIsNotClaimed) {
  ExactLemke solver;
  Result result;
  solver.solve(dense(Matrix{{1e-200}}, vector({-1e200})), result);
  EXPECT_FALSE(is_solved(result.status));
  EXPECT_NE(result.detail.find("beyond the largest double"), std::string::npos) << result.detail;
  EXPECT_TRUE(result.z.allFinite());
}

TEST(ExactLemke, ExtremeScalesAreSolved) {
  for (const double scale : {1e-150, 1e-75, 1e75, 1e150}) {
    ExactLemke solver;
    Result result;
    solver.solve(dense(scale * Matrix{{2.0, 1.0}, {1.0, 2.0}}, vector({-3.0, -5.0})), result);
    EXPECT_TRUE(is_solved(result.status)) << scale << ": " << to_string(result.status);
  }
}

TEST(ExactLemke, RefusesBoundsAndInvalidInput) {
  ExactLemke solver;
  Result result;
  Problem problem = dense(Matrix{{1.0}}, vector({-1.0}));
  problem.upper = vector({2.0});
  EXPECT_THROW(solver.solve(problem, result), std::invalid_argument);
  problem.upper = Vector();
  problem.q[0] = std::numeric_limits<double>::quiet_NaN();
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kInvalidInput);
  ExactLemkeSettings settings;
  settings.tolerance = -1.0;
  EXPECT_THROW(ExactLemke{settings}, std::invalid_argument);
}

/// The numbers of a MatrixMarket file of a problem folder, without its comments.
std::vector<double> read_numbers(const std::string& path, bool& is_symmetric) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  is_symmetric = line.find("symmetric") != std::string::npos;
  std::vector<double> numbers;
  for (double number = 0.0; file >> number;) {
    numbers.push_back(number);
  }
  return numbers;
}

TEST(ExactLemke, SolvesRealContactProblemsWithFullMantissas) {
  const std::string folder = std::string(SIGNORINI_SHARED_DIR) + "/data/contact-problems/";
  if (!std::ifstream(folder + "FORMAT.md")) {
    GTEST_SKIP() << "../shared is absent";
  }
  for (const char* name : {"OneObject-i100000-316-normal", "FrictionContactProblem00374-normal",
                           "rockfall_14_25792-normal", "lcp_mmc", "lcp_CPS_4"}) {
    bool is_symmetric = false;
    const std::vector<double> q = read_numbers(folder + name + "/q.mtx", is_symmetric);
    const std::vector<double> W = read_numbers(folder + name + "/W.mtx", is_symmetric);
    ASSERT_GT(W.size(), 3u) << name;
    const Index n = static_cast<Index>(q[0]);
    Matrix M = Matrix::Zero(n, n);
    for (std::size_t k = 3; k < W.size(); k += 3) {
      const Index i = static_cast<Index>(W[k]) - 1;
      const Index j = static_cast<Index>(W[k + 1]) - 1;
      M(i, j) = W[k + 2];
      if (is_symmetric) {
        M(j, i) = W[k + 2];
      }
    }
    ExactLemke solver;
    Result result;
    solver.solve(dense(M, Eigen::Map<const Vector>(q.data() + 2, n)), result);
    EXPECT_EQ(result.status, Status::kSolved) << name << ": " << result.detail;
    EXPECT_LE(result.certificate.unit_free_residual, 4 * result.certificate.rounding_floor) << name;
  }
}

}  // namespace
}  // namespace signorini::lcp
