#pragma once

#include <signorini/validation/report.h>

#include <cstddef>

namespace signorini::validation {

/// A line with fewer points that looks the same: the points are cut into `stretches` stretches of
/// equal count, and of each the first lowest and the first highest y are kept, a NaN if it has one,
/// and the first and the last point of all. A line of at most 2 * stretches + 2 points is kept
/// whole. x and y are as long as each other; the order is kept. O(n).
[[nodiscard]] Series thinned(const Series& series, std::size_t stretches);

}  // namespace signorini::validation
