#pragma once

#include "bench/laws_study.h"

namespace signorini::bench {

/// Bullet's sequential impulses on the impact as it stands: solveGroup() over one manifold a
/// contact, all gaps zero, restitution without threshold, no warm start, no damping.
/// @param iterations >= 1
[[nodiscard]] LawContestant bullet_law(int iterations);

}  // namespace signorini::bench
