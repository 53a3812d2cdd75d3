#pragma once

#include <signorini/lcp/io/input_error.h>
#include <signorini/lcp/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace signorini::lcp {

/// A MatrixMarket coordinate matrix as the file gives it: no memory is proportional to the sizes it
/// declares, only to the entries it has, so that a short file with huge sizes costs nothing. Check
/// rows and columns against something that is known before calling to_sparse().
struct CoordinateMatrix {
  struct Entry {
    int row;     ///< from 0
    int column;  ///< from 0
    int line;    ///< of the file
    double value;
  };
  int rows = 0;
  int columns = 0;
  bool symmetric = false;      ///< only the lower triangle is stored
  std::vector<Entry> entries;  ///< by column, then row; none repeated
};

/// Reads `%%MatrixMarket matrix coordinate real symmetric|general`. Strict: indices from 1 and in
/// range, only the lower triangle of a symmetric matrix, which must be square, no repeated entry,
/// finite numbers, exactly as many entries as the size line says and nothing after them. Comments
/// (%) are taken between the header and the size line, blank lines anywhere after the header.
/// Cost: O(bytes + nnz log nnz). @throws InputError
[[nodiscard]] CoordinateMatrix read_coordinate_matrix(const std::filesystem::path& file);

/// Reads `%%MatrixMarket matrix array real general`, values by columns, one a line; as strict.
/// @throws InputError
[[nodiscard]] Matrix read_array(const std::filesystem::path& file);

/// An array with one column. @throws InputError
[[nodiscard]] Vector read_vector(const std::filesystem::path& file);

/// The same, where numbers may be inf and -inf: bounds. @throws InputError
[[nodiscard]] Vector read_bounds(const std::filesystem::path& file);

/// Both triangles, compressed. Allocates O(columns + entries). @throws std::length_error if both
/// triangles together have more entries than int can count.
[[nodiscard]] SparseMatrix to_sparse(const CoordinateMatrix& matrix);

/// The text of a coordinate file, 17 significant digits: symmetric (lower triangle) if the matrix
/// equals its transpose to the bit, else general. Stored zeros are left out.
[[nodiscard]] std::string matrix_market_text(const SparseMatrix& matrix);
[[nodiscard]] std::string matrix_market_text(const Matrix& matrix);

/// The text of an array file with one column, 17 significant digits.
[[nodiscard]] std::string matrix_market_text(const Vector& vector);

/// A double with 17 significant digits, which read back give the same bits.
void append_number(double value, std::string& text);

}  // namespace signorini::lcp
