#pragma once

#include <signorini/lcp/exact_solution.h>
#include <signorini/lcp/solver.h>

#include <gmpxx.h>
#include <vector>

namespace signorini::lcp {

/// The dictionary of Lemke's method in integers,
///
///     D x_B = b - T x_N,
///
/// for the variables of w_i - (M z)_i - d_i z0 = q_i, every row multiplied by the common
/// denominator s_i > 0 of its data (d_i = 1 before that; w_i is scaled with its row, z and z0 are
/// in the caller's units). D > 0 is the absolute basis determinant, T and b are minors of the data,
/// so an exchange divides without remainder (Edmonds; Bareiss 1968).
///
/// Every basis it starts from has the cover d = (positive integers) in its own terms, and the
/// right-hand side is perturbed by (e, e^2, ..) in its own terms, so that the lexicographic rule
/// holds.
///
/// Variables are numbered w_0 .. w_n-1, z_0 .. z_n-1, z0.
class IntegerTableau {
 public:
  /// Starts at the basis of all w. Keeps no reference.
  explicit IntegerTableau(const ExactProblem& problem);
  /// Makes the complementary basis with z_i for the wanted rows and w_i for the others the one to
  /// start from, with this cover. @pre nothing was exchanged yet
  /// @param cover n positive integers, by the rows of the new basis
  /// @return false if that basis is singular, or the deadline passed: the tableau is then unusable
  [[nodiscard]] bool start_from(const std::vector<char>& wanted, const std::vector<int>& cover,
                                const Deadline& deadline);

  [[nodiscard]] int size() const { return n_; }
  [[nodiscard]] int covering_variable() const { return 2 * n_; }
  /// The other one of w_i and z_i. @pre not z0
  [[nodiscard]] int complement(int variable) const {
    return variable < n_ ? variable + n_ : variable - n_;
  }
  [[nodiscard]] int basic_variable(int row) const { return basic_[row]; }
  [[nodiscard]] bool is_basic(int variable) const { return row_of_[variable] >= 0; }
  [[nodiscard]] int row_of(int variable) const { return row_of_[variable]; }

  /// The row that z0 replaces first: the lexicographically smallest of (b, I) / d; -1 if b >= 0.
  [[nodiscard]] int first_leaving_row() const;
  /// The row that leaves when a nonbasic variable grows: the smallest b_i / T_ij over T_ij > 0,
  /// that of z0 if it is among the smallest, else the lexicographically smallest of the perturbed
  /// right-hand sides. -1: no T_ij > 0, the variable is unbounded.
  [[nodiscard]] int leaving_row(int entering) const;

  /// Exchanges the basic variable of a row with a nonbasic one.
  /// @return false if the deadline passed: the tableau is then unusable, values() are still those
  /// of the old basis.
  [[nodiscard]] bool exchange(int row, int entering, const Deadline& deadline);

  /// z of the basis. In the caller's units.
  [[nodiscard]] std::vector<mpq_class> values() const;
  /// The z-part of the direction in which a nonbasic variable grows, times a positive number:
  /// integers without a common factor.
  [[nodiscard]] std::vector<mpq_class> direction(int entering) const;

 private:
  [[nodiscard]] const mpz_class& entry(int row, int column) const {
    return entries_[static_cast<std::size_t>(row) * (n_ + 1) + column];
  }
  mpz_class& entry(int row, int column) {
    return entries_[static_cast<std::size_t>(row) * (n_ + 1) + column];
  }
  /// Coefficient of e^(k+1) in the perturbed b of a row: D (B^-1 B_0)_(row, k), B_0 the basis that
  /// was started from.
  [[nodiscard]] const mpz_class& perturbation(int row, int k) const;
  [[nodiscard]] int compare_ratios(int row, int other, int column) const;
  [[nodiscard]] bool is_lexicographically_less(int row, int other, int column) const;
  /// T_ij <- (p T_ij - T_ic T_rj) / D for j != c, p = T_rc > 0.
  void update_row(int row, int pivot_row, int column);
  void swap_variables(int row, int column);

  int n_;
  std::vector<mpz_class> entries_;  // T: n x (n + 1), row by row
  std::vector<mpz_class> right_;    // b
  mpz_class determinant_;           // D
  std::vector<int> basic_;          // the variable of each row
  std::vector<int> first_basic_;    // that of each row in the basis that was started from
  std::vector<int> nonbasic_;       // the variable of each column
  std::vector<int> row_of_;         // of each variable, -1 if nonbasic
  std::vector<int> column_of_;      // of each variable, -1 if basic
  const mpz_class zero_ = 0;
};

}  // namespace signorini::lcp
