#include <signorini/lcp/sparse_cholesky.h>
#include <signorini/lcp/weighted_product.h>
#include <signorini/lcp/whitened_rows.h>

#include <bench/contact_families.h>
#include <gtest/gtest.h>
#include <random>
#include <tuple>
#include <vector>

namespace signorini::lcp {
namespace {

FactoredMatrix family(const char* name, int size) {
  return std::get<FactoredMatrix>(bench::make_family({name, size, 100.0}).M);
}

/// G, column by column.
Matrix dense_rows(const WhitenedRows& rows) {
  Matrix G(rows.rows(), rows.degrees_of_freedom());
  Vector column;
  for (Index j = 0; j < G.cols(); ++j) {
    rows.times(Vector::Unit(G.cols(), j), column);
    G.col(j) = column;
  }
  return G;
}

TEST(WhitenedRows, ScaledProductIsTheMatrix) {
  FactoredMatrix A = family("spheres", 40);
  A.add_row(0.5);  // a row of its own, compliance alone
  WhitenedRows rows;
  rows.set(A);
  const Matrix G = dense_rows(rows);
  const Matrix S = rows.scale().asDiagonal();
  const Matrix again = S * (G * G.transpose() + Matrix(rows.compliance().asDiagonal())) * S;
  const Matrix formed(A.form());
  EXPECT_LE((again - formed).cwiseAbs().maxCoeff(), 1e-14 * formed.cwiseAbs().maxCoeff());
  EXPECT_LE((G.rowwise().squaredNorm() + rows.compliance() - Vector::Ones(G.rows()))
                .cwiseAbs()
                .maxCoeff(),
            1e-14);
}

TEST(WhitenedRows, TransposeIsTheTranspose) {
  WhitenedRows rows;
  rows.set(family("wall", 3));
  const Matrix G = dense_rows(rows);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Vector x(G.rows());
  for (double& value : x) {
    value = normal(random);
  }
  Vector u;
  rows.transpose_times(x, u);
  EXPECT_LE((u - G.transpose() * x).cwiseAbs().maxCoeff(), 1e-14 * x.lpNorm<1>());
}

TEST(WhitenedRows, BodySpaceMatrixIsIdentityPlusWeightedSquares) {
  WhitenedRows rows;
  rows.set(family("pyramid2d", 4));
  const Matrix G = dense_rows(rows);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(0.0, 10.0);
  Vector d(G.rows());
  for (double& value : d) {
    value = uniform(random) < 3.0 ? 0.0 : uniform(random);
  }
  const Matrix H = Matrix(rows.body_space_matrix(d)).selfadjointView<Eigen::Lower>();
  const Matrix expected = Matrix::Identity(G.cols(), G.cols()) + G.transpose() * d.asDiagonal() * G;
  EXPECT_LE((H - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
}

/// `count` bodies in a ring, each moved by rows in `ranks` directions (of 6), one after the other;
/// `contacts` rows a pair, and one contact of a body with what does not move.
FactoredMatrix ring(const std::vector<int>& ranks, int contacts) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  FactoredMatrix A;
  std::vector<Matrix> directions;
  for (const int rank : ranks) {
    A.mass.add_inverse(Matrix::Identity(6, 6));
    directions.emplace_back(Matrix::NullaryExpr(6, rank, [&] { return normal(random); }));
  }
  const auto add = [&](int body) {
    const Vector parts =
        Vector::NullaryExpr(directions[body].cols(), [&] { return normal(random); });
    A.add_entry(body, directions[body] * parts);
  };
  const int count = static_cast<int>(ranks.size());
  for (int b = 0; b < count; ++b) {
    for (int k = 0; k < contacts; ++k) {
      A.add_row();
      add(b);
      add((b + 1) % count);
    }
  }
  for (int k = 0; k < contacts; ++k) {
    A.add_row();
    add(0);
  }
  return A;
}

TEST(WhitenedRows, AllRanksOfBodiesAlikeAndMixed) {
  const std::vector<std::vector<int>> all_ranks = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3},
                                                   {4, 4, 4}, {5, 5, 5}, {6, 6, 6},
                                                   {6, 5, 4}, {3, 6, 1}, {5, 2, 6}};
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> uniform(0.0, 10.0);
  for (const std::vector<int>& ranks : all_ranks) {
    for (const int contacts : {1, 2, 7, 12}) {
      const FactoredMatrix A = ring(ranks, contacts);
      WhitenedRows rows;
      rows.set(A);
      EXPECT_LE(rows.degrees_of_freedom(), ranks[0] + ranks[1] + ranks[2]);
      const Matrix G = dense_rows(rows);
      const Matrix S = rows.scale().asDiagonal();
      const Matrix formed(A.form());
      EXPECT_LE((S * G * G.transpose() * S - formed).cwiseAbs().maxCoeff(),
                1e-13 * formed.cwiseAbs().maxCoeff());
      const Vector x = Vector::NullaryExpr(G.rows(), [&] { return uniform(random); });
      Vector u;
      rows.transpose_times(x, u);
      EXPECT_LE((u - G.transpose() * x).cwiseAbs().maxCoeff(), 1e-14 * x.lpNorm<1>());
      const Matrix H = Matrix(rows.body_space_matrix(x)).selfadjointView<Eigen::Lower>();
      const Matrix expected =
          Matrix::Identity(G.cols(), G.cols()) + G.transpose() * x.asDiagonal() * G;
      EXPECT_LE((H - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff())
          << ranks[0] << ' ' << ranks[1] << ' ' << ranks[2] << ", " << contacts;
    }
  }
}

TEST(WeightedProduct, IsThatToTheBitOfEveryInstructionSet) {
  constexpr int kSize = WeightedProduct::kSize;
  constexpr int kWidth = 13;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const int rows : {0, 1, 2, 4, 9}) {
    const auto number = [&] { return normal(random); };
    const Matrix left = Matrix::NullaryExpr(kWidth, rows + 1, number);
    const Matrix right = Matrix::NullaryExpr(kWidth, rows + 1, number);
    const Vector d = Vector::NullaryExpr(rows, number);
    for (int columns = 0; columns <= kSize; ++columns) {
      Matrix wanted = Matrix::Zero(kSize, columns);
      for (int k = 0; k < rows; ++k) {
        for (int c = 0; c < columns; ++c) {
          for (int r = 0; r < kSize; ++r) {  // rounded before it is added
            const volatile double product = (left(2 + r, k) * d[k]) * right(1 + c, k);
            wanted(r, c) += product;
          }
        }
      }
      for (const WeightedProduct& set : weighted_products()) {
        Matrix block = Matrix::Constant(kSize, columns + 1, 7.0);
        set.multiply(block.data(), left.data() + 2, right.data() + 1, kWidth, kWidth, d.data(),
                     rows, columns);
        EXPECT_EQ(block.leftCols(columns), wanted) << set.name << ", " << rows << ", " << columns;
        EXPECT_EQ(block.col(columns), Vector::Constant(kSize, 7.0));
      }
    }
  }
}

/// Three rows a contact: the rows of a family as normals, and two more directions on its bodies.
FactoredMatrix contacts_of_three_rows(const char* name, int size) {
  const FactoredMatrix normals = family(name, size);
  FactoredMatrix A;
  A.mass = normals.mass;
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  for (int i = 0; i < normals.rows(); ++i) {
    for (int k = 0; k < 3; ++k) {
      A.add_row(k == 2 ? 0.1 : 0.0);
      for (const FactoredMatrix::Entry& entry : normals.entries(i)) {
        Vector values = Eigen::Map<const Vector>(normals.values(entry), 6);
        for (double& value : values) {
          value += k == 0 ? 0.0 : normal(random);
        }
        if (k < 2 || &entry == &normals.entries(i).front()) {  // one row misses a body
          A.add_entry(entry.block, values);
        }
      }
    }
  }
  return A;
}

TEST(WhitenedRows, BlockOfAGroupIsGTransposeDG) {
  const FactoredMatrix A = contacts_of_three_rows("spheres", 30);
  std::vector<int> starts;
  for (int i = 0; i <= A.rows(); i += 3) {
    starts.push_back(i);
  }
  WhitenedRows rows;
  rows.set(A, starts);
  const Matrix G = dense_rows(rows);
  std::mt19937_64 random(10);
  std::normal_distribution<double> normal;
  std::vector<double> blocks;
  Matrix D = Matrix::Zero(G.rows(), G.rows());
  for (int i = 0; i < A.rows(); i += 3) {
    const Matrix root = Matrix::NullaryExpr(3, 3, [&] { return normal(random); });
    const Matrix block = root * root.transpose();
    D.block(i, i, 3, 3) = block;
    blocks.insert(blocks.end(), block.data(), block.data() + 9);
  }
  const Matrix H = Matrix(rows.body_space_matrix(std::span<const double>(blocks)))
                       .selfadjointView<Eigen::Lower>();
  const Matrix expected = Matrix::Identity(G.cols(), G.cols()) + G.transpose() * D * G;
  EXPECT_LE((H - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
}

TEST(WhitenedRows, RowsOfAGroupShareTheScaleOfTheLongest) {
  const FactoredMatrix A = contacts_of_three_rows("wall", 2);
  std::vector<int> starts;
  for (int i = 0; i <= A.rows(); i += 3) {
    starts.push_back(i);
  }
  WhitenedRows rows;
  rows.set(A, starts);
  Vector diagonal;
  A.diagonal(diagonal);
  for (int i = 0; i < A.rows(); i += 3) {
    const double scale = std::sqrt(diagonal.segment(i, 3).maxCoeff());
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(rows.scale()[i + k], scale, 1e-14 * scale);
    }
  }
  const Matrix G = dense_rows(rows);
  const Matrix S = rows.scale().asDiagonal();
  const Matrix again = S * (G * G.transpose() + Matrix(rows.compliance().asDiagonal())) * S;
  const Matrix formed(A.form());
  EXPECT_LE((again - formed).cwiseAbs().maxCoeff(), 1e-14 * formed.cwiseAbs().maxCoeff());
}

TEST(WhitenedRows, DirectionsThatNoRowMovesAreLeftOut) {
  WhitenedRows rows;
  // Normals through the centres: no rotation. Vertical normals: a height and two tilts.
  for (const auto& [name, size, each] :
       {std::tuple("spheres", 100, 3), std::tuple("tower4", 12, 3), std::tuple("wall", 4, 5)}) {
    const FactoredMatrix A = family(name, size);
    rows.set(A);
    EXPECT_LE(rows.degrees_of_freedom(), each * A.mass.block_count()) << name;
    const Matrix G = dense_rows(rows);
    const Matrix S = rows.scale().asDiagonal();
    const Matrix formed(A.form());
    EXPECT_LE((S * G * G.transpose() * S - formed).cwiseAbs().maxCoeff(),
              2e-15 * formed.cwiseAbs().maxCoeff())
        << name;
  }
}

TEST(WhitenedRows, BodiesWithoutRowsAndRowsWithoutBodies) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(6, 6));
  A.add_row(2.0);
  WhitenedRows rows;
  rows.set(A);
  EXPECT_EQ(rows.degrees_of_freedom(), 0);
  EXPECT_DOUBLE_EQ(rows.scale()[0], std::sqrt(2.0));
  for (const std::string_view name : sparse_cholesky_names()) {
    const auto cholesky = make_sparse_cholesky(name);
    const SparseMatrix& none = rows.body_space_matrix(Vector::Ones(1));
    cholesky->analyse(none);
    EXPECT_TRUE(cholesky->factor(none)) << name;
    Vector nothing;
    cholesky->solve(nothing);
  }
}

TEST(WhitenedRows, RefusesGroupsThatAreNotAPartition) {
  const FactoredMatrix A = family("tower4", 2);
  WhitenedRows rows;
  EXPECT_THROW(rows.set(A, std::vector<int>{0, 4}), std::invalid_argument);
  EXPECT_THROW(rows.set(A, std::vector<int>{0, 4, 4, 8}), std::invalid_argument);
}

class SparseCholeskyBackEnd : public testing::TestWithParam<std::string_view> {};

TEST_P(SparseCholeskyBackEnd, SolvesWhatItFactored) {
  WhitenedRows rows;
  rows.set(family("spheres", 200));
  const auto cholesky = make_sparse_cholesky(GetParam());
  EXPECT_EQ(cholesky->name(), GetParam());
  cholesky->analyse(rows.body_space_matrix(Vector::Zero(rows.rows())));
  for (const double weight : {1.0, 1e6}) {
    const SparseMatrix& lower = rows.body_space_matrix(Vector::Constant(rows.rows(), weight));
    ASSERT_TRUE(cholesky->factor(lower));
    const Vector wanted = Vector::LinSpaced(lower.rows(), -1.0, 1.0);
    const Vector right = lower.selfadjointView<Eigen::Lower>() * wanted;
    Vector x = right;
    cholesky->solve(x);
    const Vector residual = lower.selfadjointView<Eigen::Lower>() * x - right;
    // A backward stable solve: the residual is some roundings of |H| |x|.
    EXPECT_LE(residual.cwiseAbs().maxCoeff(), 1e-13 * (1.0 + weight) * x.cwiseAbs().maxCoeff());
  }
}

TEST_P(SparseCholeskyBackEnd, RefusesAnIndefiniteMatrix) {
  SparseMatrix lower(2, 2);
  lower.insert(0, 0) = 1.0;
  lower.insert(1, 0) = 2.0;
  lower.insert(1, 1) = 1.0;
  lower.makeCompressed();
  const auto cholesky = make_sparse_cholesky(GetParam());
  cholesky->analyse(lower);
  EXPECT_FALSE(cholesky->factor(lower));
  lower.coeffRef(1, 1) = 5.0;
  EXPECT_TRUE(cholesky->factor(lower));
}

INSTANTIATE_TEST_SUITE_P(All, SparseCholeskyBackEnd,
                         testing::ValuesIn(sparse_cholesky_names().begin(),
                                           sparse_cholesky_names().end()),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(SparseCholesky, UnknownNameListsTheKnownOnes) {
  try {
    (void)make_sparse_cholesky("none");
    FAIL() << "an unknown back-end was made";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("eigen"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace signorini::lcp
