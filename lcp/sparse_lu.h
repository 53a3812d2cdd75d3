#pragma once

#include <signorini/lcp/types.h>

#include <Eigen/SparseLU>
#include <cstdint>
#include <span>

namespace signorini::lcp {

/// Asks for what Eigen's SparseLU takes at first for an n x n matrix with so many entries (its
/// memInit(), its copies of the matrix) and a quarter more, and gives it back. Where memory ends
/// within it Eigen 3.4 writes through null and answers as if all were well, or frees a vector
/// twice; so it ends here. Not against what other threads take meanwhile, nor against fill beyond
/// Eigen's estimate (16 numbers an entry), for which it grows its vectors later.
/// @throws std::bad_alloc
void require_memory_of_lu(Index n, Index entries);

/// The sparse LU with partial pivoting of Eigen (MPL 2), for matrices that need not be symmetric.
/// It allocates at every call; BackEndScope stands around it.
class SparseLu {
 public:
  /// A compressed matrix in someone else's memory.
  using View = Eigen::Map<const SparseMatrix>;

  /// Orders and analyses the pattern. @param matrix n x n, n >= 1
  void analyse(const View& matrix);
  /// Factors a matrix of the analysed pattern. @return false if it is singular or not finite;
  /// solve() must then not be called.
  [[nodiscard]] bool factor(const View& matrix);
  /// x <- M^-1 x. @param x n numbers @pre factor() returned true.
  void solve(std::span<double> x);

  /// The most that L and U of any factor() held, their numbers alone, since reset_bytes().
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }
  void reset_bytes() { bytes_ = 0; }

 private:
  Eigen::SparseLU<SparseMatrix> lu_;
  std::int64_t bytes_ = 0;
};

}  // namespace signorini::lcp
