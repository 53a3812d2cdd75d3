#include <signorini/lcp/problem.h>

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Problem good() {
  Problem problem;
  problem.M = Matrix{{2.0, -1.0, 0.0}, {0.0, 3.0, 4.0}, {5.0, 0.0, -6.0}};
  problem.q = Vector{{-1.0, 2.0, -3.0}};
  return problem;
}

SparseMatrix sparse(const Matrix& M) {
  return M.sparseView();
}

std::string shape_error(const Problem& problem) {
  try {
    check_shapes(problem);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Problem, OfThreeRowsIsAnLcpWithOrWithoutTheBoundsSpelledOut) {
  Problem problem = good();
  EXPECT_EQ(shape_error(problem), "");
  EXPECT_EQ(find_bad_value(problem), "");
  EXPECT_TRUE(problem.is_lcp());
  problem.lower = Vector::Zero(3);
  problem.upper = Vector::Constant(3, kInfinity);
  EXPECT_TRUE(problem.is_lcp());
  problem.lower[1] = -kInfinity;
  EXPECT_FALSE(problem.is_lcp());
  problem.lower[1] = 0.0;
  problem.upper[1] = 5.0;
  EXPECT_FALSE(problem.is_lcp());
  problem.upper[1] = kInfinity;
  problem.limits = {{.row = 1, .normal_row = 0, .coefficient = 0.5}};
  EXPECT_FALSE(problem.is_lcp());
}

struct Wrong {
  const char* name;
  std::function<void(Problem&)> spoil;
  const char* expected;  // in the message
};

class WrongShape : public ::testing::TestWithParam<Wrong> {};
TEST_P(WrongShape, IsNamedWithItsNumbers) {
  Problem problem = good();
  GetParam().spoil(problem);
  EXPECT_NE(shape_error(problem).find(GetParam().expected), std::string::npos)
      << shape_error(problem);
}
INSTANTIATE_TEST_SUITE_P(
    Problem, WrongShape,
    ::testing::Values(
        Wrong{"NotSquare", [](Problem& p) { p.M = Matrix(3, 2); }, "M: must be square, got 3 x 2"},
        Wrong{"SparseNotSquare", [](Problem& p) { p.M = SparseMatrix(2, 3); }, "got 2 x 3"},
        Wrong{"ShortQ", [](Problem& p) { p.q = Vector::Zero(2); },
              "q: 2 numbers for a matrix M of 3 rows"},
        Wrong{"FactoredRows", [](Problem& p) { p.M = FactoredMatrix(); }, "M of 0 rows"},
        Wrong{"Lower", [](Problem& p) { p.lower = Vector::Zero(2); }, "lower: 2 numbers"},
        Wrong{"Upper", [](Problem& p) { p.upper = Vector::Zero(4); }, "upper: 4 numbers"},
        Wrong{"LimitRow",
              [](Problem& p) {
                p.limits = {{3, 0, 0.5}};
              },
              "row 3"},
        Wrong{"LimitNormal",
              [](Problem& p) {
                p.limits = {{1, -1, 0.5}};
              },
              "normal row -1"},
        Wrong{"ConeDimension",
              [](Problem& p) {
                p.cones = {{0, 1, 0.5}};
              },
              "dimension must be 2 or 3, got 1"},
        Wrong{"ConeOutside",
              [](Problem& p) {
                p.cones = {{2, 2, 0.5}};
              },
              "at row 2: 2 rows do not fit a problem of 3 rows"},
        Wrong{"ConesThatShareARow",
              [](Problem& p) {
                p.cones = {{0, 2, 0.5}, {1, 2, 0.5}};
              },
              "at row 1: cones must ascend and share no row; the one before ends at row 1"},
        Wrong{"ConeOnACoupledLimit",
              [](Problem& p) {
                p.cones = {{1, 2, 0.5}};
                p.limits = {{2, 0, 0.5}};
              },
              "row 2 belongs to a cone"},
        Wrong{"LimitOnItself",
              [](Problem& p) {
                p.limits = {{1, 1, 0.5}};
              },
              "normal row 1"}),
    [](const auto& param) { return param.param.name; });

class BadValue : public ::testing::TestWithParam<Wrong> {};
TEST_P(BadValue, IsNamedWithItsPlace) {
  Problem problem = good();
  GetParam().spoil(problem);
  EXPECT_EQ(shape_error(problem), "");
  EXPECT_EQ(find_bad_value(problem), GetParam().expected);
}
INSTANTIATE_TEST_SUITE_P(
    Problem, BadValue,
    ::testing::Values(Wrong{"NanInQ", [](Problem& p) { p.q[2] = std::nan(""); }, "q[2] is nan"},
                      Wrong{"InfinityInM",
                            [](Problem& p) { std::get<Matrix>(p.M)(1, 2) = kInfinity; },
                            "M(1, 2) is inf"},
                      Wrong{"NanInSparseM",
                            [](Problem& p) {
                              Matrix M = std::get<Matrix>(p.M);
                              M(2, 0) = std::nan("");
                              p.M = sparse(M);
                            },
                            "M(2, 0) is nan"},
                      Wrong{"NanInJ",
                            [](Problem& p) {
                              FactoredMatrix A;
                              A.mass.add_inverse(Matrix::Identity(2, 2));
                              for (int i = 0; i < 3; ++i) {
                                A.add_row();
                                A.add_entry(0, Vector{{1.0, i == 1 ? std::nan("") : 0.0}});
                              }
                              p.M = A;
                            },
                            "J: row 1, block 0, value 1 is nan"},
                      Wrong{"CrossedBounds",
                            [](Problem& p) {
                              p.lower = Vector{{0, 2, 0}};
                              p.upper = Vector{{1, 1, 1}};
                            },
                            "lower[1] is 2, above upper[1] is 1"},
                      Wrong{"NanBound",
                            [](Problem& p) {
                              p.upper = Vector{{1, 1, std::nan("")}};
                            },
                            "upper[2] is nan"},
                      Wrong{"LowerAtInfinity",
                            [](Problem& p) {
                              p.lower = Vector{{kInfinity, 0, 0}};
                            },
                            "lower[0] is inf"},
                      Wrong{"NegativeConeFriction",
                            [](Problem& p) {
                              p.cones = {{0, 3, -0.5}};
                            },
                            "friction coefficient of the cone at row[0] is -0.5"},
                      Wrong{"NegativeFriction",
                            [](Problem& p) {
                              p.limits = {{1, 0, -1e-9}};
                            },
                            "limit coefficient of row[1] is -1e-09"}),
    [](const auto& param) { return param.param.name; });

TEST(MatrixForm, DenseAndSparseMultiplyAlike) {
  const Problem problem = good();
  const MatrixForm dense = problem.M;
  const MatrixForm thin = sparse(std::get<Matrix>(problem.M));
  const Vector z{{1.0, -2.0, 0.0}};
  for (const MatrixForm& M : {dense, thin}) {
    Vector w(3);
    multiply(M, z.data(), w.data());
    EXPECT_EQ(w, (Vector{{4.0, -6.0, 5.0}}));
    std::vector<long double> transposed;
    transpose_multiply(M, z, transposed);
    EXPECT_EQ(transposed, (std::vector<long double>{2.0L, -7.0L, -8.0L}));
    Vector d;
    diagonal(M, d);
    EXPECT_EQ(d, (Vector{{2.0, 3.0, -6.0}}));
    EXPECT_EQ(to_dense(M), std::get<Matrix>(dense));
    EXPECT_EQ(rows(M), 3);
  }
}

}  // namespace
}  // namespace signorini::lcp
