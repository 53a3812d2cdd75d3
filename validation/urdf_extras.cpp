#include <signorini/validation/input_error.h>
#include <signorini/validation/urdf_extras.h>
#include <signorini/validation/xml_check.h>

#include <fmt/format.h>
#include <string_view>
#include <tinyxml2.h>

namespace signorini::validation {
namespace {

using tinyxml2::XMLElement;

constexpr double kBulletFriction = 0.5;

void read_contact(const XMLElement& contact, const std::string& link, UrdfExtras& extras) {
  Material& material = extras.materials[link];
  material = {kBulletFriction, 0.0};
  std::string ignored;
  for (const XMLElement* child = contact.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    if (name == "lateral_friction") {
      material.friction = child->DoubleAttribute("value", material.friction);
    } else if (name == "restitution") {
      material.restitution = child->DoubleAttribute("value", material.restitution);
    } else {
      ignored += fmt::format("{}<{}>", ignored.empty() ? "" : ", ", name);
    }
  }
  extras.notices.push_back(fmt::format(
      "link '{}': friction {} and restitution {} taken from Bullet's <contact> extension", link,
      material.friction, material.restitution));
  if (!ignored.empty()) {
    extras.notices.push_back(
        fmt::format("link '{}': ignored physics in <contact>: {}", link, ignored));
  }
}

/// Why the shape is not supported, or empty.
std::string refusal(const XMLElement& collision) {
  const XMLElement* geometry = collision.FirstChildElement("geometry");
  const XMLElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  return unsupported_shape(shape == nullptr ? "empty" : shape->Name(), SceneFormat::kUrdf);
}

void mark_capsule(XMLElement& collision, int number) {
  XMLElement* geometry = collision.FirstChildElement("geometry");
  XMLElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement("capsule");
  if (shape == nullptr) return;
  shape->SetName("cylinder");
  collision.SetAttribute("name", fmt::format("{}_{}", kCapsuleMark, number).c_str());
}

void check_collisions(XMLElement& link, const std::string& source, bool skip_unsupported,
                      UrdfExtras& extras) {
  XMLElement* next = nullptr;
  int number = 0;
  for (XMLElement* collision = link.FirstChildElement("collision"); collision != nullptr;
       collision = next) {
    next = collision->NextSiblingElement("collision");
    const std::string reason = refusal(*collision);
    if (reason.empty()) {
      mark_capsule(*collision, number++);
      continue;
    }
    const std::string what = locate(*collision, source) + ": " + reason;
    if (!skip_unsupported) throw InputError(what);
    extras.notices.push_back("skipped: " + what);
    link.DeleteChild(collision);
  }
}

}  // namespace

UrdfExtras read_urdf_extras(tinyxml2::XMLDocument& document, const std::string& source,
                            bool skip_unsupported) {
  UrdfExtras extras;
  for (XMLElement* link = document.RootElement()->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    check_collisions(*link, source, skip_unsupported, extras);
    const char* name = link->Attribute("name");
    const XMLElement* contact = link->FirstChildElement("contact");
    if (contact != nullptr) read_contact(*contact, name == nullptr ? "" : name, extras);
  }
  return extras;
}

}  // namespace signorini::validation
