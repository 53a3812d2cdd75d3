#pragma once

#include <signorini/core/model/material.h>

#include <map>
#include <string>
#include <vector>

namespace tinyxml2 {
class XMLDocument;
}

namespace signorini::validation {

/// What of a URDF file libsdformat does not hand on.
struct UrdfExtras {
  /// By link: lateral_friction and restitution of Bullet's <contact> extension. Links without it
  /// are absent.
  std::map<std::string, Material> materials;
  std::vector<std::string> notices;
};

/// A <capsule> becomes a <cylinder> whose <collision> has this in its name, since libsdformat's
/// URDF parser would drop it without an error.
inline constexpr const char* kCapsuleMark = "signorini_capsule";

/// Reads Bullet's <contact> values, marks capsules, and refuses collision shapes that are not
/// supported.
///
/// lateral_friction (default 0.5, Bullet's) and restitution (default 0) are used; every other
/// <contact> value (rolling_friction, spinning_friction, friction_anchor, ...) is named in a
/// notice.
/// @param skip_unsupported remove such <collision> elements from the document, with a notice
/// @throws InputError naming file, link and shape.
UrdfExtras read_urdf_extras(tinyxml2::XMLDocument& document, const std::string& source,
                            bool skip_unsupported);

}  // namespace signorini::validation
