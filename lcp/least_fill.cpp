#include <signorini/lcp/least_fill.h>

#include <utility>

namespace signorini::lcp {

const Supernodes& LeastFill::find(const Graph& graph) {
  // Below this a second ordering costs more than it can save in some factorisations.
  constexpr double kManyFlops = 3e7;
  order_by_minimum_degree(graph, order_);
  supernodes_.analyse(graph, order_);
  const double flops = supernodes_.flops(graph);
  if (flops > kManyFlops) {
    nested_dissection_.order(graph, order_);
    other_supernodes_.analyse(graph, order_);
    if (other_supernodes_.flops(graph) < flops) {
      std::swap(supernodes_, other_supernodes_);
    }
  }
  return supernodes_;
}

}  // namespace signorini::lcp
