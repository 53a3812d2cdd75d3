#pragma once

#include <map>
#include <set>
#include <string>

namespace tinyxml2 {
class XMLDocument;
}

namespace signorini::validation {

/// Attributes of newer SDFormat that libsdformat 12 drops, by the path of their link or collision
/// ("model 'm', link 'l'"), in the file itself (not in what it includes).
struct SdfExtras {
  std::set<std::string> auto_inertia;               ///< links with <inertial auto="true">
  std::map<std::string, std::string> optimization;  ///< <mesh optimization="...">, by collision
};

[[nodiscard]] SdfExtras read_sdf_extras(const tinyxml2::XMLDocument& document);

}  // namespace signorini::validation
