#pragma once

#include <signorini/lcp/problem.h>

#include <vector>

namespace signorini::lcp {

/// The islands of a problem: the smallest sets of rows that no entry of M, no shared body, no cone
/// and no coupled limit connects. Each is a problem of its own.
struct Islands {
  std::vector<int> island;  ///< of every row; numbered by their first row, from 0
  int count = 0;

  /// The islands of `problem` (shapes checked). An entry of M that is 0 connects nothing; one that
  /// is not finite connects. Cost: O(entries), for a factored M of J.
  void find(const Problem& problem);

 private:
  std::vector<int> parent_;  // of the union-find forest over rows and, after them, blocks
};

}  // namespace signorini::lcp
