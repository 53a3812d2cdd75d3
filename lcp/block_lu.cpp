#include <signorini/lcp/block_lu.h>

#include <cstddef>
#include <utility>

namespace signorini::lcp {
namespace {

SparsePattern pattern_of(const BlockLu::View& matrix) {
  return {static_cast<int>(matrix.cols()), matrix.outerIndexPtr(), matrix.innerIndexPtr(), true};
}

}  // namespace

BlockLu::BlockLu(const DenseKernels& kernels) : kernels_(kernels) {}

void BlockLu::analyse(const View& matrix) {
  if (tree_.knows(pattern_of(matrix))) {
    return;
  }
  tree_.analyse(pattern_of(matrix));
  tree_.find_scatter(pattern_of(matrix), FrontTree::Triangle::kLower, lower_scatter_);
  tree_.find_scatter(pattern_of(matrix), FrontTree::Triangle::kUpper, upper_scatter_);
  lower_.resize(tree_.panels_size());
  upper_.resize(tree_.panels_size());
  lower_stack_.resize(tree_.stack_size());
  upper_stack_.resize(tree_.stack_size());
  exchanges_.resize(tree_.size());
  ones_.assign(tree_.size(), 1.0);
  inverse_.resize(tree_.size());
  work_.resize(tree_.size() + DenseKernels::kPadding);
  below_.resize(tree_.below_size());
  tree_.keep(pattern_of(matrix));
}

bool BlockLu::factor(const View& matrix) {
  for (int s = 0; s < static_cast<int>(tree_.fronts().size()); ++s) {
    const FrontTree::Front& front = tree_.fronts()[s];
    tree_.assemble(s, lower_scatter_, matrix.valuePtr(), lower_.data(), lower_stack_.data());
    tree_.assemble(s, upper_scatter_, matrix.valuePtr(), upper_.data(), upper_stack_.data());
    double* lower = lower_.data() + front.panel;
    double* upper = upper_.data() + front.panel;
    if (!kernels_.factor_lu(lower, upper, front.ld, front.rows, front.columns,
                            exchanges_.data() + front.first)) {
      return false;
    }
    const double* L = lower + front.columns;
    const double* U = upper + front.columns;
    kernels_.subtract_product(lower_stack_.data() + front.update, front.ld_update, L, U, front.ld,
                              front.below(), front.columns);
    kernels_.subtract_product(upper_stack_.data() + front.update, front.ld_update, U, L, front.ld,
                              front.below(), front.columns);
    tree_.move_update(s, lower_stack_.data());
    tree_.move_update(s, upper_stack_.data());
    for (int c = 0; c < front.columns; ++c) {
      inverse_[front.first + c] = 1.0 / upper[static_cast<std::ptrdiff_t>(c) * front.ld + c];
    }
  }
  return true;
}

void BlockLu::solve(std::span<double> x) {
  tree_.permute(x.data(), work_.data());
  const int count = static_cast<int>(tree_.fronts().size());
  for (int s = 0; s < count; ++s) {
    const FrontTree::Front& front = tree_.fronts()[s];
    double* top = work_.data() + front.first;
    for (int c = 0; c < front.columns; ++c) {
      std::swap(top[c], top[exchanges_[front.first + c]]);
    }
    tree_.gather_below(s, work_.data(), below_.data());
    kernels_.forward(lower_.data() + front.panel, front.ld, front.rows, front.columns,
                     ones_.data() + front.first, top, below_.data());
    tree_.scatter_below(s, below_.data(), work_.data());
  }
  for (int s = count - 1; s >= 0; --s) {
    const FrontTree::Front& front = tree_.fronts()[s];
    tree_.gather_below(s, work_.data(), below_.data());
    kernels_.backward(upper_.data() + front.panel, front.ld, front.rows, front.columns,
                      inverse_.data() + front.first, work_.data() + front.first, below_.data());
  }
  tree_.permute_back(work_.data(), x.data());
}

std::size_t BlockLu::bytes() const {
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  return tree_.bytes() + bytes(lower_) + bytes(upper_) + bytes(lower_stack_) + bytes(upper_stack_) +
         bytes(exchanges_) + bytes(ones_) + bytes(inverse_) + bytes(work_) + bytes(below_) +
         bytes(lower_scatter_.entries) + bytes(upper_scatter_.entries);
}

}  // namespace signorini::lcp
