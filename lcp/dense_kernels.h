#pragma once

#include <span>
#include <string_view>

namespace signorini::lcp {

/// The dense inner loops of a sparse factorisation, for one instruction set.
///
/// A panel holds the first `columns` columns of a matrix with `rows` rows: column-major, lower
/// trapezoid, leading dimension ld >= rows, a multiple of kPadding. What lies above the diagonal
/// and below row `rows` is scratch, read and written: panels need kPadding numbers of memory behind
/// them. A matrix that is not symmetric has two panels, the second that of its transpose.
struct DenseKernels {
  static constexpr int kPadding = 8;

  std::string_view name;  ///< "avx512", "avx2" or "baseline"
  /// panel <- L of its Cholesky factorisation, the rows below included (L_21 = A_21 L_11^-T).
  /// @return false if a pivot is not a positive finite number; the panel is then of no use
  bool (*factor)(double* panel, int ld, int rows, int columns);
  /// lower, upper <- L with ones on its diagonal, and U^T, of its factorisation P A = L U, the rows
  /// below included (L_21 = A_21 U_11^-1, U_12 = L_11^-1 P_11 A_12). The diagonal of A is in
  /// `lower`. P exchanges rows within kPivots columns, where the diagonal is less than a tenth of
  /// the largest number below it there; what is below these columns is not looked at.
  /// @param exchanges columns: row c was exchanged with row exchanges[c] >= c
  /// @return false if a pivot is 0 or not finite; the panels are then of no use
  bool (*factor_lu)(double* lower, double* upper, int ld, int rows, int columns, int* exchanges);
  static constexpr int kPivots = 8;
  /// The lower triangle of square (size x size, leading dimension ld_square, a multiple of
  /// kPadding) -= A B^T, A and B: the last `size` rows of panels, starting there.
  void (*subtract_product)(double* square, int ld_square, const double* A, const double* B, int ld,
                           int size, int columns);
  /// block (rows x columns, leading dimension ld) += L^T R, L and R three rows of numbers that are
  /// `width` apart. Fastest for 3 and 6 rows.
  void (*add_product_of_three)(double* block, int ld, const double* L, const double* R, int width,
                               int rows, int columns);
  /// Forward substitution with a panel: top <- L_11^-1 top, below <- below - L_21 top. `below`
  /// needs kPadding numbers of memory behind it. @param inverse 1 / the diagonal of L_11: each
  /// number of a substitution waits for the one before, and would for a division
  void (*forward)(const double* panel, int ld, int rows, int columns, const double* inverse,
                  double* top, double* below);
  /// Back substitution: top <- L_11^-T (top - L_21^T below).
  void (*backward)(const double* panel, int ld, int rows, int columns, const double* inverse,
                   double* top, const double* below);
};

/// The sets this machine can run, the fastest first. The choice changes rounding, not accuracy.
[[nodiscard]] std::span<const DenseKernels> dense_kernels();

}  // namespace signorini::lcp
