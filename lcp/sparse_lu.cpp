#include <signorini/lcp/back_end.h>
#include <signorini/lcp/sparse_lu.h>

#include <algorithm>
#include <cstddef>
#include <new>

namespace signorini::lcp {

void require_memory_of_lu(Index n, Index entries) {
  constexpr std::int64_t kFill = 16;            // Eigen's fillfactor, and
  constexpr std::int64_t kWorkOfARow = 56 * 8;  // what its panels take
  constexpr std::int64_t kCopies = 3;
  const std::int64_t upper = std::min<std::int64_t>(kFill * (entries + 1) / n, n) * n;
  const std::int64_t bytes = upper * (2 * 8 + 4) + kFill * (entries + 1) + n * kWorkOfARow +
                             kCopies * (entries * 12 + n * 8);
  constexpr std::int64_t kApart = 1 << 20;  // one block here is many there, with ends of their own
  // By name: a new-expression that nobody uses may be left out.
  ::operator delete(::operator new(static_cast<std::size_t>(bytes + bytes / 4 + kApart)));
}

void SparseLu::analyse(const View& matrix) {
  const BackEndScope scope;
  require_memory_of_lu(matrix.rows(), matrix.nonZeros());
  lu_.analyzePattern(matrix);
}

bool SparseLu::factor(const View& matrix) {
  const BackEndScope scope;
  require_memory_of_lu(matrix.rows(), matrix.nonZeros());
  lu_.factorize(matrix);
  if (lu_.info() != Eigen::Success) {
    return false;
  }
  const std::int64_t numbers = std::int64_t{lu_.nnzL()} + lu_.nnzU();
  bytes_ = std::max(bytes_, numbers * std::int64_t{sizeof(double)});
  return true;
}

void SparseLu::solve(std::span<double> x) {
  const BackEndScope scope;
  Eigen::Map<Vector> right(x.data(), static_cast<Index>(x.size()));
  right = lu_.solve(right).eval();
}

}  // namespace signorini::lcp
