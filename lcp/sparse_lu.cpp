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

void SparseLu::keep_order() {
  if (!std::holds_alternative<Keeping>(lu_)) {
    auto& lu = lu_.emplace<Keeping>();
    lu.isSymmetric(true);
    lu.setPivotThreshold(0.1);
  }
}

void SparseLu::analyse(const View& matrix) {
  const BackEndScope scope;
  require_memory_of_lu(matrix.rows(), matrix.nonZeros());
  std::visit([&](auto& lu) { lu.analyzePattern(matrix); }, lu_);
}

bool SparseLu::factor(const View& matrix) {
  const BackEndScope scope;
  require_memory_of_lu(matrix.rows(), matrix.nonZeros());
  return std::visit(
      [&](auto& lu) {
        lu.factorize(matrix);
        if (lu.info() != Eigen::Success) {
          return false;
        }
        const std::int64_t numbers = std::int64_t{lu.nnzL()} + lu.nnzU();
        bytes_ = std::max(bytes_, numbers * std::int64_t{sizeof(double)});
        return true;
      },
      lu_);
}

void SparseLu::solve(std::span<double> x) {
  const BackEndScope scope;
  Eigen::Map<Vector> right(x.data(), static_cast<Index>(x.size()));
  std::visit([&](auto& lu) { right = lu.solve(right).eval(); }, lu_);
}

}  // namespace signorini::lcp
