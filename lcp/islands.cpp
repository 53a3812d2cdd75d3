#include <signorini/lcp/islands.h>

#include <algorithm>
#include <numeric>

namespace signorini::lcp {
namespace {

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) {
    i = parent[i] = parent[parent[i]];
  }
  return i;
}

void join(std::vector<int>& parent, int i, int j) {
  const int a = root(parent, i);
  const int b = root(parent, j);
  parent[std::max(a, b)] = std::min(a, b);
}

void join_entries(const Matrix& M, std::vector<int>& parent) {
  for (int j = 0; j < M.cols(); ++j) {
    for (int i = 0; i < M.rows(); ++i) {
      if (M(i, j) != 0.0) {
        join(parent, i, j);
      }
    }
  }
}

void join_entries(const SparseMatrix& M, std::vector<int>& parent) {
  for (int j = 0; j < M.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(M, j); it; ++it) {
      if (it.value() != 0.0) {
        join(parent, static_cast<int>(it.row()), j);
      }
    }
  }
}

void join_entries(const FactoredMatrix& M, std::vector<int>& parent) {
  for (int i = 0; i < M.rows(); ++i) {
    for (const FactoredMatrix::Entry& entry : M.entries(i)) {
      join(parent, i, M.rows() + entry.block);
    }
  }
}

}  // namespace

void Islands::find(const Problem& problem) {
  const int n = static_cast<int>(problem.size());
  const auto* factored = std::get_if<FactoredMatrix>(&problem.M);
  parent_.resize(n + (factored != nullptr ? factored->mass.block_count() : 0));
  std::iota(parent_.begin(), parent_.end(), 0);
  std::visit([this](const auto& M) { join_entries(M, parent_); }, problem.M);
  for (const CoupledLimit& limit : problem.limits) {
    join(parent_, limit.row, limit.normal_row);
  }
  for (const FrictionCone& cone : problem.cones) {
    for (int k = 1; k < cone.dimension; ++k) {
      join(parent_, cone.normal_row, cone.normal_row + k);
    }
  }
  island.resize(n);
  count = 0;
  for (int i = 0; i < n; ++i) {  // a root is the smallest of its rows
    const int first = root(parent_, i);
    island[i] = first == i ? count++ : island[first];
  }
}

}  // namespace signorini::lcp
