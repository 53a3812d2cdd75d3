#pragma once

#include <signorini/lcp/problem.h>

#include <random>

namespace signorini::lcp {

/// What a random factored problem is to have.
struct SweepProblemSpec {
  int bodies = 7;
  int rows = 40;
  int rows_a_pair = 1;        ///< consecutive rows on the same blocks
  bool articulated = false;   ///< rows on up to three blocks of sizes 1, 6 and 12
  bool compliant = false;     ///< every third row
  bool bounded = false;       ///< a free, a boxed and a one-sided row in turn
  bool coupled = false;       ///< a normal row and two tangent rows in turn
  bool semidefinite = false;  ///< every third W_k has rank dimension - 1
  unsigned seed = 1;
};

/// Redundant where rows > degrees of freedom. Without bounds and coupling it has a solution.
inline Problem sweep_problem(const SweepProblemSpec& spec) {
  std::mt19937_64 random(spec.seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  FactoredMatrix A;
  for (int b = 0; b < spec.bodies; ++b) {
    constexpr int kSizes[] = {6, 1, 12};
    const int d = spec.articulated ? kSizes[b % 3] : b % 4 == 3 ? 3 : 6;
    const Matrix root = Matrix::NullaryExpr(d, d, [&] { return uniform(random); });
    Matrix positive = root * root.transpose() + Matrix::Identity(d, d);
    positive = (0.5 * (positive + positive.transpose())).eval();
    if (spec.semidefinite && b % 3 == 0) {
      positive.row(0).setZero();
      positive.col(0).setZero();
      A.mass.add_inverse(positive);
    } else {
      b % 2 == 0 ? A.mass.add_mass(positive) : A.mass.add_inverse(positive);
    }
  }
  const auto body = [&] { return static_cast<int>(random() % spec.bodies); };
  int blocks[3] = {};
  for (int i = 0; i < spec.rows; ++i) {
    A.add_row(spec.compliant && i % 3 == 0 ? 0.1 : 0.0);
    if (i % spec.rows_a_pair == 0) {
      for (int& block : blocks) {
        block = body();
      }
    }
    const int most = spec.articulated ? 3 : 2;
    for (int k = 0; k < most; ++k) {
      bool is_new = true;
      for (int l = 0; l < k; ++l) {
        is_new = is_new && blocks[l] != blocks[k];
      }
      if (is_new) {
        A.add_entry(blocks[k], Vector::NullaryExpr(A.mass.dimension(blocks[k]),
                                                   [&] { return uniform(random); }));
      }
    }
  }
  Problem problem;
  Vector z = Vector::Zero(spec.rows);
  Vector w = Vector::Zero(spec.rows);
  for (int i = 0; i < spec.rows; ++i) {
    (random() % 2 == 0 ? z : w)[i] = 0.1 + std::abs(uniform(random));
  }
  Vector product(spec.rows);
  A.multiply(z.data(), product.data());
  problem.q = w - product;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (spec.bounded) {
    problem.lower = Vector::Zero(spec.rows);
    problem.upper = Vector::Constant(spec.rows, kInfinity);
    for (int i = 0; i < spec.rows; ++i) {
      if (i % 3 == 0) problem.lower[i] = -kInfinity;
      if (i % 3 == 1) problem.lower[i] = -0.2;
      if (i % 3 == 1) problem.upper[i] = 0.3;
    }
  }
  for (int i = 0; spec.coupled && i + 2 < spec.rows; i += 3) {
    problem.limits.push_back({i + 1, i, 0.3});
    problem.limits.push_back({i + 2, i, 0.3});
  }
  problem.M = std::move(A);
  return problem;
}

}  // namespace signorini::lcp
