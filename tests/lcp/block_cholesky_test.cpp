#include <signorini/lcp/block_cholesky.h>
#include <signorini/lcp/whitened_rows.h>

#include "random_block_matrix.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bench/contact_families.h>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace signorini::lcp {
namespace {

class EveryInstructionSet : public testing::TestWithParam<DenseKernels> {};

std::string set_name(const testing::TestParamInfo<DenseKernels>& tested) {
  return std::string(tested.param.name);
}

Matrix random_definite(Index n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Matrix root = Matrix::NullaryExpr(n, n, [&] { return normal(random); });
  return root * root.transpose() + Matrix::Identity(n, n);
}

int padded(int rows) {
  return (rows + DenseKernels::kPadding - 1) / DenseKernels::kPadding * DenseKernels::kPadding;
}

/// Every size of panel and of what is below it around the widths of the vectors and tiles.
TEST_P(EveryInstructionSet, PanelTimesItsTransposeAndTheRestGiveTheMatrix) {
  const DenseKernels& kernels = GetParam();
  for (const int columns : {1, 2, 3, 5, 7, 8, 9, 16, 23, 140}) {
    for (const int below : {0, 1, 3, 8, 9, 15, 17, 25, 31, 70}) {
      const int rows = columns + below;
      const Matrix A = random_definite(rows, 100 * columns + below);
      const int ld = padded(rows);
      const int ld_square = padded(below);
      std::vector<double> panel(ld * columns + DenseKernels::kPadding, 0.0);
      std::vector<double> square(ld_square * below + DenseKernels::kPadding, 0.0);
      for (int c = 0; c < columns; ++c) {
        std::copy_n(A.col(c).data() + c, rows - c, panel.data() + c * ld + c);
      }
      ASSERT_TRUE(kernels.factor(panel.data(), ld, rows, columns));
      kernels.subtract_product(square.data(), ld_square, panel.data() + columns,
                               panel.data() + columns, ld, below, columns);
      Matrix L = Matrix::Zero(rows, columns);
      for (int c = 0; c < columns; ++c) {
        std::copy_n(panel.data() + c * ld + c, rows - c, L.col(c).data() + c);
      }
      const Matrix product = L * L.transpose();
      const double size = A.cwiseAbs().maxCoeff();
      EXPECT_LE((A - product).leftCols(columns).cwiseAbs().maxCoeff(), 1e-14 * rows * size)
          << rows << " x " << columns;
      for (int c = 0; c < below; ++c) {
        for (int r = c; r < below; ++r) {
          EXPECT_NEAR(square[c * ld_square + r], -product(columns + r, columns + c),
                      1e-14 * rows * size);
        }
      }
      // Substitution, forward and back, against the triangle itself.
      const Vector b = Vector::LinSpaced(rows, -1.0, 2.0);
      std::vector<double> x(b.begin(), b.end());
      x.resize(rows + DenseKernels::kPadding);
      std::vector<double> rest(x.begin() + columns, x.end());
      const Vector inverse = L.topRows(columns).diagonal().cwiseInverse();
      kernels.forward(panel.data(), ld, rows, columns, inverse.data(), x.data(), rest.data());
      Vector wanted = b;
      const auto L11 = L.topRows(columns).triangularView<Eigen::Lower>();
      wanted.head(columns) = L11.solve(Vector(b.head(columns)));
      wanted.tail(below) -= L.bottomRows(below) * wanted.head(columns);
      for (int i = 0; i < rows; ++i) {
        EXPECT_NEAR(i < columns ? x[i] : rest[i - columns], wanted[i], 1e-11 * rows);
      }
      Vector back = wanted.head(columns) - L.bottomRows(below).transpose() * wanted.tail(below);
      back = L.topRows(columns).transpose().triangularView<Eigen::Upper>().solve(back);
      kernels.backward(panel.data(), ld, rows, columns, inverse.data(), x.data(), rest.data());
      for (int i = 0; i < columns; ++i) {
        EXPECT_NEAR(x[i], back[i], 1e-10 * rows * (1.0 + back.cwiseAbs().maxCoeff()));
      }
    }
  }
}

TEST_P(EveryInstructionSet, RefusesPivotsThatAreNotPositive) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    for (int at = 0; at < 20; ++at) {
      std::vector<double> panel(24 * 20 + DenseKernels::kPadding, 0.0);
      for (int c = 0; c < 20; ++c) {
        panel[c * 24 + c] = c == at ? bad : 1.0;
      }
      EXPECT_FALSE(GetParam().factor(panel.data(), 24, 20, 20)) << bad << " at " << at;
    }
  }
}

TEST_P(EveryInstructionSet, SolvesAContactProblem) {
  for (const auto& [name, size] :
       {std::pair("spheres", 300), std::pair("wall", 7), std::pair("tower8", 20)}) {
    WhitenedRows rows;
    rows.set(std::get<FactoredMatrix>(bench::make_family({name, size}).M));
    const SparseMatrix& lower = rows.body_space_matrix(Vector::Constant(rows.rows(), 100.0));
    BlockCholesky cholesky(GetParam());
    cholesky.analyse(lower);
    ASSERT_TRUE(cholesky.factor(lower));
    const Vector right = Vector::LinSpaced(lower.rows(), -1.0, 1.0);
    Vector x = right;
    cholesky.solve(x);
    const Vector residual = lower.selfadjointView<Eigen::Lower>() * x - right;
    EXPECT_LE(residual.cwiseAbs().maxCoeff(), 1e-12) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryInstructionSet,
                         testing::ValuesIn(dense_kernels().begin(), dense_kernels().end()),
                         set_name);

/// The lower triangle of a diagonally dominant matrix.
SparseMatrix random_lower(int blocks, double edges, std::uint64_t seed) {
  return random_block_matrix(blocks, edges, 30.0 * edges, seed).triangularView<Eigen::Lower>();
}

TEST(BlockCholesky, SolvesRandomGraphs) {
  for (int seed = 1; seed <= 60; ++seed) {
    const SparseMatrix lower = random_lower(1 + 3 * seed, 1.0 + seed % 5, seed);
    BlockCholesky cholesky;
    cholesky.analyse(lower);
    ASSERT_TRUE(cholesky.factor(3.0 * lower));  // of which nothing may stay
    ASSERT_TRUE(cholesky.factor(lower)) << "seed " << seed;
    const Vector wanted = Vector::LinSpaced(lower.rows(), -1.0, 1.0);
    Vector x = lower.selfadjointView<Eigen::Lower>() * wanted;
    cholesky.solve(x);
    EXPECT_LE((x - wanted).cwiseAbs().maxCoeff(), 1e-12) << "seed " << seed;
  }
}

TEST(BlockCholesky, FillIsWithinTheRelaxationOfTheSimplicialFactor) {
  for (const auto& [name, size] :
       {std::pair("spheres", 600), std::pair("pyramid2d", 12), std::pair("pyramid3d", 6)}) {
    WhitenedRows rows;
    rows.set(std::get<FactoredMatrix>(bench::make_family({name, size}).M));
    const SparseMatrix& lower = rows.body_space_matrix(Vector::Zero(rows.rows()));
    const auto simplicial = make_sparse_cholesky("eigen");
    simplicial->analyse(lower);
    ASSERT_TRUE(simplicial->factor(lower));
    BlockCholesky cholesky;
    cholesky.analyse(lower);
    EXPECT_LE(cholesky.counts().entries, 1.6 * simplicial->counts().entries) << name;
    EXPECT_GT(cholesky.counts().bytes, 8 * cholesky.counts().entries);
  }
}

/// The grid of so many nodes a side in 1, 2 or 3 dimensions.
Graph grid(int side, int dimensions) {
  Graph graph;
  const int nodes = static_cast<int>(std::lround(std::pow(side, dimensions)));
  for (int k = 0; k < nodes; ++k) {
    std::vector<int> neighbours;
    for (int d = 0, step = 1; d < dimensions; ++d, step *= side) {
      const int at = k / step % side;
      if (at > 0) neighbours.push_back(k - step);
      if (at + 1 < side) neighbours.push_back(k + step);
    }
    std::ranges::sort(neighbours);
    graph.neighbours.insert(graph.neighbours.end(), neighbours.begin(), neighbours.end());
    graph.start.push_back(static_cast<int>(graph.neighbours.size()));
    graph.weight.push_back(1 + k % 3);
  }
  return graph;
}

TEST(NestedDissection, OrdersEveryNodeOnce) {
  NestedDissection dissection;
  for (const auto& [side, dimensions] :
       {std::pair(0, 1), {1, 1}, {700, 1}, {30, 2}, {9, 3}, {120, 1}}) {
    Graph graph = grid(side, dimensions);
    // And two parts that do not touch.
    const int n = graph.nodes();
    Graph twice = graph;
    for (int k = 0; k < n; ++k) {
      for (int e = graph.start[k]; e < graph.start[k + 1]; ++e) {
        twice.neighbours.push_back(n + graph.neighbours[e]);
      }
      twice.start.push_back(static_cast<int>(twice.neighbours.size()));
      twice.weight.push_back(1);
    }
    for (const Graph* one : {&graph, &twice}) {
      std::vector<int> order;
      dissection.order(*one, order);
      std::ranges::sort(order);
      std::vector<int> all(one->nodes());
      std::iota(all.begin(), all.end(), 0);
      EXPECT_EQ(order, all) << side << "^" << dimensions;
    }
  }
}

TEST(VertexSeparator, NoEdgeJoinsTheParts) {
  VertexSeparator separator;
  std::vector<CutSide> side;
  for (const auto& [nodes, dimensions] : {std::pair(200, 1), {25, 2}, {40, 2}, {11, 3}}) {
    const Graph graph = grid(nodes, dimensions);
    ASSERT_TRUE(separator.find(graph, side)) << nodes << "^" << dimensions;
    int weight[3] = {0, 0, 0};
    for (int k = 0; k < graph.nodes(); ++k) {
      weight[static_cast<int>(side[k])] += graph.weight[k];
      for (int e = graph.start[k]; e < graph.start[k + 1]; ++e) {
        const CutSide other = side[graph.neighbours[e]];
        EXPECT_TRUE(side[k] == other || side[k] == CutSide::kSeparator ||
                    other == CutSide::kSeparator);
      }
    }
    const int total = weight[0] + weight[1] + weight[2];
    EXPECT_LE(std::max(weight[0], weight[1]), 0.6 * total);
    // A plane across the grid has nodes^(dimensions - 1) nodes of weight 2.
    EXPECT_LE(weight[2], 1.5 * 2.0 * std::pow(nodes, dimensions - 1) + 1.0)
        << nodes << "^" << dimensions;
  }
}

TEST(NestedDissection, BeatsMinimumDegreeInSpaceAndNotOnALine) {
  NestedDissection dissection;
  const auto flops = [&](const Graph& graph, bool dissect) {
    std::vector<int> order;
    dissect ? dissection.order(graph, order) : order_by_minimum_degree(graph, order);
    Supernodes supernodes;
    supernodes.analyse(graph, order);
    return supernodes.flops(graph);
  };
  const Graph cube = grid(18, 3);
  EXPECT_LT(flops(cube, true), 0.8 * flops(cube, false));
  const Graph line = grid(1000, 1);
  EXPECT_GE(flops(line, true), 0.9 * flops(line, false));
}

TEST(Supernodes, EveryColumnOfTheFactorIsInsideItsPanel) {
  const SparseMatrix lower = random_lower(60, 2.0, 5);
  Graph graph;
  const Index n = lower.rows();
  std::vector<std::vector<int>> neighbours(n);
  for (int j = 0; j < n; ++j) {
    for (SparseMatrix::InnerIterator it(lower, j); it; ++it) {
      if (it.row() != j) {
        neighbours[j].push_back(static_cast<int>(it.row()));
        neighbours[it.row()].push_back(j);
      }
    }
  }
  for (auto& list : neighbours) {
    std::ranges::sort(list);
    graph.neighbours.insert(graph.neighbours.end(), list.begin(), list.end());
    graph.start.push_back(static_cast<int>(graph.neighbours.size()));
    graph.weight.push_back(1);
  }
  std::vector<int> order;
  order_by_minimum_degree(graph, order);
  Supernodes supernodes;
  supernodes.analyse(graph, order);
  std::vector<int> sorted = supernodes.order;
  std::ranges::sort(sorted);
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
  // Eliminate, densely, and look where the factor is not zero.
  Matrix filled = Matrix::Zero(n, n);
  std::vector<int> place(n);
  for (int k = 0; k < n; ++k) {
    place[supernodes.order[k]] = k;
  }
  for (int j = 0; j < n; ++j) {
    for (const int i : neighbours[j]) {
      filled(place[i], place[j]) = 1.0;
    }
  }
  for (int k = 0; k < n; ++k) {
    for (int i = k + 1; i < n; ++i) {
      for (int j = k + 1; j < n && filled(i, k) != 0.0; ++j) {
        filled(i, j) = filled(j, k) != 0.0 ? 1.0 : filled(i, j);
      }
    }
  }
  for (int s = 0; s < supernodes.count(); ++s) {
    std::vector<bool> inside(n, false);
    for (int k = supernodes.first_pivot[s]; k < supernodes.first_pivot[s + 1]; ++k) {
      inside[k] = true;
    }
    for (int k = supernodes.row_start[s]; k < supernodes.row_start[s + 1]; ++k) {
      inside[supernodes.rows[k]] = true;
      EXPECT_GE(supernodes.rows[k], supernodes.first_pivot[s + 1]);
    }
    for (int j = supernodes.first_pivot[s]; j < supernodes.first_pivot[s + 1]; ++j) {
      for (int i = j + 1; i < n; ++i) {
        EXPECT_TRUE(filled(i, j) == 0.0 || inside[i]) << i << ", " << j;
      }
    }
  }
}

TEST(BlockCholesky, SamePatternAgainAndAnotherPattern) {
  BlockCholesky cholesky;
  const SparseMatrix one = random_lower(30, 2.0, 1);
  const SparseMatrix other = random_lower(50, 2.0, 2);
  for (const SparseMatrix* lower : {&one, &one, &other, &one}) {
    cholesky.analyse(*lower);
    ASSERT_TRUE(cholesky.factor(*lower));
    const Vector wanted = Vector::LinSpaced(lower->rows(), 1.0, 2.0);
    Vector x = lower->selfadjointView<Eigen::Lower>() * wanted;
    cholesky.solve(x);
    EXPECT_LE((x - wanted).cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace signorini::lcp
