#pragma once

#include <signorini/lcp/problem.h>

namespace signorini::lcp {

/// The largest eigenvalue of the symmetric part of a d x d block, or 1 if it is not positive.
/// @param d 2 or 3
[[nodiscard]] double largest_eigenvalue(const Eigen::Matrix3d& block, int d);

/// The d x d block of M at row and column `first`, in the top left corner; zeros elsewhere.
/// Allocates where M is factored and has blocks larger than 6; not with `work`, which grows.
/// @param d 1, 2 or 3
[[nodiscard]] Eigen::Matrix3d diagonal_block(const MatrixForm& M, int first, int d);
[[nodiscard]] Eigen::Matrix3d diagonal_block(const MatrixForm& M, int first, int d, Vector& work);

/// Numbers that make every row, and every cone as a whole, comparable: s_i = 1 / sqrt(D_i), D of
/// Certificate, so that the diagonal entries of diag(s) M diag(s), and of its cone blocks the
/// largest eigenvalue, are 1. The rows of a cone share one s, which keeps the cone as it is.
/// @param work memory, grows
void group_scale(const Problem& problem, Vector& s, Vector& work);

}  // namespace signorini::lcp
