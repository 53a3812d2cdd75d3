#include <signorini/lcp/factored_matrix.h>
#include <signorini/lcp/mass_ratio.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <stdexcept>

namespace signorini::lcp {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Blocks of 1, 6, 3 and 8 degrees of freedom, masses and inverse masses mixed, and rows on none,
/// one, two and three of them; J and W beside it, dense.
struct Mixed {
  FactoredMatrix A;
  Matrix J;
  Matrix W;
  Vector compliance;

  explicit Mixed(unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const std::vector<int> sizes = {1, 6, 3, 8};
    W.setZero(18, 18);
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      Matrix G(sizes[b], sizes[b]);
      for (double& value : G.reshaped()) value = normal(random);
      const Matrix mass = G * G.transpose() + Matrix::Identity(sizes[b], sizes[b]);
      const Matrix inverse = mass.llt().solve(Matrix::Identity(sizes[b], sizes[b]));
      const Matrix symmetric = 0.5 * (inverse + inverse.transpose());
      const int block = b % 2 == 0 ? A.mass.add_mass(mass) : A.mass.add_inverse(symmetric);
      EXPECT_EQ(block, static_cast<int>(b));
      W.block(A.mass.offset(block), A.mass.offset(block), sizes[b], sizes[b]) = symmetric;
    }
    const std::vector<std::vector<int>> rows = {{0}, {1, 2}, {3, 1}, {}, {2, 0, 3}, {1}};
    J.setZero(static_cast<Index>(rows.size()), 18);
    compliance.setZero(J.rows());
    compliance[2] = 0.25;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(A.add_row(compliance[static_cast<Index>(i)]), static_cast<int>(i));
      for (const int block : rows[i]) {
        Vector values(sizes[block]);
        for (double& value : values) value = normal(random);
        A.add_entry(block, values);
        J.row(static_cast<Index>(i)).segment(A.mass.offset(block), sizes[block]) = values;
      }
    }
  }

  [[nodiscard]] Matrix dense() const {
    Matrix formed = J * W * J.transpose();
    formed.diagonal() += compliance;
    return formed;
  }
};

TEST(FactoredMatrix, FormsJWJTransposedPlusCompliance) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Mixed mixed(seed);
    const Matrix expected = mixed.dense();
    const Matrix formed(mixed.A.form());
    // Masses of condition below 1e4, sums of at most 8 x 8 products.
    const double bound = 1e4 * 64 * kEpsilon * expected.cwiseAbs().maxCoeff();
    EXPECT_LE((formed - expected).cwiseAbs().maxCoeff(), bound) << "seed " << seed;
    EXPECT_EQ(formed, formed.transpose());
    Vector d;
    mixed.A.diagonal(d);
    EXPECT_LE((d - expected.diagonal()).cwiseAbs().maxCoeff(), bound);
  }
}

TEST(FactoredMatrix, VisitsTheLowerTriangleOfWhatItForms) {
  FactoredMatrix::VisitWorkspace workspace;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Mixed mixed(seed);
    const Matrix formed(mixed.A.form());
    Matrix visited = Matrix::Constant(formed.rows(), formed.cols(), std::nan(""));
    mixed.A.visit_lower(workspace, [&visited](Index i, Index j, double a) {
      EXPECT_LE(j, i);
      EXPECT_TRUE(std::isnan(visited(i, j))) << "visited twice";
      visited(i, j) = a;
    });
    for (Index j = 0; j < formed.cols(); ++j) {
      EXPECT_FALSE(std::isnan(visited(j, j)));
      for (Index i = j; i < formed.rows(); ++i) {
        const double a = std::isnan(visited(i, j)) ? 0.0 : visited(i, j);
        EXPECT_NEAR(a, formed(i, j), 1e-13 * formed.cwiseAbs().maxCoeff());
      }
    }
  }
}

TEST(FactoredMatrix, MultipliesAsTheFormedMatrixDoes) {
  const Mixed mixed(3);
  const Vector z{{1.0, -2.0, 0.5, 3.0, 0.0, 4.0}};
  Vector w(6);
  mixed.A.multiply(z.data(), w.data());
  const std::vector<long double> wide_z(z.data(), z.data() + 6);
  std::vector<long double> wide_w(6);
  mixed.A.multiply(wide_z.data(), wide_w.data());
  const Vector expected = Matrix(mixed.A.form()) * z;
  for (Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(w[i], expected[i], 1e-11 * expected.cwiseAbs().maxCoeff());
    EXPECT_NEAR(static_cast<double>(wide_w[i]), expected[i],
                1e-11 * expected.cwiseAbs().maxCoeff());
  }
}

TEST(FactoredMatrix, RowWithoutEntriesIsItsComplianceAlone) {
  FactoredMatrix A;
  A.add_row(0.5);
  A.add_row();
  EXPECT_EQ(Matrix(A.form()), (Matrix{{0.5, 0.0}, {0.0, 0.0}}));
  EXPECT_EQ(A.degrees_of_freedom(), 0);
}

TEST(FactoredMatrix, ClearForgetsEverything) {
  Mixed mixed(1);
  mixed.A.clear();
  EXPECT_EQ(mixed.A.rows(), 0);
  EXPECT_EQ(mixed.A.degrees_of_freedom(), 0);
  EXPECT_EQ(mixed.A.mass.add_inverse(Matrix::Identity(2, 2)), 0);
  EXPECT_EQ(mixed.A.add_row(), 0);
  mixed.A.add_entry(0, Vector{{3.0, 4.0}});
  EXPECT_EQ(Matrix(mixed.A.form()), (Matrix{{25.0}}));
}

template <typename Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(FactoredMatrix, RefusesWrongRowsAndNamesThem) {
  FactoredMatrix A;
  EXPECT_NE(message_of([&] { A.add_entry(0, Vector{{1.0}}); }).find("before the first"),
            std::string::npos);
  A.mass.add_inverse(Matrix::Identity(2, 2));
  EXPECT_NE(message_of([&] { A.add_row(-1e-9); }).find("got -1e-09"), std::string::npos);
  EXPECT_NE(message_of([&] { A.add_row(std::nan("")); }).find("got nan"), std::string::npos);
  EXPECT_EQ(A.rows(), 0);
  A.add_row();
  EXPECT_NE(message_of([&] {
              A.add_entry(1, Vector{{1.0, 0.0}});
            }).find("block 1"),
            std::string::npos);
  EXPECT_NE(message_of([&] { A.add_entry(0, Vector{{1.0}}); }).find("1 values for block 0"),
            std::string::npos);
  A.add_entry(0, Vector{{1.0, 2.0}});
  EXPECT_NE(message_of([&] {
              A.add_entry(0, Vector{{1.0, 2.0}});
            }).find("given twice"),
            std::string::npos);
  EXPECT_EQ(A.entries(0).size(), 1U);
}

TEST(BlockMass, RefusesWrongBlocksAndNamesWhy) {
  BlockMass mass;
  EXPECT_NE(message_of([&] { mass.add_mass(Matrix(2, 3)); }).find("2 x 3"), std::string::npos);
  EXPECT_NE(message_of([&] { mass.add_mass(Matrix(0, 0)); }).find("not empty"), std::string::npos);
  EXPECT_NE(message_of([&] { mass.add_mass(Matrix{{-1.0}}); }).find("positive definite"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              mass.add_mass(Matrix{{1.0, 0.5}, {0.4, 1.0}});
            }).find("symmetric"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              mass.add_inverse(Matrix{{1.0, 0.5}, {0.4, 1.0}});
            }).find("symmetric"),
            std::string::npos);
  EXPECT_NE(message_of([&] { mass.add_inverse(Matrix{{-2.0}}); }).find("got -2"),
            std::string::npos);
  EXPECT_NE(message_of([&] { mass.add_inverse(Matrix{{std::nan("")}}); }).find("finite"),
            std::string::npos);
  EXPECT_EQ(mass.block_count(), 0);
}

TEST(BlockMass, AppliesAMassAndItsInverseAlike) {
  const Matrix M{{4.0, 1.0, 0.0}, {1.0, 3.0, 0.5}, {0.0, 0.5, 2.0}};
  BlockMass mass;
  mass.add_mass(M);
  mass.add_inverse(M.llt().solve(Matrix::Identity(3, 3)));
  const Vector x{{1.0, -2.0, 3.0}};
  Vector by_mass(3);
  Vector by_inverse(3);
  mass.apply_inverse(0, x.data(), by_mass.data());
  mass.apply_inverse(1, x.data(), by_inverse.data());
  EXPECT_LE((by_mass - by_inverse).norm(), 100 * kEpsilon * by_mass.norm());
  EXPECT_LE((M * by_mass - x).norm(), 100 * kEpsilon * x.norm());
  EXPECT_EQ(mass.offset(1), 3);
  EXPECT_EQ(mass.degrees_of_freedom(), 6);
}

TEST(MassRatio, IsThatOfTheFirstDegreesOfFreedomHoweverBlocksAreGiven) {
  BlockMass mass;
  EXPECT_EQ(mass_ratio(mass), 1.0);
  mass.add_inverse(Matrix{{0.5}});
  EXPECT_EQ(mass_ratio(mass), 1.0);
  mass.add_mass(Matrix{{8.0, 0.0}, {0.0, 1e6}});
  EXPECT_NEAR(mass_ratio(mass), 4.0, 4.0 * 4.0 * kEpsilon);
  mass.add_inverse(Matrix{{0.0}});  // moves under no force
  EXPECT_EQ(mass_ratio(mass), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace signorini::lcp
