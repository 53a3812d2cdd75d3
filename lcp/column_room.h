#pragma once

#include <signorini/lcp/types.h>

#include <algorithm>

namespace signorini::lcp {

/// Makes M at least rows x columns and keeps its numbers. Columns come one by one: where they are
/// too few their number doubles, and only there. Rows are as many as the largest problem has.
inline void make_room(Matrix& M, Index rows, Index columns) {
  constexpr Index kFewColumns = 16;
  if (M.rows() >= rows && M.cols() >= columns) {
    return;
  }
  const Index doubled = std::max({columns, 2 * M.cols(), kFewColumns});
  M.conservativeResize(std::max(rows, M.rows()), columns > M.cols() ? doubled : M.cols());
}

}  // namespace signorini::lcp
