#pragma once

#include <signorini/lcp/block_mass.h>

namespace signorini::lcp {

/// The largest over the smallest mass of the blocks, each taken as 1 / W_00 or M_00, whichever it
/// was given by; at least 1, +infinity where one is 0 or infinite. Cost: O(block_count()).
[[nodiscard]] double mass_ratio(const BlockMass& mass);

/// Whether masses are within 1 to 100: of what is further apart solvers see later which contacts
/// press.
[[nodiscard]] inline bool are_masses_alike(const BlockMass& mass) {
  constexpr double kAlike = 100.0;
  return mass_ratio(mass) <= kAlike;
}

}  // namespace signorini::lcp
