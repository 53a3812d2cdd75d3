#include <signorini/lcp/absolute_product.h>

#include "allocation_count.h"
#include "bench/contact_families.h"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace signorini::lcp {
namespace {

/// z with zeros, some of them over whole pairs.
Vector some_z(Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Vector z = Vector::NullaryExpr(n, [&] { return std::abs(normal(random)); });
  for (Index i = 0; i < n; ++i) {
    z[i] = (i / 7) % 3 == 0 || i % 5 == 0 ? 0.0 : z[i];
  }
  return z;
}

void expect_that_of(AbsoluteProduct& absolute, const FactoredMatrix& A, unsigned seed) {
  const Vector z = some_z(A.rows(), seed);
  Vector product = Vector::Constant(A.rows(), -1.0);
  Vector diagonal;
  ASSERT_TRUE(absolute.compute(A, {z.data(), static_cast<std::size_t>(z.size())},
                               {product.data(), static_cast<std::size_t>(z.size())}, diagonal));
  const Matrix formed(A.form());
  const Vector wanted = formed.cwiseAbs() * z;
  EXPECT_LE((product - wanted).cwiseAbs().maxCoeff(), 1e-13 * wanted.maxCoeff());
  EXPECT_LE((diagonal - formed.diagonal()).cwiseAbs().maxCoeff(), 1e-13 * diagonal.maxCoeff());
}

TEST(AbsoluteProduct, IsThatOfTheFormedMatrixOfFamilies) {
  AbsoluteProduct absolute;  // one for all: what it kept must not show
  for (const auto& [name, size] : {std::pair{"tower8", 5},
                                   {"tower4", 1},
                                   {"wall", 4},
                                   {"pyramid3d", 3},
                                   {"pyramid2d", 6},
                                   {"tower4", 3}}) {
    const Problem problem = bench::make_family({.family = name, .size = size, .mass_ratio = 1e3});
    expect_that_of(absolute, std::get<FactoredMatrix>(problem.M), 1);
  }
}

/// Blocks of any size, masses and inverse masses, bundles longer than a product has lanes, rows
/// that come back to a pair, rows on three blocks and on none, compliance.
TEST(AbsoluteProduct, IsThatOfTheFormedMatrixOfMixedBlocks) {
  AbsoluteProduct absolute;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    FactoredMatrix A;
    for (const int d : {6, 1, 11, 3}) {
      const Matrix G = Matrix::NullaryExpr(d, d, [&] { return normal(random); });
      const Matrix mass = G * G.transpose() + Matrix::Identity(d, d);
      (seed + d) % 2 == 0 ? A.mass.add_mass(mass) : A.mass.add_inverse(mass);
    }
    const std::vector<std::pair<std::vector<int>, int>> bundles = {
        {{0, 2}, 4}, {{0, 3}, 21}, {{}, 3}, {{2, 0}, 5}, {{1}, 1}, {{3, 1, 2}, 9}, {{0, 2}, 8}};
    for (const auto& [blocks, rows] : bundles) {
      for (int r = 0; r < rows; ++r) {
        A.add_row(r % 3 == 0 ? 0.5 : 0.0);
        for (const int block : blocks) {
          A.add_entry(block,
                      Vector::NullaryExpr(A.mass.dimension(block), [&] { return normal(random); }));
        }
      }
    }
    expect_that_of(absolute, A, seed);
  }
}

TEST(AbsoluteProduct, LeavesRowsThatShareNoPairAlone) {
  const Problem problem = bench::make_family({.family = "spheres", .size = 40});
  const Vector z = Vector::Ones(problem.size());
  Vector product = Vector::Constant(problem.size(), -1.0);
  Vector diagonal;
  AbsoluteProduct absolute;
  EXPECT_FALSE(absolute.compute(std::get<FactoredMatrix>(problem.M),
                                {z.data(), static_cast<std::size_t>(z.size())},
                                {product.data(), static_cast<std::size_t>(z.size())}, diagonal));
  EXPECT_EQ(product, Vector::Constant(problem.size(), -1.0));
  EXPECT_EQ(diagonal.size(), 0);
}

TEST(AbsoluteProduct, AllocatesNothingTheSecondTime) {
  const Problem problem = bench::make_family({.family = "wall", .size = 6});
  const auto& A = std::get<FactoredMatrix>(problem.M);
  const Vector z = some_z(A.rows(), 3);
  Vector product(A.rows());
  Vector diagonal;
  AbsoluteProduct absolute;
  const auto compute = [&] {
    return absolute.compute(A, {z.data(), static_cast<std::size_t>(z.size())},
                            {product.data(), static_cast<std::size_t>(z.size())}, diagonal);
  };
  ASSERT_TRUE(compute());
  const AllocationCount allocations;
  ASSERT_TRUE(compute());
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace signorini::lcp
