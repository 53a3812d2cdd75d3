#include <signorini/lcp/group_scale.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <vector>

namespace signorini::lcp {
namespace {

/// The block of M at `first`, d x d.
Eigen::Matrix3d block_of(const Matrix& M, int first, int d) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  block.topLeftCorner(d, d) = M.block(first, first, d, d);
  return block;
}

Eigen::Matrix3d block_of(const SparseMatrix& M, int first, int d) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  for (int j = 0; j < d; ++j) {
    for (int i = 0; i < d; ++i) {
      block(i, j) = M.coeff(first + i, first + j);
    }
  }
  return block;
}

Eigen::Matrix3d block_of(const FactoredMatrix& M, int first, int d) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  std::array<double, 6> of_rigid_body{};  // no allocation for these
  std::vector<double> of_large_block;
  for (int i = 0; i < d; ++i) {
    block(i, i) = M.compliance(first + i);
    for (const FactoredMatrix::Entry& a : M.entries(first + i)) {
      const int size = M.mass.dimension(a.block);
      double* moved = of_rigid_body.data();
      if (size > static_cast<int>(of_rigid_body.size())) {
        of_large_block.resize(size);
        moved = of_large_block.data();
      }
      M.mass.apply_inverse(a.block, M.values(a), moved);
      for (int j = 0; j < d; ++j) {
        for (const FactoredMatrix::Entry& b : M.entries(first + j)) {
          if (a.block == b.block) {
            const double* row = M.values(b);
            for (int k = 0; k < size; ++k) {
              block(i, j) += moved[k] * row[k];
            }
          }
        }
      }
    }
  }
  return block;
}

}  // namespace

double largest_eigenvalue(const Eigen::Matrix3d& block, int d) {
  double most = 0.0;
  if (d == 2) {
    const double half_difference = 0.5 * (block(0, 0) - block(1, 1));
    const double off = 0.5 * block(0, 1) + 0.5 * block(1, 0);
    most = 0.5 * (block(0, 0) + block(1, 1)) + std::hypot(half_difference, off);
  } else {
    const Eigen::Matrix3d symmetric = 0.5 * block + 0.5 * block.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(symmetric, Eigen::EigenvaluesOnly);
    most = solver.eigenvalues()[2];
  }
  return most > 0.0 ? most : 1.0;
}

Eigen::Matrix3d diagonal_block(const MatrixForm& M, int first, int d) {
  return std::visit([=](const auto& form) { return block_of(form, first, d); }, M);
}

void group_scale(const Problem& problem, Vector& s) {
  diagonal(problem.M, s);
  for (double& value : s) {
    value = value > 0.0 ? 1.0 / std::sqrt(value) : 1.0;
  }
  for (const FrictionCone& cone : problem.cones) {
    const Eigen::Matrix3d block = diagonal_block(problem.M, cone.normal_row, cone.dimension);
    s.segment(cone.normal_row, cone.dimension)
        .setConstant(1.0 / std::sqrt(largest_eigenvalue(block, cone.dimension)));
  }
}

}  // namespace signorini::lcp
