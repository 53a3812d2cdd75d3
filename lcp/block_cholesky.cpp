#include <signorini/lcp/block_cholesky.h>

#include <cstddef>

namespace signorini::lcp {
namespace {

SparsePattern pattern_of(const SparseMatrix& lower) {
  return {static_cast<int>(lower.cols()), lower.outerIndexPtr(), lower.innerIndexPtr(), false};
}

}  // namespace

BlockCholesky::BlockCholesky(const DenseKernels& kernels) : kernels_(kernels) {}

void BlockCholesky::analyse(const SparseMatrix& lower) {
  if (tree_.knows(pattern_of(lower))) {
    return;
  }
  tree_.analyse(pattern_of(lower));
  tree_.find_scatter(pattern_of(lower), FrontTree::Triangle::kLower, scatter_);
  panels_.resize(tree_.panels_size());
  stack_.resize(tree_.stack_size());
  work_.resize(tree_.size() + DenseKernels::kPadding);
  inverse_.resize(tree_.size());
  below_.resize(tree_.below_size());
  tree_.keep(pattern_of(lower));
}

bool BlockCholesky::factor(const SparseMatrix& lower) {
  for (int s = 0; s < static_cast<int>(tree_.fronts().size()); ++s) {
    const FrontTree::Front& front = tree_.fronts()[s];
    tree_.assemble(s, scatter_, lower.valuePtr(), panels_.data(), stack_.data());
    double* panel = panels_.data() + front.panel;
    if (!kernels_.factor(panel, front.ld, front.rows, front.columns)) {
      return false;
    }
    const double* below = panel + front.columns;
    kernels_.subtract_product(stack_.data() + front.update, front.ld_update, below, below, front.ld,
                              front.below(), front.columns);
    tree_.move_update(s, stack_.data());
    for (int c = 0; c < front.columns; ++c) {
      inverse_[front.first + c] = 1.0 / panel[static_cast<std::ptrdiff_t>(c) * front.ld + c];
    }
  }
  return true;
}

void BlockCholesky::solve(Vector& x) {
  tree_.permute(x.data(), work_.data());
  const int count = static_cast<int>(tree_.fronts().size());
  for (int s = 0; s < count; ++s) {
    const FrontTree::Front& front = tree_.fronts()[s];
    tree_.gather_below(s, work_.data(), below_.data());
    kernels_.forward(panels_.data() + front.panel, front.ld, front.rows, front.columns,
                     inverse_.data() + front.first, work_.data() + front.first, below_.data());
    tree_.scatter_below(s, below_.data(), work_.data());
  }
  for (int s = count - 1; s >= 0; --s) {
    const FrontTree::Front& front = tree_.fronts()[s];
    tree_.gather_below(s, work_.data(), below_.data());
    kernels_.backward(panels_.data() + front.panel, front.ld, front.rows, front.columns,
                      inverse_.data() + front.first, work_.data() + front.first, below_.data());
  }
  tree_.permute_back(work_.data(), x.data());
}

SparseCholeskyCounts BlockCholesky::counts() const {
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  return {tree_.entries(), tree_.flops(),
          tree_.bytes() + bytes(panels_) + bytes(stack_) + bytes(work_) + bytes(inverse_) +
              bytes(below_) + bytes(scatter_.entries)};
}

}  // namespace signorini::lcp
