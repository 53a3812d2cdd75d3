#pragma once

#include <signorini/lcp/principal_basis.h>

namespace signorini::lcp {

/// The principal pivot transform through a sparse factor M_CC = L D L^T with rows added and deleted
/// (Davis and Hager, Row modifications of a sparse Cholesky factorization, 2005).
///
/// The pattern of L is that of the whole M, ordered once by minimum degree; rows outside C stand in
/// it as zeros, with a 1 on the diagonal, so that no exchange changes a pattern. Adding row k is a
/// triangular solve and a rank-1 downdate of the columns on k's path up the elimination tree,
/// deleting it a rank-1 update (Gill, Golub, Murray, Saunders, Methods for modifying matrix
/// factorizations, 1974, method C1). After kUpdates of them the factor is formed anew.
///
/// Cost: an exchange at most the entries of L on that path, column() two passes over L and one over
/// the columns C of M. Memory: L twice. The analysis is kept while the pattern of M is the same; it
/// is the one place that allocates.
class PrincipalFactor : public PrincipalBasis {
 public:
  static constexpr int kUpdates = 200;

  /// @param problem in sparse form
  void reset(const SymmetricLcp& problem) override;
  void column(int j, double* rate) override;
  [[nodiscard]] double pivot(int /*j*/) const override { return 1.0; }
  [[nodiscard]] bool exchange(int j) override;
  int load(const std::vector<char>& wanted, double least_pivot) override;
  void solve(double* x) override;
  [[nodiscard]] bool refactor() override;
  [[nodiscard]] int factorizations() const override { return factorizations_; }

  /// Entries of L below the diagonal.
  [[nodiscard]] std::size_t fill() const { return column_row_.size(); }

 private:
  void analyse();
  void eliminate();
  void factor(double least_pivot);
  void add(int k);
  void remove(int k);
  void update(int k, double alpha);
  void solve_permuted();

  const SymmetricLcp* problem_ = nullptr;
  int n_ = 0;
  int factorizations_ = 0;
  int updates_ = 0;
  bool regular_ = true;

  // What was analysed.
  std::vector<int> seen_start_;
  std::vector<int> seen_row_;
  // In the order of elimination: row k is row row_of_[k] of M.
  std::vector<int> row_of_;
  std::vector<int> place_of_;
  std::vector<int> parent_;
  std::vector<int> column_start_;
  std::vector<int> column_row_;
  std::vector<double> value_;
  std::vector<int> row_start_;
  std::vector<int> row_column_;
  std::vector<int> row_entry_;  // where the entry stands in value_
  std::vector<double> diagonal_;
  std::vector<char> active_;
  std::vector<double> x_;  // zero between the calls
};

}  // namespace signorini::lcp
