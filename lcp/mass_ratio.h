#pragma once

#include <signorini/lcp/block_mass.h>

namespace signorini::lcp {

/// The largest over the smallest mass of the blocks, each taken as 1 / W_00 or M_00, whichever it
/// was given by; at least 1, +infinity where one is 0 or infinite. Cost: O(block_count()).
[[nodiscard]] double mass_ratio(const BlockMass& mass);

}  // namespace signorini::lcp
