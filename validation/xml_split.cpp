#include <signorini/validation/input_error.h>
#include <signorini/validation/xml_check.h>
#include <signorini/validation/xml_split.h>

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <string_view>
#include <tinyxml2.h>

namespace signorini::validation {
namespace {

using tinyxml2::XMLElement;

template <typename Visit>
void for_each_child(const XMLElement& element, const Visit& visit) {
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    visit(*child);
  }
}

bool includes(const XMLElement& element) {
  bool found = std::string_view(element.Name()) == "include";
  for_each_child(element, [&](const XMLElement& child) { found = found || includes(child); });
  return found;
}

std::string escaped(const char* text) {
  std::string result;
  for (const char* c = text; c != nullptr && *c != '\0'; ++c) {
    switch (*c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += *c;
    }
  }
  return result;
}

/// Prints elements on the lines where they stand.
class LinePrinter {
 public:
  explicit LinePrinter(SplitWorld& split) : split_(split) {}

  /// @param models print the models that are children of this element
  void print(const XMLElement& element, bool models) {
    open(element);
    for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr;
         node = node->NextSibling()) {
      if (const tinyxml2::XMLText* text = node->ToText()) out_ += escaped(text->Value());
      const XMLElement* child = node->ToElement();
      if (child == nullptr) continue;
      const std::string_view name = child->Name();
      if (is_without_physics(name)) {
        ++split_.without_physics[std::string(name)];
      } else if (models || name != "model") {
        print(*child, models);
      }
    }
    close(element);
  }
  void open(const XMLElement& element) {
    for (; line_ < element.GetLineNum(); ++line_) out_ += '\n';
    out_ += fmt::format("<{}", element.Name());
    for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      out_ += fmt::format(" {}=\"{}\"", a->Name(), escaped(a->Value()));
    }
    out_ += '>';
  }
  void close(const XMLElement& element) { out_ += fmt::format("</{}>", element.Name()); }

  [[nodiscard]] const std::string& text() const { return out_; }

 private:
  SplitWorld& split_;
  std::string out_;
  int line_ = 1;
};

}  // namespace

bool can_be_split(const tinyxml2::XMLDocument& document, int most) {
  const XMLElement& root = *document.RootElement();
  const XMLElement* world = root.FirstChildElement("world");
  if (world == nullptr || world->NextSiblingElement("world") != nullptr || includes(root)) {
    return false;
  }
  int models = 0;
  bool apart = true;
  for_each_child(*world, [&](const XMLElement& child) {
    const std::string_view name = child.Name();
    if (name == "frame" || name == "joint") apart = false;
    if (name != "model") return;
    ++models;
    const XMLElement* pose = child.FirstChildElement("pose");
    if (pose != nullptr && pose->Attribute("relative_to") != nullptr) apart = false;
  });
  return apart && models > most;
}

SplitWorld split_world(const tinyxml2::XMLDocument& document, const std::string& source,
                       int models_each) {
  const XMLElement& root = *document.RootElement();
  const XMLElement& world = *root.FirstChildElement("world");
  SplitWorld split;
  LinePrinter whole(split);
  whole.print(root, false);
  split.world = whole.text();
  std::set<std::string> names;
  std::vector<const XMLElement*> models;
  for_each_child(world, [&](const XMLElement& child) {
    if (std::string_view(child.Name()) != "model") return;
    const char* name = child.Attribute("name");
    if (name != nullptr && !names.insert(name).second) {
      throw InputError(locate(child, source) + ": another model of the world has this name");
    }
    models.push_back(&child);
  });
  for (std::size_t begin = 0; begin < models.size(); begin += models_each) {
    LinePrinter some(split);
    some.open(root);
    some.open(world);
    for (std::size_t i = begin; i < std::min(models.size(), begin + models_each); ++i) {
      some.print(*models[i], true);
    }
    some.close(world);
    some.close(root);
    split.models.push_back(some.text());
  }
  return split;
}

}  // namespace signorini::validation
