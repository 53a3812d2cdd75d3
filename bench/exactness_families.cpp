#include "bench/exactness_families.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace signorini::bench {
namespace {

using lcp::FactoredMatrix;
using lcp::Index;
using lcp::Matrix;
using lcp::Problem;
using lcp::SparseMatrix;
using lcp::Vector;

constexpr int kMostRows = 12;

Problem dense(const Matrix& M, const Vector& q) {
  return {.M = M, .q = q, .lower = {}, .upper = {}, .limits = {}};
}

/// The same problem with M dense or sparse.
Problem dense_or_sparse(Draw& draw, const Matrix& M, const Vector& q) {
  Problem problem = dense(M, q);
  if (draw.coin()) {
    problem.M = SparseMatrix(M.sparseView());
  }
  return problem;
}

Matrix gram(const Matrix& G) {
  return G.transpose() * G;
}

Matrix skew(Draw& draw, Index n, int most) {
  const Matrix S = draw.matrix(n, n, most).triangularView<Eigen::StrictlyUpper>();
  return S - S.transpose();
}

Vector non_negative(Draw& draw, Index n, int most, int percent_zero) {
  Vector z(n);
  for (double& value : z) {
    value = draw.integer(1, 100) <= percent_zero ? 0 : draw.integer(1, most);
  }
  return z;
}

/// q for which a random complementary pair solves the LCP.
Vector solvable(Draw& draw, const Matrix& M, int percent_zero) {
  const Index n = M.rows();
  Vector z = non_negative(draw, n, 3, percent_zero);
  Vector w = non_negative(draw, n, 3, percent_zero);
  for (Index i = 0; i < n; ++i) {
    (draw.coin() ? z : w)[i] = 0.0;
  }
  return w - M * z;
}

/// Small G of random rank.
Matrix low_rank_factor(Draw& draw, int most) {
  const int n = draw.integer(1, kMostRows);
  return draw.matrix(draw.integer(1, n), n, most);
}

Problem semidefinite(Draw& draw) {
  const Matrix G = low_rank_factor(draw, 3);
  return dense_or_sparse(draw, gram(G), draw.vector(G.cols(), 5));
}

Problem semidefinite_solvable(Draw& draw) {
  const Matrix M = gram(low_rank_factor(draw, 3));
  return dense_or_sparse(draw, M, solvable(draw, M, 20));
}

Problem semidefinite_degenerate(Draw& draw) {
  const Matrix M = gram(low_rank_factor(draw, 1));
  return dense_or_sparse(draw, M, solvable(draw, M, 70));
}

/// Contacts given several times, as the corners of a box are: equal rows and equal q.
Problem repeated_contacts(Draw& draw) {
  const int distinct = draw.integer(1, 5);
  const int n = draw.integer(distinct, kMostRows);
  const Matrix G = draw.matrix(draw.integer(1, 6), distinct, 2);
  const Vector q = draw.vector(distinct, 3);
  Matrix repeated(G.rows(), n);
  Vector repeated_q(n);
  for (int j = 0; j < n; ++j) {
    const int source = j < distinct ? j : draw.integer(0, distinct - 1);
    repeated.col(j) = G.col(source);
    repeated_q[j] = q[source];
  }
  return dense_or_sparse(draw, gram(repeated), repeated_q);
}

Problem semidefinite_nonsymmetric(Draw& draw) {
  const Matrix G = low_rank_factor(draw, 2);
  const Matrix M = gram(G) + skew(draw, G.cols(), 2);
  return dense_or_sparse(draw, M, draw.vector(G.cols(), 5));
}

/// Impacts as core states them: J integer, W dyadic, q = J v; the matrix is not formed.
Problem impact_rows(Draw& draw) {
  FactoredMatrix A;
  const int bodies = draw.integer(1, 3);
  const int dimension = draw.integer(1, 3);
  Vector velocity = draw.vector(bodies * dimension, 3);
  for (int b = 0; b < bodies; ++b) {
    Vector inverse_mass(dimension);
    std::generate(inverse_mass.begin(), inverse_mass.end(), [&] { return draw.dyadic(); });
    if (draw.coin()) {
      A.mass.add_inverse(inverse_mass.asDiagonal().toDenseMatrix());
    } else {  // 1 or 4: the Cholesky factor is exact
      const double root = draw.integer(1, 2);
      A.mass.add_mass(Matrix::Identity(dimension, dimension) * root * root);
    }
  }
  const int n = draw.integer(1, kMostRows);
  Vector q(n);
  for (int i = 0; i < n; ++i) {
    A.add_row();
    const int a = draw.integer(0, bodies - 1);
    const int b = draw.integer(0, bodies - 1);
    const Vector J = draw.vector(dimension, 2);
    A.add_entry(a, J);
    q[i] = J.dot(velocity.segment(a * dimension, dimension));
    if (b != a) {
      A.add_entry(b, -J);
      q[i] -= J.dot(velocity.segment(b * dimension, dimension));
    }
  }
  return {.M = A, .q = q, .lower = {}, .upper = {}, .limits = {}};
}

Problem p_triangular(Draw& draw) {
  const int n = draw.integer(1, kMostRows);
  Matrix M = draw.matrix(n, n, 2).triangularView<Eigen::StrictlyUpper>();
  for (int i = 0; i < n; ++i) {
    M(i, i) = draw.integer(1, 3);
  }
  if (draw.coin()) {
    M.transposeInPlace();
  }
  return dense_or_sparse(draw, M, draw.vector(n, 5));
}

/// Murty's matrices, on which the path from d = (1, .., 1) has up to 2^n pivots.
Problem p_murty(Draw& draw) {
  const int n = draw.integer(1, kMostRows);
  Matrix M = Matrix::Identity(n, n);
  M.triangularView<Eigen::StrictlyLower>().setConstant(2.0);
  if (draw.coin()) {
    M.transposeInPlace();
  }
  return dense(M, draw.coin() ? Vector(Vector::Constant(n, -1.0)) : draw.vector(n, 3));
}

Problem p_definite(Draw& draw) {
  const Matrix G = low_rank_factor(draw, 2);
  const Index n = G.cols();
  const Matrix M = gram(G) + Matrix::Identity(n, n) + skew(draw, n, 4);
  return dense_or_sparse(draw, M, draw.vector(n, 8));
}

Problem p_dominant(Draw& draw) {
  const int n = draw.integer(1, kMostRows);
  Matrix M = draw.matrix(n, n, 2);
  for (int i = 0; i < n; ++i) {
    M(i, i) = 0.0;
    M(i, i) = M.row(i).cwiseAbs().sum() + draw.integer(1, 2);
  }
  return dense_or_sparse(draw, M, draw.vector(n, 6));
}

/// The pyramid friction LCP, rows (normal, tangential directions in opposite pairs, slip) of each
/// contact: M = [A_nn A_nt 0; A_tn A_tt E; mu -E^T 0], q = (J v + gap, J v, 0).
Problem friction(Draw& draw, bool is_free) {
  const int directions = draw.coin() ? 2 : 4;
  const int rows_each = directions + 2;
  const int contacts = draw.integer(1, kMostRows / rows_each);
  const int bodies = draw.integer(1, 2);
  const int freedoms = 3 * bodies;
  const int n = contacts * rows_each;
  Matrix J = Matrix::Zero(n, freedoms);
  Matrix coupling = Matrix::Zero(n, n);
  for (int c = 0; c < contacts; ++c) {
    const int first = c * rows_each;
    const int slip = first + rows_each - 1;
    J.row(first) = draw.vector(freedoms, 2).transpose();
    for (int k = 0; k < directions; k += 2) {
      J.row(first + 1 + k) = draw.vector(freedoms, 2).transpose();
      J.row(first + 2 + k) = -J.row(first + 1 + k);
    }
    constexpr std::array kFriction = {0.0, 0.25, 0.5, 1.0, 2.0};
    coupling(slip, first) = kFriction[draw.integer(0, 4)];
    for (int k = 1; k <= directions; ++k) {
      coupling(first + k, slip) = 1.0;
      coupling(slip, first + k) = -1.0;
    }
  }
  Vector inverse_mass(freedoms);
  std::generate(inverse_mass.begin(), inverse_mass.end(), [&] { return draw.dyadic(); });
  Vector q = J * draw.vector(freedoms, 3);
  for (int c = 0; c < contacts; ++c) {
    const int first = c * rows_each;
    q[first] += draw.coin() ? draw.integer(0, 2) : 0;
    if (!is_free) {  // a driven body: its velocity is no J v
      q.segment(first, directions + 1) += draw.vector(directions + 1, 3);
    }
  }
  return dense_or_sparse(draw, J * inverse_mass.asDiagonal() * J.transpose() + coupling, q);
}

Problem friction_free(Draw& draw) {
  return friction(draw, true);
}

Problem friction_driven(Draw& draw) {
  return friction(draw, false);
}

/// A ball between opposite walls, among other contacts: no z has M z + q >= 0.
Problem opposite_walls(Draw& draw) {
  const int n = draw.integer(2, kMostRows);
  Matrix G = draw.matrix(draw.integer(1, 4), n, 2);
  Vector q = draw.vector(n, 3);
  const int wall = draw.integer(0, n - 2);
  const int factor = draw.integer(1, 3);
  G.col(wall + 1) = -factor * G.col(wall);
  q[wall + 1] = -factor * q[wall] - draw.integer(1, 2);
  if (draw.coin()) {
    return dense_or_sparse(draw, gram(G), q);
  }
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(G.rows(), G.rows()) * draw.dyadic());
  for (int i = 0; i < n; ++i) {
    A.add_row();
    A.add_entry(0, G.col(i));
  }
  return {.M = A, .q = q, .lower = {}, .upper = {}, .limits = {}};
}

/// Some combination y of the rows, y > 0, has G y = 0 and q.y < 0.
Problem semidefinite_infeasible(Draw& draw) {
  const int n = draw.integer(2, kMostRows);
  Matrix G = draw.matrix(draw.integer(1, n), n, 2);
  Vector q = draw.vector(n, 3);
  const Vector y = non_negative(draw, n - 1, 2, 40);
  G.col(n - 1) = -G.leftCols(n - 1) * y;
  q[n - 1] = -q.head(n - 1).dot(y) - 1.0;
  return dense_or_sparse(draw, gram(G), q);
}

Problem one_row(Draw& draw) {
  const Matrix M = draw.matrix(1, 1, 2);
  return dense_or_sparse(draw, M, draw.vector(1, 2));
}

/// Rows and columns of zeros in a positive semidefinite matrix, down to M = 0.
Problem zero_rows(Draw& draw) {
  Matrix G = low_rank_factor(draw, 2);
  for (Index j = 0; j < G.cols(); ++j) {
    if (draw.coin()) {
      G.col(j).setZero();
    }
  }
  return dense_or_sparse(draw, gram(G), draw.vector(G.cols(), 1));
}

/// Rows and columns multiplied by powers of two, as by a mass ratio of up to 2^40.
Problem mass_ratios(Draw& draw) {
  Matrix G = low_rank_factor(draw, 2);
  for (Index j = 0; j < G.cols(); ++j) {
    G.col(j) *= std::ldexp(1.0, draw.integer(-10, 10));
  }
  const Matrix M = gram(G);
  Vector q(G.cols());
  for (Index j = 0; j < q.size(); ++j) {
    const int mantissa = draw.integer(-3, 3);
    q[j] = std::ldexp(mantissa, draw.integer(-10, 10));
  }
  return dense_or_sparse(draw, M, draw.coin() ? q : solvable(draw, M, 30));
}

/// M >= 0 is copositive, not copositive-plus; bimatrix games look like this.
Problem copositive(Draw& draw) {
  const int n = draw.integer(1, kMostRows);
  const Matrix M = draw.matrix(n, n, 2).cwiseAbs();
  return dense_or_sparse(draw, M, draw.vector(n, 2));
}

Problem any_matrix(Draw& draw) {
  const int n = draw.integer(1, 8);
  return dense_or_sparse(draw, draw.matrix(n, n, 2), draw.vector(n, 2));
}

/// Indefinite, but with a solution by construction.
Problem any_matrix_solvable(Draw& draw) {
  const int n = draw.integer(1, 8);
  const Matrix M = draw.matrix(n, n, 2);
  return dense_or_sparse(draw, M, solvable(draw, M, 30));
}

constexpr std::array kFamilies = {
    ExactnessFamily{"psd", "G^T G, G integer of rank 1..n, any q", Promise::kDecided,
                    &semidefinite},
    ExactnessFamily{"psd-solvable", "G^T G, q with a solution", Promise::kSolved,
                    &semidefinite_solvable},
    ExactnessFamily{"psd-degenerate", "entries 0 and +-1, most of z and w zero together",
                    Promise::kSolved, &semidefinite_degenerate},
    ExactnessFamily{"psd-repeated", "equal rows with equal q, as the corners of a box",
                    Promise::kDecided, &repeated_contacts},
    ExactnessFamily{"psd-nonsymmetric", "G^T G + skew", Promise::kDecided,
                    &semidefinite_nonsymmetric},
    ExactnessFamily{"impact-factored", "J W J^T not formed, q = J v", Promise::kSolved,
                    &impact_rows},
    ExactnessFamily{"p-triangular", "triangular, positive diagonal", Promise::kSolved,
                    &p_triangular},
    ExactnessFamily{"p-murty", "1 on the diagonal, 2 below or above it", Promise::kSolved,
                    &p_murty},
    ExactnessFamily{"p-definite", "G^T G + I + skew", Promise::kSolved, &p_definite},
    ExactnessFamily{"p-dominant", "diagonally dominant, nonsymmetric", Promise::kSolved,
                    &p_dominant},
    ExactnessFamily{"friction-free", "pyramid friction, free bodies, gap >= 0", Promise::kSolved,
                    &friction_free},
    ExactnessFamily{"friction-driven", "pyramid friction, driven bodies", Promise::kNothing,
                    &friction_driven},
    ExactnessFamily{"opposite-walls", "infeasible: two opposite normals among others",
                    Promise::kDecided, &opposite_walls},
    ExactnessFamily{"psd-infeasible", "infeasible: y > 0 with G y = 0, q.y < 0", Promise::kDecided,
                    &semidefinite_infeasible},
    ExactnessFamily{"one-row", "n = 1, all signs", Promise::kDecided, &one_row},
    ExactnessFamily{"zero-rows", "G^T G with zero rows, down to M = 0", Promise::kDecided,
                    &zero_rows},
    ExactnessFamily{"mass-ratio", "G^T G scaled by powers of two, M_ii / M_jj to 2^40",
                    Promise::kDecided, &mass_ratios},
    ExactnessFamily{"copositive", "M >= 0", Promise::kNothing, &copositive},
    ExactnessFamily{"any", "any integer matrix", Promise::kNothing, &any_matrix},
    ExactnessFamily{"any-solvable", "any integer matrix, q with a solution", Promise::kNothing,
                    &any_matrix_solvable},
};

}  // namespace

Matrix Draw::matrix(Index rows, Index columns, int most) {
  Matrix M(rows, columns);
  for (double& value : M.reshaped()) {
    value = integer(-most, most);
  }
  return M;
}

std::span<const ExactnessFamily> exactness_families() {
  return kFamilies;
}

ExactnessProblem draw_exactness_problem(std::uint64_t seed, int index) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(index)};
  Draw draw{std::mt19937_64(sequence)};
  const ExactnessFamily& family = kFamilies[index % kFamilies.size()];
  return {&family, family.draw(draw)};
}

}  // namespace signorini::bench
