#include <signorini/lcp/block_lu.h>
#include <signorini/lcp/body_newton_system.h>
#include <signorini/lcp/dense_kernels.h>

#include "random_block_matrix.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

class EveryInstructionSet : public testing::TestWithParam<DenseKernels> {};

std::string set_name(const testing::TestParamInfo<DenseKernels>& tested) {
  return std::string(tested.param.name);
}

constexpr double kScratch = std::numeric_limits<double>::quiet_NaN();

/// The two panels of a matrix: its columns, and those of its transpose.
struct Panels {
  Panels(const Matrix& A, int columns) : ld((static_cast<int>(A.rows()) + 7) / 8 * 8) {
    const int rows = static_cast<int>(A.rows());
    lower.assign(static_cast<std::size_t>(ld) * columns + DenseKernels::kPadding, kScratch);
    upper = lower;
    for (int c = 0; c < columns; ++c) {
      for (int r = c; r < rows; ++r) {
        lower[c * ld + r] = A(r, c);
        upper[c * ld + r] = r == c ? 0.0 : A(c, r);
      }
    }
  }
  int ld;
  std::vector<double> lower, upper;
};

/// Normal numbers, and so much on the diagonal.
Matrix random_matrix(int n, double diagonal, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return Matrix::NullaryExpr(n, n, [&] { return normal(random); }) +
         diagonal * Matrix::Identity(n, n);
}

Matrix exchange_rows(Matrix A, const std::vector<int>& exchanges) {
  for (std::size_t c = 0; c < exchanges.size(); ++c) {
    A.row(static_cast<Index>(c)).swap(A.row(exchanges[c]));
  }
  return A;
}

/// Every size around the widths of the vectors and tiles, with a large diagonal and with none.
TEST_P(EveryInstructionSet, LTimesUAndTheRestGiveTheExchangedMatrix) {
  int exchanged = 0;
  for (const int columns : {1, 2, 3, 5, 7, 8, 9, 16, 23, 140}) {
    for (const int below : {0, 1, 3, 8, 9, 15, 17, 31, 70}) {
      for (const double diagonal : {0.0, 300.0}) {
        const int rows = columns + below;
        const Matrix A = random_matrix(rows, diagonal, 100 * columns + below);
        Panels panels(A, columns);
        std::vector<int> exchanges(columns, -1);
        ASSERT_TRUE(GetParam().factor_lu(panels.lower.data(), panels.upper.data(), panels.ld, rows,
                                         columns, exchanges.data()));
        Matrix L = Matrix::Zero(rows, columns);
        Matrix U = Matrix::Zero(columns, rows);
        for (int c = 0; c < columns; ++c) {
          for (int r = c; r < rows; ++r) {
            L(r, c) = panels.lower[c * panels.ld + r];
            U(c, r) = panels.upper[c * panels.ld + r];
          }
          EXPECT_EQ(L(c, c), 1.0);
          EXPECT_GE(exchanges[c], c);
          EXPECT_EQ(exchanges[c] / DenseKernels::kPivots, c / DenseKernels::kPivots);
          EXPECT_LT(exchanges[c], columns);
          exchanged += exchanges[c] != c;
          EXPECT_TRUE(diagonal == 0.0 || exchanges[c] == c);
        }
        const Matrix product = L * U;
        const Matrix wanted = exchange_rows(A, exchanges);
        const double growth = (L.cwiseAbs() * U.cwiseAbs()).maxCoeff();
        const double bound = 1e-15 * rows * growth;
        EXPECT_LE((wanted - product).leftCols(columns).cwiseAbs().maxCoeff(), bound)
            << rows << " x " << columns;
        EXPECT_LE((wanted - product).topRows(columns).cwiseAbs().maxCoeff(), bound);
        const int ld_square = (below + 7) / 8 * 8;
        std::vector<double> square(ld_square * below + DenseKernels::kPadding, kScratch);
        for (int c = 0; c < below; ++c) {
          std::fill_n(square.begin() + c * ld_square + c, below - c, 0.0);
        }
        GetParam().subtract_product(square.data(), ld_square, panels.lower.data() + columns,
                                    panels.upper.data() + columns, panels.ld, below, columns);
        for (int c = 0; c < below; ++c) {
          for (int r = c; r < below; ++r) {
            EXPECT_NEAR(square[c * ld_square + r], -product(columns + r, columns + c), bound);
          }
        }
      }
    }
  }
  EXPECT_GT(exchanged, 100);
}

TEST_P(EveryInstructionSet, AddsAProductOfThreeRowsAndNothingBeside) {
  constexpr int kWidth = 15;
  constexpr int kLd = 9;
  const Matrix left = random_matrix(kWidth, 0.0, 1).leftCols(3);
  const Matrix right = random_matrix(kWidth, 0.0, 2).leftCols(3);
  for (int rows = 0; rows <= 7; ++rows) {
    for (const int columns : {0, 1, 3, 6}) {
      Matrix block = Matrix::Ones(kLd, columns);
      Matrix wanted = block;
      wanted.topRows(rows) += left.middleRows(4, rows) * right.middleRows(5, columns).transpose();
      GetParam().add_product_of_three(block.data(), kLd, left.data() + 4, right.data() + 5, kWidth,
                                      rows, columns);
      EXPECT_LE((block - wanted).cwiseAbs().sum(), 1e-13) << rows << " x " << columns;
      EXPECT_EQ(block.bottomRows(kLd - rows), wanted.bottomRows(kLd - rows));
    }
  }
}

TEST_P(EveryInstructionSet, RefusesPivotsThatAreZeroOrNotFinite) {
  for (const double bad :
       {0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (int at = 0; at < 20; ++at) {
      Matrix A = Matrix::Identity(20, 20);
      A(at, at) = bad;
      Panels panels(A, 20);
      std::vector<int> exchanges(20);
      EXPECT_FALSE(GetParam().factor_lu(panels.lower.data(), panels.upper.data(), panels.ld, 20, 20,
                                        exchanges.data()))
          << bad << " at " << at;
    }
  }
}

BlockLu::View view_of(const SparseMatrix& matrix) {
  return {matrix.rows(),          matrix.cols(),          matrix.nonZeros(),
          matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr()};
}

/// The error of a solve whose answer is known.
double error_of(BlockLu& lu, const SparseMatrix& matrix) {
  const Vector wanted = Vector::LinSpaced(matrix.rows(), -1.0, 1.0);
  Vector x = matrix * wanted;
  lu.solve({x.data(), static_cast<std::size_t>(x.size())});
  return (x - wanted).cwiseAbs().maxCoeff();
}

TEST_P(EveryInstructionSet, SolvesRandomGraphs) {
  for (int seed = 1; seed <= 60; ++seed) {
    const double edges = 1.0 + seed % 5;
    const SparseMatrix matrix = random_block_matrix(1 + 3 * seed, edges, 30.0 * edges, seed);
    BlockLu lu(GetParam());
    lu.analyse(view_of(matrix));
    ASSERT_TRUE(lu.factor(view_of(SparseMatrix(3.0 * matrix))));  // of which nothing may stay
    ASSERT_TRUE(lu.factor(view_of(matrix))) << "seed " << seed;
    EXPECT_LE(error_of(lu, matrix), 1e-12) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryInstructionSet,
                         testing::ValuesIn(dense_kernels().begin(), dense_kernels().end()),
                         set_name);

/// Without a diagonal every block of more than one column needs exchanges.
TEST(BlockLu, ExchangesRowsOfABlock) {
  std::vector<Eigen::Triplet<double>> entries;
  constexpr int kBlocks = 50;
  for (int b = 0; b < kBlocks; ++b) {
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const double turned =
            j == (i + 1) % 6 ? 10.0 : 0.1;  // a large cycle, small on the diagonal
        entries.emplace_back(6 * b + i, 6 * b + j, turned);
        if (b + 1 < kBlocks) {
          entries.emplace_back(6 * b + i, 6 * b + 6 + j, 0.1 * i);
          entries.emplace_back(6 * b + 6 + j, 6 * b + i, 0.1 * j);
        }
      }
    }
  }
  SparseMatrix matrix(6 * kBlocks, 6 * kBlocks);
  matrix.setFromTriplets(entries.begin(), entries.end());
  BlockLu lu;
  lu.analyse(view_of(matrix));
  ASSERT_TRUE(lu.factor(view_of(matrix)));
  EXPECT_LE(error_of(lu, matrix), 1e-12);
}

TEST(BlockLu, SamePatternAgainAndAnotherPattern) {
  BlockLu lu;
  const SparseMatrix one = random_block_matrix(30, 2.0, 60.0, 1);
  const SparseMatrix other_values = one * 0.5;
  const SparseMatrix other = random_block_matrix(50, 2.0, 60.0, 2);
  for (const SparseMatrix* matrix : {&one, &other_values, &other, &one}) {
    lu.analyse(view_of(*matrix));
    ASSERT_TRUE(lu.factor(view_of(*matrix)));
    EXPECT_LE(error_of(lu, *matrix), 1e-12);
  }
  EXPECT_GT(lu.bytes(), 2 * sizeof(double) * one.nonZeros());
}

TEST(BlockLu, OneNumber) {
  SparseMatrix matrix(1, 1);
  matrix.insert(0, 0) = -4.0;
  matrix.makeCompressed();
  BlockLu lu;
  lu.analyse(view_of(matrix));
  ASSERT_TRUE(lu.factor(view_of(matrix)));
  double x = 2.0;
  lu.solve({&x, 1});
  EXPECT_EQ(x, -0.5);
  matrix.coeffRef(0, 0) = 0.0;
  EXPECT_FALSE(lu.factor(view_of(matrix)));
}

/// Two bodies of six degrees of freedom on six rows, each on the same number of both, with weights
/// that leave H = I + G^T D G almost nothing on its diagonal, [[e, e - 1], [e - 1, e]] for each of
/// the six: for e = 0 no exchange in a block of eight finds a pivot for all of them, for a small e
/// the pivots that are found lose e.
class WithoutADiagonal : public testing::TestWithParam<double> {};

TEST_P(WithoutADiagonal, IsSolvedWithOtherPivots) {
  const double small = GetParam();
  Problem problem;
  FactoredMatrix rows;
  rows.mass.add_inverse(Matrix::Identity(6, 6));
  rows.mass.add_inverse(Matrix::Identity(6, 6));
  for (int k = 0; k < 6; ++k) {
    rows.add_row();
    rows.add_entry(0, Vector::Unit(6, k));
    rows.add_entry(1, Vector::Unit(6, k));
  }
  problem.q = Vector::Zero(6);
  problem.M = rows;
  WhitenedRows whitened;
  whitened.set(rows);
  AlartCurnierFunction function;
  function.set(problem, whitened.scale(), 1.0);
  BodyNewtonSystem system;
  system.set(whitened, function);
  // K = A + alpha B, D = B / K = 2 (e - 1) with the two halves of G^T G: [[1, 1], [1, 1]] / 2.
  constexpr double kAlpha = 0.25;
  const double D = 2.0 * (small - 1.0);
  const std::vector<AlartCurnierFunction::Block> A(
      6, AlartCurnierFunction::Block::Identity() * (1.0 / D - kAlpha));
  const std::vector<AlartCurnierFunction::Block> B(6, AlartCurnierFunction::Block::Identity());
  const std::vector<AlartCurnierFunction::Coupling> none;
  ASSERT_TRUE(system.factor(A, B, none, kAlpha));
  const Vector F = Vector::LinSpaced(6, 1.0, 2.0);
  Vector dx;
  ASSERT_TRUE(system.solve(F, dx));
  // A dx + B (G G^T + alpha) dx = -F, with G G^T = 1.
  const Vector wanted = -F / (A[0](0, 0) + 1.0 + kAlpha);
  EXPECT_LE((dx - wanted).cwiseAbs().maxCoeff(), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(All, WithoutADiagonal, testing::Values(0.0, 1e-20, 1e-15, 1e-9, 0.9));

}  // namespace
}  // namespace signorini::lcp
