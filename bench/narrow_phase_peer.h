#pragma once

#include <signorini/collision/shape.h>
#include <signorini/core/model/contact.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace signorini::bench {

/// A narrow phase as the study sees it: the shapes are known from the start, each query is told the
/// two poses.
class NarrowPhasePeer {
 public:
  virtual ~NarrowPhasePeer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// The clock runs.
  virtual void query(const Pose& a, const Pose& b) = 0;
  /// What the last query found: points, normal from B to A, gap. The clock does not run.
  virtual void read(std::vector<Contact>& contacts) = 0;
};

using NarrowPhasePeers = std::vector<std::unique_ptr<NarrowPhasePeer>>;

/// Those of the build that other libraries have; a library that lacks a shape adds nothing.
void add_bullet_narrow_phase(const collision::Shape& a, const collision::Shape& b,
                             NarrowPhasePeers& peers);
void add_fcl_narrow_phase(const collision::Shape& a, const collision::Shape& b,
                          NarrowPhasePeers& peers);

}  // namespace signorini::bench
