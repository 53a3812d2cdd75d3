#include <signorini/lcp/principal_factor.h>
#include <signorini/lcp/principal_tableau.h>
#include <signorini/lcp/symmetric_lcp.h>

#include <Eigen/Cholesky>
#include <bench/contact_families.h>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

namespace signorini::lcp {
namespace {

/// M' of a problem, from its columns.
Matrix scaled_matrix(const SymmetricLcp& lcp) {
  Matrix M = Matrix::Zero(lcp.size(), lcp.size());
  for (int j = 0; j < lcp.size(); ++j) {
    lcp.add_column(j, 1.0, M.col(j).data());
  }
  return M;
}

/// The rates of row j by a fresh dense factorisation.
Vector expected_column(const Matrix& M, const PrincipalBasis& basis, int j) {
  const Index n = M.rows();
  std::vector<Index> c;
  for (int i = 0; i < n; ++i) {
    if (basis.contains(i)) {
      c.push_back(i);
    }
  }
  const Eigen::LDLT<Matrix> ldlt(M(c, c));
  const Vector right = basis.contains(j) ? Vector(Matrix::Identity(n, n)(c, j)) : Vector(-M(c, j));
  const Vector z = c.empty() ? Vector(0) : Vector(ldlt.solve(right));
  Vector rate = basis.contains(j) ? Vector(Vector::Zero(n)) : Vector(M.col(j));
  if (!c.empty()) {
    rate += M(Eigen::all, c) * z;
    rate(c) = z;
  }
  return rate;
}

Problem pile() {
  return bench::make_family({.family = "spheres", .size = 200, .mass_ratio = 10.0});
}

/// Entries of M without the one across the diagonal: no exchange may leave anything of them.
TEST(PrincipalFactor, TakesAPatternThatIsNotSymmetric) {
  constexpr int kRows = 40;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> row(0, kRows - 1);
  Matrix M = Matrix::Identity(kRows, kRows);
  for (int e = 0; e < 3 * kRows; ++e) {
    const int i = row(random);
    const int j = row(random);
    M(i, j) = i != j && M(j, i) == 0.0 ? 0.009 : M(i, j);
  }
  Problem problem;
  problem.M = SparseMatrix(M.sparseView());
  problem.q = Vector::Ones(kRows);
  SymmetricLcp lcp;
  ASSERT_TRUE(lcp.assign(problem));
  ASSERT_FALSE(lcp.is_dense());
  PrincipalFactor basis;
  basis.reset(lcp);
  Vector rate(kRows);
  for (int j = 0; j < kRows; ++j) {
    ASSERT_TRUE(basis.exchange(j));
    ASSERT_TRUE(basis.exchange(j == 0 ? 0 : j - 1));  // in the end one is left, and nothing else
  }
  for (int j = 0; j < kRows; ++j) {
    if (basis.contains(j)) {
      ASSERT_TRUE(basis.exchange(j));
    }
  }
  for (int j = 0; j < kRows; ++j) {
    basis.column(j, rate.data());
    EXPECT_EQ(rate, scaled_matrix(lcp).col(j)) << j;
  }
}

template <typename Basis>
class PrincipalBases : public testing::Test {};
using Bases = testing::Types<PrincipalTableau, PrincipalFactor>;
TYPED_TEST_SUITE(PrincipalBases, Bases);

/// Random exchanges in and out; every now and then a column is compared with a fresh one.
TYPED_TEST(PrincipalBases, ColumnsAreThoseOfAFreshFactorisation) {
  SymmetricLcp lcp;
  ASSERT_TRUE(lcp.assign(pile()));
  ASSERT_FALSE(lcp.is_dense());
  const Matrix M = scaled_matrix(lcp);
  TypeParam basis;
  basis.reset(lcp);
  std::mt19937 random(7);
  std::uniform_int_distribution<int> any(0, lcp.size() - 1);
  Vector rate(lcp.size());
  int exchanges = 0;
  for (int step = 0; step < 500; ++step) {
    const int j = any(random);
    basis.column(j, rate.data());
    if (step % 50 == 0) {
      const double size = 1.0 + rate.cwiseAbs().maxCoeff();
      EXPECT_LE((rate - expected_column(M, basis, j)).cwiseAbs().maxCoeff(), 1e-9 * size * size);
    }
    if (rate[j] > 1e-4) {
      ASSERT_TRUE(basis.exchange(j));
      ++exchanges;
    }
  }
  EXPECT_GT(exchanges, 300);
}

TYPED_TEST(PrincipalBases, SolvesWithTheMembersOnly) {
  SymmetricLcp lcp;
  ASSERT_TRUE(lcp.assign(pile()));
  const Matrix M = scaled_matrix(lcp);
  TypeParam basis;
  basis.reset(lcp);
  Vector rate(lcp.size());
  std::vector<Index> c;
  for (int j = 0; j < lcp.size(); j += 3) {
    basis.column(j, rate.data());
    if (rate[j] > 1e-6) {
      ASSERT_TRUE(basis.exchange(j));
      c.push_back(j);
    }
  }
  Vector x = Vector::LinSpaced(lcp.size(), -1.0, 2.0);
  const Vector right = x;
  basis.solve(x.data());
  for (int i = 0; i < lcp.size(); ++i) {
    if (!basis.contains(i)) {
      EXPECT_EQ(x[i], right[i]);
    }
  }
  EXPECT_LE((M(c, c) * x(c) - right(c)).cwiseAbs().maxCoeff(), 1e-9 * x(c).cwiseAbs().maxCoeff());
  const Vector once = x;
  x = right;
  ASSERT_TRUE(basis.refactor());
  basis.solve(x.data());
  EXPECT_LE((x - once)(c).cwiseAbs().maxCoeff(), 1e-8 * x(c).cwiseAbs().maxCoeff());
  EXPECT_EQ(basis.factorizations(), 1);
}

/// A duplicated row has the Schur complement 0.
TYPED_TEST(PrincipalBases, ADependentRowShowsInItsColumn) {
  Problem problem = pile();
  SparseMatrix M = std::get<FactoredMatrix>(problem.M).form();
  const Index n = M.rows();
  Matrix doubled(n + 1, n + 1);
  doubled << Matrix(M), Matrix(M).col(5), Matrix(M).row(5), M.coeff(5, 5);
  problem.M = SparseMatrix(doubled.sparseView());
  problem.q.conservativeResize(n + 1);
  problem.q[n] = problem.q[5];
  SymmetricLcp lcp;
  ASSERT_TRUE(lcp.assign(problem));
  TypeParam basis;
  basis.reset(lcp);
  Vector rate(n + 1);
  for (const int j : {2, 5, 9}) {
    ASSERT_TRUE(basis.exchange(j));
  }
  basis.column(static_cast<int>(n), rate.data());
  EXPECT_NEAR(rate[n], 0.0, 1e-14);
  EXPECT_NEAR(rate[5], -1.0, 1e-14);
}

/// Four contacts a face, three of them independent: loading all rows leaves a regular basis.
TYPED_TEST(PrincipalBases, LoadLeavesDependentRowsOut) {
  SymmetricLcp lcp;
  ASSERT_TRUE(lcp.assign(bench::make_family({.family = "tower4", .size = 50})));
  TypeParam basis;
  basis.reset(lcp);
  const std::vector<char> all(lcp.size(), 1);
  EXPECT_EQ(basis.load(all, 1e-9), 150);
  Vector rate(lcp.size());
  for (int j = 0; j < lcp.size(); ++j) {
    if (!basis.contains(j)) {
      basis.column(j, rate.data());
      EXPECT_NEAR(rate[j], 0.0, 1e-9);
    }
  }
}

TEST(PrincipalFactor, AnIndefiniteMatrixIsRefused) {
  SparseMatrix M(200, 200);
  M.setIdentity();
  M.coeffRef(3, 7) = M.coeffRef(7, 3) = 2.0;
  Problem problem;
  problem.M = M;
  problem.q = Vector::Constant(200, -1.0);
  SymmetricLcp lcp;
  ASSERT_TRUE(lcp.assign(problem));
  PrincipalFactor basis;
  basis.reset(lcp);
  EXPECT_TRUE(basis.exchange(3));
  EXPECT_FALSE(basis.exchange(7));
}

TEST(SymmetricLcp, ScalesByPowersOfTwo) {
  Problem problem;
  problem.M = Matrix{{3e-7, 0.02}, {0.02, 5e9}};
  problem.q = Vector{{-1e-3, 40.0}};
  problem.lower = Vector{{-1.0, 0.0}};
  SymmetricLcp lcp;
  ASSERT_TRUE(lcp.assign(problem));
  for (int i = 0; i < 2; ++i) {
    EXPECT_GE(lcp.dense_column(i)[i], 0.5);
    EXPECT_LE(lcp.dense_column(i)[i], 2.0);
    int exponent = 0;
    EXPECT_EQ(std::frexp(lcp.scale(i), &exponent), 0.5);
    EXPECT_EQ(lcp.unscale_w(i, lcp.q()[i]), problem.q[i]);
    EXPECT_EQ(lcp.unscale_z(i, lcp.scale_z(i, 0.3)), 0.3);
  }
  EXPECT_EQ(lcp.unscale_z(0, lcp.lower(0)), -1.0);
  EXPECT_EQ(lcp.upper(1), std::numeric_limits<double>::infinity());
}

TEST(SymmetricLcp, NamesTheWorstAsymmetry) {
  Problem problem;
  problem.M = Matrix{{1, 0, 0.5}, {0, 1, 0}, {0.6, 0, 1}};
  problem.q = Vector::Zero(3);
  EXPECT_EQ(SymmetricLcp::find_asymmetry(problem), "M(2, 0) is 0.6, M(0, 2) is 0.5");
  problem.M = SparseMatrix(Matrix{{1, 0, 0.5}, {0, 1, 0}, {0, 0, 1}}.sparseView());
  EXPECT_EQ(SymmetricLcp::find_asymmetry(problem), "M(0, 2) is 0.5, M(2, 0) is 0");
  problem.M = Matrix{{1, 1e-3, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(SymmetricLcp::find_asymmetry(problem), "");
  EXPECT_DOUBLE_EQ(SymmetricLcp::asymmetry(problem).size, 1e-3);
}

/// The factored form and the same matrix formed give the same scaled columns.
TEST(SymmetricLcp, FormsAFactoredMatrix) {
  Problem problem = pile();
  SymmetricLcp factored;
  ASSERT_TRUE(factored.assign(problem));
  problem.M = std::get<FactoredMatrix>(problem.M).form();
  SymmetricLcp formed;
  ASSERT_TRUE(formed.assign(problem));
  EXPECT_LE((scaled_matrix(factored) - scaled_matrix(formed)).cwiseAbs().maxCoeff(), 1e-15);
}

}  // namespace
}  // namespace signorini::lcp
