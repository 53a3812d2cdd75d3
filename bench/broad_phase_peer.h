#pragma once

#include <signorini/collision/bounds.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace signorini::bench {

/// A broad phase as the study sees it: it knows the bodies from the start, and each step is told
/// where all bounds are now and hands over the pairs that may overlap.
class BroadPhasePeer {
 public:
  virtual ~BroadPhasePeer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// @param pairs are replaced; any order, either way round. Every overlapping pair must be in it.
  virtual void step(const std::vector<collision::Bounds>& bounds,
                    std::vector<std::pair<int, int>>& pairs) = 0;
};

using BroadPhasePeers = std::vector<std::unique_ptr<BroadPhasePeer>>;

/// Those of the build that other libraries have, with their data made for these bounds; their sizes
/// must not change from step to step. Each in its own file; absent ones add nothing.
void add_bullet_broad_phases(const std::vector<collision::Bounds>& start, BroadPhasePeers& peers);
void add_fcl_broad_phases(const std::vector<collision::Bounds>& start, BroadPhasePeers& peers);
void add_boost_broad_phases(const std::vector<collision::Bounds>& start, BroadPhasePeers& peers);

}  // namespace signorini::bench
