#include <signorini/lcp/fill_ordering.h>
#include <signorini/lcp/types.h>

#include <Eigen/OrderingMethods>
#include <algorithm>

namespace signorini::lcp {

void order_by_minimum_degree(const Graph& graph, std::vector<int>& order) {
  const int n = graph.nodes();
  order.resize(n);
  if (n == 0) {
    return;
  }
  // The lower triangle with its diagonal: Eigen takes a node without one for a dense row.
  SparseMatrix lower(n, n);
  lower.resizeNonZeros(n + static_cast<Index>(graph.neighbours.size()) / 2);
  Index entries = 0;
  for (int k = 0; k < n; ++k) {
    lower.outerIndexPtr()[k] = static_cast<int>(entries);
    lower.innerIndexPtr()[entries++] = k;
    for (int e = graph.start[k]; e < graph.start[k + 1]; ++e) {
      if (graph.neighbours[e] > k) {
        lower.innerIndexPtr()[entries++] = graph.neighbours[e];
      }
    }
  }
  lower.outerIndexPtr()[n] = static_cast<int>(entries);
  std::fill_n(lower.valuePtr(), entries, 1.0);
  Eigen::AMDOrdering<int>::PermutationType permutation;
  Eigen::AMDOrdering<int>()(lower.selfadjointView<Eigen::Lower>(), permutation);
  std::copy_n(permutation.indices().data(), n, order.begin());
}

}  // namespace signorini::lcp
