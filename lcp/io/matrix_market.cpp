#include <signorini/lcp/io/matrix_market.h>
#include <signorini/lcp/io/text_lines.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <tuple>

namespace signorini::lcp {
namespace {

constexpr int kMaxInt = std::numeric_limits<int>::max();

bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](char x, char y) { return (x >= 'A' && x <= 'Z' ? x - 'A' + 'a' : x) == y; });
}

void expect_word(TextLines& lines, std::string_view expected) {
  const std::string_view found = lines.word();
  if (!equal_but_for_case(found, expected)) {
    lines.fail("MatrixMarket header: expected '" + std::string(expected) + "', found " +
               (found.empty() ? "the end of the line" : in_quotes(found)));
  }
}

/// Reads the header line and goes to the size line. @return whether it says symmetric.
bool read_header(TextLines& lines, std::string_view format) {
  if (!lines.next()) {
    lines.fail("expected a '%%MatrixMarket' header, found an empty file");
  }
  if (const std::string_view found = lines.word(); found != "%%MatrixMarket") {
    lines.fail("expected a '%%MatrixMarket' header, found " + in_quotes(found));
  }
  expect_word(lines, "matrix");
  expect_word(lines, format);
  expect_word(lines, "real");
  const std::string_view symmetry = lines.word();
  const bool symmetric = format == "coordinate" && equal_but_for_case(symmetry, "symmetric");
  if (!symmetric && !equal_but_for_case(symmetry, "general")) {
    lines.fail(std::string("MatrixMarket header: expected ") +
               (format == "coordinate" ? "'general' or 'symmetric'" : "'general'") + ", found " +
               in_quotes(symmetry));
  }
  lines.expect_end_of_line("the header");
  do {
    if (!lines.next_nonblank()) {
      lines.fail("expected the size line, found the end of the file");
    }
  } while (lines.line().starts_with('%'));
  return symmetric;
}

[[noreturn]] void fail_truncated(const TextLines& lines, std::int64_t declared, std::int64_t found,
                                 const char* what) {
  lines.fail("the size line declares " + std::to_string(declared) + " " + what +
             ", the file ends after " + std::to_string(found));
}

void expect_end_of_file(TextLines& lines, std::int64_t declared, const char* what) {
  if (lines.next_nonblank()) {
    lines.fail("expected the end of the file after the " + std::to_string(declared) + " " + what +
               " that the size line declares, found " + in_quotes(lines.line()));
  }
}

CoordinateMatrix::Entry read_entry(TextLines& lines, const CoordinateMatrix& matrix) {
  CoordinateMatrix::Entry entry{};
  entry.line = lines.line_number();
  entry.row = lines.integer("row index", 1, matrix.rows) - 1;
  entry.column = lines.integer("column index", 1, matrix.columns) - 1;
  entry.value = lines.number("value");
  lines.expect_end_of_line("the value");
  if (matrix.symmetric && entry.row < entry.column) {
    lines.fail("entry (" + std::to_string(entry.row + 1) + ", " + std::to_string(entry.column + 1) +
               ") lies above the diagonal: a symmetric file stores the lower triangle only");
  }
  return entry;
}

/// By columns, then rows, then lines: of two equal entries the later one is to blame.
void sort_and_refuse_repeats(CoordinateMatrix& matrix, const TextLines& lines) {
  const auto place = [](const CoordinateMatrix::Entry& e) { return std::tie(e.column, e.row); };
  std::ranges::sort(matrix.entries, [](const auto& a, const auto& b) {
    return std::tie(a.column, a.row, a.line) < std::tie(b.column, b.row, b.line);
  });
  const auto repeated = std::ranges::adjacent_find(matrix.entries, {}, place);
  if (repeated != matrix.entries.end()) {
    throw InputError(lines.file(), (repeated + 1)->line,
                     "entry (" + std::to_string(repeated->row + 1) + ", " +
                         std::to_string(repeated->column + 1) + ") was given before, in line " +
                         std::to_string(repeated->line));
  }
}

using ReadNumber = double (TextLines::*)(std::string_view);

Matrix read_array(const std::filesystem::path& file, ReadNumber number) {
  TextLines lines(file);
  read_header(lines, "array");
  const int rows = lines.integer("rows", 0, kMaxInt);
  const int columns = lines.integer("columns", 0, kMaxInt);
  lines.expect_end_of_line("the sizes");
  const std::int64_t declared = std::int64_t{rows} * columns;
  std::vector<double> values;  // grows with the file, not with what it declares
  for (std::int64_t k = 0; k < declared; ++k) {
    if (!lines.next_nonblank()) {
      fail_truncated(lines, declared, k, "values");
    }
    values.push_back((lines.*number)("value"));
    lines.expect_end_of_line("the value");
  }
  expect_end_of_file(lines, declared, "values");
  return Eigen::Map<const Matrix>(values.data(), rows, columns);
}

Vector only_column(const std::filesystem::path& file, const Matrix& matrix) {
  if (matrix.cols() != 1) {
    throw InputError(file, 0, "expected one column, found " + std::to_string(matrix.cols()));
  }
  return matrix.col(0);
}

bool equals_transpose(const SparseMatrix& matrix) {
  if (matrix.rows() != matrix.cols()) {
    return false;
  }
  const SparseMatrix transpose = matrix.transpose();
  const SparseMatrix difference = matrix - transpose;
  return difference.coeffs().size() == 0 || (difference.coeffs() == 0.0).all();
}

}  // namespace

CoordinateMatrix read_coordinate_matrix(const std::filesystem::path& file) {
  TextLines lines(file);
  CoordinateMatrix matrix;
  matrix.symmetric = read_header(lines, "coordinate");
  matrix.rows = lines.integer("rows", 0, kMaxInt);
  matrix.columns = lines.integer("columns", 0, kMaxInt);
  const int declared = lines.integer("entries", 0, kMaxInt);
  lines.expect_end_of_line("the sizes");
  if (matrix.symmetric && matrix.rows != matrix.columns) {
    lines.fail("a symmetric matrix must be square, found " + std::to_string(matrix.rows) + " x " +
               std::to_string(matrix.columns));
  }
  for (int k = 0; k < declared; ++k) {
    if (!lines.next_nonblank()) {
      fail_truncated(lines, declared, k, "entries");
    }
    matrix.entries.push_back(read_entry(lines, matrix));
  }
  expect_end_of_file(lines, declared, "entries");
  sort_and_refuse_repeats(matrix, lines);
  return matrix;
}

Matrix read_array(const std::filesystem::path& file) {
  return read_array(file, &TextLines::number);
}

Vector read_vector(const std::filesystem::path& file) {
  return only_column(file, read_array(file, &TextLines::number));
}

Vector read_bounds(const std::filesystem::path& file) {
  return only_column(file, read_array(file, &TextLines::number_or_infinity));
}

SparseMatrix to_sparse(const CoordinateMatrix& matrix) {
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(matrix.entries.size() * (matrix.symmetric ? 2 : 1));
  for (const CoordinateMatrix::Entry& entry : matrix.entries) {
    triplets.emplace_back(entry.row, entry.column, entry.value);
    if (matrix.symmetric && entry.row != entry.column) {
      triplets.emplace_back(entry.column, entry.row, entry.value);
    }
  }
  if (triplets.size() > static_cast<std::size_t>(kMaxInt)) {
    throw std::length_error("a sparse matrix of " + std::to_string(triplets.size()) + " entries");
  }
  SparseMatrix sparse(matrix.rows, matrix.columns);
  sparse.setFromTriplets(triplets.begin(), triplets.end());
  return sparse;
}

void append_number(double value, std::string& text) {
  char digits[32];
  const auto [end, error] =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17);
  text.append(digits, end);
}

std::string matrix_market_text(const SparseMatrix& matrix) {
  const bool symmetric = equals_transpose(matrix);
  std::string entries;
  int count = 0;
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) {
      if (it.value() == 0.0 || (symmetric && it.row() < j)) {
        continue;
      }
      ++count;
      entries += std::to_string(it.row() + 1) + " " + std::to_string(j + 1) + " ";
      append_number(it.value(), entries);
      entries += '\n';
    }
  }
  return std::string("%%MatrixMarket matrix coordinate real ") +
         (symmetric ? "symmetric\n" : "general\n") + std::to_string(matrix.rows()) + " " +
         std::to_string(matrix.cols()) + " " + std::to_string(count) + "\n" + entries;
}

std::string matrix_market_text(const Matrix& matrix) {
  return matrix_market_text(SparseMatrix(matrix.sparseView(1.0, 0.0)));
}

std::string matrix_market_text(const Vector& vector) {
  std::string text =
      "%%MatrixMarket matrix array real general\n" + std::to_string(vector.size()) + " 1\n";
  for (const double value : vector) {
    append_number(value, text);
    text += '\n';
  }
  return text;
}

}  // namespace signorini::lcp
