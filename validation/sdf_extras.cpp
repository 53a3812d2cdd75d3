#include <signorini/validation/sdf_extras.h>
#include <signorini/validation/xml_check.h>

#include <string_view>
#include <tinyxml2.h>

namespace signorini::validation {
namespace {

void walk(const tinyxml2::XMLElement& element, SdfExtras& extras) {
  const std::string_view name = element.Name();
  if (is_without_physics(name)) return;
  if (name == "inertial" && element.BoolAttribute("auto", false)) {
    extras.auto_inertia.insert(path_of(element));
  }
  if (const char* how = name == "mesh" ? element.Attribute("optimization") : nullptr) {
    extras.optimization[path_of(element)] = how;
  }
  for (const tinyxml2::XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    walk(*child, extras);
  }
}

}  // namespace

SdfExtras read_sdf_extras(const tinyxml2::XMLDocument& document) {
  SdfExtras extras;
  walk(*document.RootElement(), extras);
  return extras;
}

}  // namespace signorini::validation
