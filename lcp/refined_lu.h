#pragma once

#include <signorini/lcp/block_lu.h>
#include <signorini/lcp/sparse_lu.h>

#include <cstdint>
#include <span>
#include <vector>

namespace signorini::lcp {

/// Solves M x = b for matrices with a symmetric pattern and mostly large diagonals by BlockLu, each
/// x refined to a backward error of 1e-12, row by row (Arioli, Demmel, Duff, SIAM J. Matrix Anal.
/// Appl. 10, 1989); where that cannot be had, SparseLu factors a matrix of up to kFreeColumns
/// columns, pivoting as it needs.
class RefinedLu {
 public:
  using View = BlockLu::View;
  /// Eigen's LU, in an order of its own, takes 0.02 to 0.1 s for the body spaces of half as many.
  static constexpr int kFreeColumns = 10000;

  /// Orders and analyses the pattern; nothing where it is the last one's.
  void analyse(const View& matrix);
  /// Factors a matrix of the analysed pattern, which must stay until the last solve(). @return
  /// false if it is singular, as far as can be seen; solve() must then not be called.
  [[nodiscard]] bool factor(const View& matrix);
  /// x <- M^-1 x. @return false if x was not finite, or its error stays larger.
  [[nodiscard]] bool solve(std::span<double> x);

  /// What the factors hold, of whichever analysis.
  [[nodiscard]] std::int64_t bytes() const {
    return static_cast<std::int64_t>(block_.bytes()) + free_.bytes();
  }

 private:
  [[nodiscard]] bool factor_freely();
  [[nodiscard]] double backward_error(std::span<const double> x);

  const int* outer_ = nullptr;
  const int* inner_ = nullptr;
  const double* values_ = nullptr;
  int columns_ = 0;
  bool pivots_freely_ = false;
  BlockLu block_;
  SparseLu free_;
  std::vector<double> right_, residual_, size_;
};

}  // namespace signorini::lcp
