#pragma once

#include <signorini/validation/report.h>

#include <cstddef>
#include <vector>

namespace signorini::validation {

/// The lines of a plot with fewer points that look the same. Lines with equal x are cut together
/// into stretches of equal count, and each keeps the same points: of every stretch the first lowest
/// and the first highest of each of them and a NaN if there is one, and the first and the last
/// point of all. So what is compared at one x stays comparable at that x. There are as many
/// stretches as max_points allows, at least one: a line has at most max_points points, unless more
/// than (max_points - 2) / 3 lines have equal x. Lines that are short enough are kept whole.
///
/// @param max_points  at least 5. x and y of each line are as long as each other.
/// Cost: O(n) for each line, times the logarithm of max_points where they oscillate.
[[nodiscard]] std::vector<Series> thinned(const std::vector<Series>& lines, std::size_t max_points);

}  // namespace signorini::validation
