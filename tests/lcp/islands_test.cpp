#include <signorini/lcp/islands.h>

#include <gtest/gtest.h>
#include <vector>

namespace signorini::lcp {
namespace {

using Numbers = std::vector<int>;

Problem with(const Matrix& M) {
  Problem problem;
  problem.M = M;
  problem.q = Vector::Ones(M.rows());
  return problem;
}

TEST(Islands, OfNoRowsAreNone) {
  Islands islands;
  islands.find(with(Matrix(0, 0)));
  EXPECT_EQ(islands.count, 0);
  EXPECT_TRUE(islands.island.empty());
}

TEST(Islands, AreConnectedByEntriesOfEitherTriangleAndNumberedByTheirFirstRow) {
  Matrix M = Matrix::Identity(5, 5);
  M(0, 3) = 1.0;
  M(4, 2) = 1.0;
  for (const bool sparse : {false, true}) {
    Problem problem = with(M);
    if (sparse) {
      problem.M = SparseMatrix(M.sparseView());
    }
    Islands islands;
    islands.find(problem);
    EXPECT_EQ(islands.island, (Numbers{0, 1, 2, 0, 2}));
    EXPECT_EQ(islands.count, 3);
  }
}

TEST(Islands, AreConnectedByConesAndCoupledLimits) {
  Problem problem = with(Matrix::Identity(6, 6));
  problem.cones = {{.normal_row = 1, .dimension = 3, .coefficient = 0.5}};
  problem.limits = {{.row = 5, .normal_row = 0, .coefficient = 0.5}};
  Islands islands;
  islands.find(problem);
  EXPECT_EQ(islands.island, (Numbers{0, 1, 1, 1, 2, 0}));
}

TEST(Islands, OfAFactoredMatrixAreConnectedByBlocks) {
  FactoredMatrix A;
  for (int b = 0; b < 3; ++b) {
    A.mass.add_inverse(Matrix::Identity(1, 1));
  }
  const Vector one = Vector::Ones(1);
  A.add_row();
  A.add_entry(2, one);
  A.add_row();
  A.add_entry(0, one);
  A.add_row();
  A.add_entry(0, one);
  A.add_entry(1, one);
  A.add_row();  // touches nothing
  A.add_row();
  A.add_entry(1, one);
  Problem problem;
  problem.M = A;
  problem.q = Vector::Ones(5);
  Islands islands;
  islands.find(problem);
  EXPECT_EQ(islands.island, (Numbers{0, 1, 1, 2, 1}));
  EXPECT_EQ(islands.count, 3);
}

}  // namespace
}  // namespace signorini::lcp
