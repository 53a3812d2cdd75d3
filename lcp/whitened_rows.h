#pragma once

#include <signorini/lcp/factored_matrix.h>
#include <signorini/lcp/types.h>

#include <vector>

namespace signorini::lcp {

/// A factored matrix in the coordinates in which mass and row length are one:
///
///     A = J W J^T + c = S (G G^T + C) S,   W = F F^T,   S_i = sqrt(A_ii),
///     G = S^-1 J F,   C = S^-2 c,          so that (G G^T + C)_ii = 1,
///
/// and the body-space matrix H(D) = I + G^T D G, block sparse, one block a pair of blocks that
/// share a row; its pattern does not depend on D. Redundant rows of G do not disturb H. Rows of A
/// that are zero have S_i = 1 and G_i = 0.
class WhitenedRows {
 public:
  /// Takes over rows and mass. Cost: O(entries of J) and, for the pattern, the pairs of blocks.
  void set(const FactoredMatrix& A);

  [[nodiscard]] Index rows() const { return scale_.size(); }
  [[nodiscard]] Index degrees_of_freedom() const { return degrees_of_freedom_; }
  [[nodiscard]] const Vector& scale() const { return scale_; }            ///< S
  [[nodiscard]] const Vector& compliance() const { return compliance_; }  ///< C

  /// u = G^T x.
  void transpose_times(const Vector& x, Vector& u) const;
  /// y = G u.
  void times(const Vector& u, Vector& y) const;
  /// The lower triangle of I + G^T D G; the pattern is the same at every call.
  /// @param d the diagonal of D, >= 0
  const SparseMatrix& body_space_matrix(const Vector& d);

 private:
  struct Entry {
    int offset;  // of the block in u
    int dimension;
    int values;  // where the numbers of G start
  };
  void set_pattern(const FactoredMatrix& A);

  Index degrees_of_freedom_ = 0;
  std::vector<int> row_start_;
  std::vector<Entry> entries_;
  std::vector<double> values_;
  Vector scale_;
  Vector compliance_;
  // For every pair of entries (e1, e2) of every row, block of e1 >= block of e2, in the order of
  // the loops of body_space_matrix(): the number of the pair of blocks.
  std::vector<int> pair_of_entries_;
  // For every pair of blocks and every column of its second block: where row 0 of the first block
  // would stand among the values of the column.
  std::vector<int> column_starts_;
  std::vector<int> first_column_start_;  // of a pair
  SparseMatrix lower_;
  std::vector<int> diagonal_position_;
};

}  // namespace signorini::lcp
