#pragma once

#include <signorini/lcp/principal_basis.h>

namespace signorini::lcp {

/// The principal pivot transform as a symmetric tableau, its lower triangle kept whole:
///
///     T = |-M_CC^-1        M_CC^-1 M_CN           |
///         | M_NC M_CC^-1   M_NN - M_NC M_CC^-1 M_CN |
///
/// An exchange is one symmetric rank-1 update (the sweep operator: Goodnight, A tutorial on the
/// SWEEP operator, 1979). Cost: n^2/2 multiply-adds an exchange, and column() is a copy. The
/// fastest form for small and for full problems. Rounding grows with every exchange (the pivots are
/// not chosen for size), so its users refine, and judge by the problem's own M.
class PrincipalTableau : public PrincipalBasis {
 public:
  void reset(const SymmetricLcp& problem) override;
  void column(int j, double* rate) override;
  [[nodiscard]] double pivot(int j) const override {
    const double own = table_[static_cast<std::size_t>(j) * (height_ + 1)];
    return member_[j] != 0 ? -own : own;
  }
  [[nodiscard]] bool exchange(int j) override;
  int load(const std::vector<char>& wanted, double least_pivot) override;
  void solve(double* x) override;
  [[nodiscard]] bool refactor() override;
  [[nodiscard]] int factorizations() const override { return factorizations_; }

 private:
  double* at(int j) { return table_.data() + static_cast<std::size_t>(j) * height_; }
  void copy();
  int sweep_members(double least_pivot);

  const SymmetricLcp* problem_ = nullptr;
  int n_ = 0;
  int height_ = 0;  // of a column in table_: n and some, see exchange()
  int factorizations_ = 0;
  std::vector<double> table_;   // column-major, rows j.. of column j are used
  std::vector<double> column_;  // T_j, then zeros
  std::vector<int> members_;    // work
  std::vector<double> right_;   // work
};

}  // namespace signorini::lcp
