#include <signorini/lcp/exact_solution.h>

namespace signorini::lcp {
namespace {

void add_rational(const Matrix& M, ExactProblem& exact) {
  for (Index j = 0; j < M.cols(); ++j) {
    for (Index i = 0; i < M.rows(); ++i) {
      exact.M[i * exact.n + j] = M(i, j);
    }
  }
}

void add_rational(const SparseMatrix& M, ExactProblem& exact) {
  for (Index j = 0; j < M.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(M, j); it; ++it) {
      exact.M[it.row() * exact.n + j] += it.value();
    }
  }
}

/// The rows of J that use a block, and where their values lie.
struct BlockUse {
  int row;
  const double* values;
};

void add_rational(const FactoredMatrix& A, ExactProblem& exact) {
  std::vector<std::vector<BlockUse>> uses(A.mass.block_count());
  for (int i = 0; i < A.rows(); ++i) {
    exact.M[i * exact.n + i] = A.compliance(i);
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      uses[entry.block].push_back({i, A.values(entry)});
    }
  }
  for (int b = 0; b < A.mass.block_count(); ++b) {
    const int size = A.mass.dimension(b);
    std::vector<mpq_class> inverse_mass_row(size);
    for (const BlockUse& column : uses[b]) {
      const std::vector<mpq_class> row(column.values, column.values + size);
      A.mass.apply_inverse(b, row.data(), inverse_mass_row.data());
      for (const BlockUse& use : uses[b]) {
        for (int k = 0; k < size; ++k) {
          exact.M[use.row * exact.n + column.row] += use.values[k] * inverse_mass_row[k];
        }
      }
    }
  }
}

}  // namespace

ExactProblem to_rational(const Problem& problem) {
  ExactProblem exact;
  exact.n = static_cast<int>(problem.size());
  exact.M.resize(static_cast<std::size_t>(exact.n) * exact.n);
  exact.q.assign(problem.q.begin(), problem.q.end());
  std::visit([&exact](const auto& M) { add_rational(M, exact); }, problem.M);
  return exact;
}

}  // namespace signorini::lcp
