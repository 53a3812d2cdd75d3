#include <signorini/lcp/group_scale.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <vector>

namespace signorini::lcp {
namespace {

/// The block of M at `first`, d x d. @param room gives memory for so many doubles
template <typename Room>
Eigen::Matrix3d block_of(const Matrix& M, int first, int d, Room) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  block.topLeftCorner(d, d) = M.block(first, first, d, d);
  return block;
}

template <typename Room>
Eigen::Matrix3d block_of(const SparseMatrix& M, int first, int d, Room) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  for (int j = 0; j < d; ++j) {
    for (int i = 0; i < d; ++i) {
      block(i, j) = M.coeff(first + i, first + j);
    }
  }
  return block;
}

template <typename Room>
Eigen::Matrix3d block_of(const FactoredMatrix& M, int first, int d, Room room) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  for (int i = 0; i < d; ++i) {
    block(i, i) = M.compliance(first + i);
    for (const FactoredMatrix::Entry& a : M.entries(first + i)) {
      const int size = M.mass.dimension(a.block);
      double* moved = room(size);
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
    // Not computeDirect(): its closed form is wrong by any factor where the rows are scaled apart.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric, Eigen::EigenvaluesOnly);
    most = solver.eigenvalues()[2];
  }
  return most > 0.0 ? most : 1.0;
}

Eigen::Matrix3d diagonal_block(const MatrixForm& M, int first, int d) {
  std::array<double, 6> of_rigid_body;
  std::vector<double> of_large_block;
  const auto room = [&](int size) {
    if (size <= static_cast<int>(of_rigid_body.size())) {
      return of_rigid_body.data();
    }
    of_large_block.resize(size);
    return of_large_block.data();
  };
  return std::visit([&](const auto& form) { return block_of(form, first, d, room); }, M);
}

Eigen::Matrix3d diagonal_block(const MatrixForm& M, int first, int d, Vector& work) {
  const auto room = [&work](int size) {
    if (work.size() < size) {
      work.resize(size);
    }
    return work.data();
  };
  return std::visit([&](const auto& form) { return block_of(form, first, d, room); }, M);
}

void group_scale(const Problem& problem, Vector& s, Vector& work) {
  const int n = static_cast<int>(problem.size());
  s.resize(n);
  std::size_t cone = 0;
  for (int i = 0; i < n;) {
    const bool starts_cone = cone < problem.cones.size() && problem.cones[cone].normal_row == i;
    const int d = starts_cone ? problem.cones[cone++].dimension : 1;
    const Eigen::Matrix3d block = diagonal_block(problem.M, i, d, work);
    const double size = d > 1 ? largest_eigenvalue(block, d) : block(0, 0);
    s.segment(i, d).setConstant(size > 0.0 ? 1.0 / std::sqrt(size) : 1.0);
    i += d;
  }
}

}  // namespace signorini::lcp
