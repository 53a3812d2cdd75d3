#pragma once

#include <signorini/lcp/problem.h>

#include <vector>

namespace signorini::lcp {

/// Whether every entry has one across the diagonal. @param M rows sorted in every column
[[nodiscard]] bool has_symmetric_pattern(const SparseMatrix& M);

/// A matrix of any form as a sparse one, in memory that only grows.
class SparseForm {
 public:
  /// matrix = M: the numbers of a dense M that are not 0, the entries of a sparse one, those of a
  /// factored one formed (FactoredMatrix::visit_lower), symmetric to the bit. Compressed, rows
  /// sorted in every column.
  void form(const MatrixForm& M, SparseMatrix& matrix);

 private:
  struct Entry {
    int row;
    int column;  // <= row
    double value;
  };
  static void form(const Matrix& M, SparseMatrix& matrix);
  void form(const FactoredMatrix& M, SparseMatrix& matrix);

  FactoredMatrix::VisitWorkspace visit_;
  std::vector<Entry> entries_;  // of the lower triangle, row by row
  std::vector<int> next_;       // where the next entry of a column goes
};

}  // namespace signorini::lcp
