#pragma once

#include <signorini/lcp/fill_ordering.h>
#include <signorini/lcp/nested_dissection.h>
#include <signorini/lcp/supernodes.h>

#include <vector>

namespace signorini::lcp {

/// The order of elimination of a graph that a sparse factorisation is given: minimum degree, or
/// where that makes many flops nested dissection if it makes fewer. Deterministic.
class LeastFill {
 public:
  /// The symbolic factorisation in that order. Valid until the next call.
  const Supernodes& find(const Graph& graph);

 private:
  NestedDissection nested_dissection_;
  Supernodes supernodes_, other_supernodes_;
  std::vector<int> order_;
};

}  // namespace signorini::lcp
