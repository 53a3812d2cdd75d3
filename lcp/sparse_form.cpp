#include <signorini/lcp/sparse_form.h>

#include <algorithm>
#include <cstddef>

namespace signorini::lcp {

bool has_symmetric_pattern(const SparseMatrix& M) {
  for (Index j = 0; j < M.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(M, j); it; ++it) {
      const int* begin = M.innerIndexPtr() + M.outerIndexPtr()[it.row()];
      const int count = M.isCompressed()
                            ? M.outerIndexPtr()[it.row() + 1] - M.outerIndexPtr()[it.row()]
                            : M.innerNonZeroPtr()[it.row()];
      if (!std::binary_search(begin, begin + count, static_cast<int>(j))) {
        return false;
      }
    }
  }
  return true;
}

void SparseForm::form(const MatrixForm& M, SparseMatrix& matrix) {
  if (const auto* dense = std::get_if<Matrix>(&M)) {
    form(*dense, matrix);
  } else if (const auto* factored = std::get_if<FactoredMatrix>(&M)) {
    form(*factored, matrix);
  } else {
    matrix = std::get<SparseMatrix>(M);
    matrix.makeCompressed();
  }
}

void SparseForm::form(const Matrix& M, SparseMatrix& matrix) {
  matrix.resize(M.rows(), M.cols());
  matrix.resizeNonZeros((M.array() != 0.0).count());
  int next = 0;
  for (Index j = 0; j < M.cols(); ++j) {
    matrix.outerIndexPtr()[j] = next;
    for (Index i = 0; i < M.rows(); ++i) {
      if (M(i, j) != 0.0) {
        matrix.innerIndexPtr()[next] = static_cast<int>(i);
        matrix.valuePtr()[next++] = M(i, j);
      }
    }
  }
  matrix.outerIndexPtr()[M.cols()] = next;
}

void SparseForm::form(const FactoredMatrix& M, SparseMatrix& matrix) {
  const int n = M.rows();
  entries_.clear();
  next_.assign(n, 0);
  M.visit_lower(visit_, [this](Index i, Index j, double value) {
    entries_.push_back({static_cast<int>(i), static_cast<int>(j), value});
    ++next_[j];
    next_[i] += i != j ? 1 : 0;
  });
  matrix.resize(n, n);
  int* outer = matrix.outerIndexPtr();
  for (int j = 0; j < n; ++j) {
    outer[j + 1] = outer[j] + next_[j];
    next_[j] = outer[j];
  }
  matrix.resizeNonZeros(outer[n]);
  const auto put = [&](int row, int column, double value) {
    matrix.innerIndexPtr()[next_[column]] = row;
    matrix.valuePtr()[next_[column]++] = value;
  };
  // Row i is column i down to the diagonal, and fills the columns before it below theirs.
  for (auto first = entries_.begin(); first != entries_.end();) {
    const int i = first->row;
    const auto last =
        std::find_if(first, entries_.end(), [i](const Entry& e) { return e.row != i; });
    std::sort(first, last, [](const Entry& a, const Entry& b) { return a.column < b.column; });
    for (; first != last; ++first) {
      put(first->column, i, first->value);
      if (first->column < i) {
        put(i, first->column, first->value);
      }
    }
  }
}

}  // namespace signorini::lcp
