#pragma once

#include <signorini/lcp/io/matrix_market.h>
#include <signorini/lcp/problem.h>

#include <string>
#include <vector>

namespace signorini::lcp {

/// The largest connected block of a mass matrix that is read, in rows.
inline constexpr int kMaxMassBlock = 256;

/// The partition of a mass matrix' rows into blocks.
struct MassBlocks {
  std::vector<std::vector<int>> rows;  ///< of each block, ascending
  std::vector<int> block;              ///< of each row
  std::vector<int> position;           ///< of each row within its block
};

/// The connected parts of M's pattern; the rows of each part of `at_least_joined` (sizes of
/// consecutive parts, may be empty; their sum must be M.rows) stay together.
[[nodiscard]] MassBlocks connected_blocks(const CoordinateMatrix& M,
                                          const std::vector<int>& at_least_joined);
/// Consecutive blocks of these sizes.
[[nodiscard]] MassBlocks consecutive_blocks(const std::vector<int>& sizes);

/// The blocks of M as dense matrices, both triangles. Entries outside the blocks are refused, zeros
/// there ignored. @throws std::invalid_argument for them, for a block of more than kMaxMassBlock
/// rows, or if all blocks have more numbers than int can count; messages count rows from 1
[[nodiscard]] std::vector<Matrix> dense_blocks(const CoordinateMatrix& M, const MassBlocks& blocks);

/// "block of rows 1 to 6", counted from 1.
[[nodiscard]] std::string block_text(const std::vector<int>& rows);

/// Adds M's blocks to a mass: a diagonal block as its inverse, each number rounded once (a Cholesky
/// factor would round twice), any other as its Cholesky factor, which stays positive definite
/// whatever the rounding. @throws std::invalid_argument naming the block that is not symmetric
/// positive definite
void add_masses(const std::vector<Matrix>& masses, const MassBlocks& blocks, BlockMass& out);

/// The rows of J = H^T: every column of H cut into the blocks it touches.
/// @param compliance one a row, or empty
void add_rows(const SparseMatrix& H, const MassBlocks& blocks, const Vector& compliance,
              FactoredMatrix& out);

/// q = H^T M^-1 f + w, with a Cholesky factor of M in long double, summed there, and rounded once.
[[nodiscard]] Vector velocities_without_impulses(const SparseMatrix& H,
                                                 const std::vector<Matrix>& masses,
                                                 const MassBlocks& blocks, const Vector& f,
                                                 const Vector& w);

/// M = W^-1, block by block, in long double, rounded once.
[[nodiscard]] SparseMatrix mass_matrix(const BlockMass& mass);

/// H = J^T.
[[nodiscard]] SparseMatrix transposed_jacobian(const FactoredMatrix& A);

}  // namespace signorini::lcp
