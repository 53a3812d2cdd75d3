#include <signorini/lcp/back_end.h>
#include <signorini/lcp/sparse_lu.h>

#include <algorithm>

namespace signorini::lcp {

void SparseLu::prefer_diagonal() {
  lu_.isSymmetric(true);
  lu_.setPivotThreshold(0.1);
}

void SparseLu::analyse(const View& matrix) {
  const BackEndScope scope;
  lu_.analyzePattern(matrix);
}

bool SparseLu::factor(const View& matrix) {
  const BackEndScope scope;
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
