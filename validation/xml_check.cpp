#include <signorini/validation/input_error.h>
#include <signorini/validation/xml_check.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <string_view>
#include <tinyxml2.h>
#include <vector>

namespace signorini::validation {
namespace {

using tinyxml2::XMLElement;

enum class Bound : unsigned char { kFinite, kPositive, kNotNegative, kUnitInterval, kDirection };

struct NumberRule {
  int count;
  Bound bound = Bound::kFinite;
};

/// <pose> holds six numbers (or quaternions, in rotation_format="quat_xyzw": seven).
const std::map<std::string_view, NumberRule>& sdf_rules() {
  static const std::map<std::string_view, NumberRule> kRules = {
      {"mass", {1, Bound::kPositive}},
      {"ixx", {1}},
      {"ixy", {1}},
      {"ixz", {1}},
      {"iyy", {1}},
      {"iyz", {1}},
      {"izz", {1}},
      {"max_step_size", {1, Bound::kPositive}},
      {"gravity", {3}},
      {"radius", {1, Bound::kPositive}},
      {"length", {1, Bound::kPositive}},
      {"radii", {3, Bound::kPositive}},
      {"scale", {3, Bound::kPositive}},
      {"density", {1, Bound::kPositive}},
      {"normal", {3}},
      {"mu", {1, Bound::kNotNegative}},
      {"mu2", {1, Bound::kNotNegative}},
      {"xyz", {3, Bound::kDirection}},
      {"restitution_coefficient", {1, Bound::kUnitInterval}},
      {"signorini:duration", {1, Bound::kPositive}},
      {"signorini:error_scale", {1, Bound::kPositive}},
      {"signorini:linear_velocity", {3}},
      {"signorini:angular_velocity", {3}},
  };
  return kRules;
}

/// Attributes of URDF elements.
const std::map<std::pair<std::string_view, std::string_view>, NumberRule>& urdf_rules() {
  static const std::map<std::pair<std::string_view, std::string_view>, NumberRule> kRules = {
      {{"mass", "value"}, {1, Bound::kPositive}},
      {{"inertia", "ixx"}, {1}},
      {{"inertia", "ixy"}, {1}},
      {{"inertia", "ixz"}, {1}},
      {{"inertia", "iyy"}, {1}},
      {{"inertia", "iyz"}, {1}},
      {{"inertia", "izz"}, {1}},
      {{"origin", "xyz"}, {3}},
      {{"origin", "rpy"}, {3}},
      {{"axis", "xyz"}, {3, Bound::kDirection}},
      {{"box", "size"}, {3, Bound::kPositive}},
      {{"sphere", "radius"}, {1, Bound::kPositive}},
      {{"cylinder", "radius"}, {1, Bound::kPositive}},
      {{"cylinder", "length"}, {1, Bound::kPositive}},
      {{"capsule", "radius"}, {1, Bound::kPositive}},
      {{"capsule", "length"}, {1, Bound::kPositive}},
      {{"mesh", "scale"}, {3, Bound::kPositive}},
      {{"lateral_friction", "value"}, {1, Bound::kNotNegative}},
      {{"restitution", "value"}, {1, Bound::kUnitInterval}},
  };
  return kRules;
}

std::string_view wish(Bound bound) {
  switch (bound) {
    case Bound::kFinite: return "finite";
    case Bound::kPositive: return "finite and > 0";
    case Bound::kNotNegative: return "finite and >= 0";
    case Bound::kUnitInterval: return "in [0, 1]";
    case Bound::kDirection: return "finite and not all zero";
  }
  return "";
}

bool meets(double value, Bound bound) {
  if (!std::isfinite(value)) return false;
  switch (bound) {
    case Bound::kFinite:
    case Bound::kDirection: return true;
    case Bound::kPositive: return value > 0.0;
    case Bound::kNotNegative: return value >= 0.0;
    case Bound::kUnitInterval: return value >= 0.0 && value <= 1.0;
  }
  return false;
}

std::vector<std::string_view> words(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  std::vector<std::string_view> found;
  for (std::size_t begin = text.find_first_not_of(kSpace); begin != std::string_view::npos;
       begin = text.find_first_not_of(kSpace, begin)) {
    const std::size_t end = std::min(text.find_first_of(kSpace, begin), text.size());
    found.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return found;
}

std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

void check_text(const char* text, const NumberRule& rule, const XMLElement& element,
                const std::string& field, const std::string& source) {
  const std::string given = text == nullptr ? "" : text;
  const std::vector<std::string_view> parts = words(given);
  bool good = static_cast<int>(parts.size()) == rule.count;
  bool all_zero = true;
  for (const std::string_view part : parts) {
    const std::optional<double> value = number(part);
    good = good && value.has_value() && meets(*value, rule.bound);
    all_zero = all_zero && value == 0.0;
  }
  good = good && !(all_zero && rule.bound == Bound::kDirection);
  if (!good) {
    throw InputError(fmt::format("{}: {}: must be {} number{}, {}, got '{}'",
                                 locate(element, source), field, rule.count,
                                 rule.count == 1 ? "" : "s", wish(rule.bound), given));
  }
}

/// libsdformat reads decimal and 0x...; it would read -1 as all bits.
void check_bitmask(const XMLElement& element, const std::string& source) {
  const std::string given = element.GetText() == nullptr ? "" : element.GetText();
  const std::vector<std::string_view> parts = words(given);
  bool good = parts.size() == 1;
  if (good) {
    std::string_view digits = parts[0];
    const bool hexadecimal = digits.starts_with("0x") || digits.starts_with("0X");
    if (hexadecimal) digits.remove_prefix(2);
    std::uint32_t value = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value, hexadecimal ? 16 : 10);
    good = error == std::errc() && end == digits.data() + digits.size();
  }
  if (!good) {
    throw InputError(fmt::format("{}: <collide_bitmask>: must be an integer in [0, 2^32), got '{}'",
                                 locate(element, source), given));
  }
}

/// <size> is 3 positive numbers in a box and 2 in a plane.
std::optional<NumberRule> sdf_rule(const XMLElement& element) {
  const std::string_view name = element.Name();
  const XMLElement* parent = element.Parent() ? element.Parent()->ToElement() : nullptr;
  const std::string_view parent_name = parent == nullptr ? "" : parent->Name();
  if (name == "point" && parent_name == "polyline") return NumberRule{2};
  if (name == "height" && parent_name == "polyline") return NumberRule{1, Bound::kPositive};
  if (name == "size" && parent_name == "box") return NumberRule{3, Bound::kPositive};
  if (name == "pose") {
    const char* format = element.Attribute("rotation_format");
    const bool quaternion = format != nullptr && std::strcmp(format, "quat_xyzw") == 0;
    // An empty <pose relative_to="..."/> is a pose of zeros.
    if (element.GetText() == nullptr) return std::nullopt;
    return NumberRule{quaternion ? 7 : 6};
  }
  // <gravity> of a link is a flag.
  if (name == "gravity" && parent_name != "world") return std::nullopt;
  const auto rule = sdf_rules().find(name);
  if (rule == sdf_rules().end()) return std::nullopt;
  return rule->second;
}

void check_element(const XMLElement& element, SceneFormat format, const std::string& source) {
  if (is_without_physics(element.Name())) return;
  if (format == SceneFormat::kSdf) {
    if (std::string_view(element.Name()) == "collide_bitmask") check_bitmask(element, source);
    if (const std::optional<NumberRule> rule = sdf_rule(element)) {
      check_text(element.GetText(), *rule, element, fmt::format("<{}>", element.Name()), source);
    }
  } else {
    for (const auto& [key, rule] : urdf_rules()) {
      const char* value =
          key.first == element.Name() ? element.Attribute(key.second.data()) : nullptr;
      if (value == nullptr) continue;
      check_text(value, rule, element, fmt::format("<{} {}>", key.first, key.second), source);
    }
  }
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    check_element(*child, format, source);
  }
}

}  // namespace

bool is_without_physics(std::string_view name) {
  return name == "visual" || name == "sensor" || name == "plugin" || name == "gui" ||
         name == "light" || name == "state" || name == "actor" || name == "scene" ||
         name == "material" || name == "gazebo" || name == "transmission";
}

std::string unsupported_shape(std::string_view shape, SceneFormat format) {
#ifdef SIGNORINI_HAS_MESH_FILES
  constexpr std::string_view kMesh = ", mesh";
#else
  constexpr std::string_view kMesh = "";  // needs SIGNORINI_WITH_ASSIMP
#endif
  const std::string supported =
      format == SceneFormat::kSdf
          ? fmt::format("box, sphere, cylinder, capsule, ellipsoid, cone, plane, polyline{}", kMesh)
          : fmt::format("box, sphere, cylinder, capsule{}", kMesh);
  if ((", " + supported + ",").find(fmt::format(", {},", shape)) != std::string::npos) return "";
  return fmt::format("collision shape <{}> is not supported (supported: {})", shape, supported);
}

SceneFormat parse_xml(const std::string& text, const std::string& source,
                      tinyxml2::XMLDocument& document) {
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError(fmt::format("{}:{}: not well-formed XML: {}", source, document.ErrorLineNum(),
                                 document.ErrorName()));
  }
  const XMLElement* root = document.RootElement();
  const std::string_view name = root == nullptr ? "" : root->Name();
  if (name == "sdf" || name == "gazebo") return SceneFormat::kSdf;
  if (name == "robot") return SceneFormat::kUrdf;
  throw InputError(
      fmt::format("{}: root element: must be <sdf> or <robot>, got <{}>", source, name));
}

void check_numbers(const tinyxml2::XMLDocument& document, SceneFormat format,
                   const std::string& source) {
  check_element(*document.RootElement(), format, source);
}

std::string path_of(const XMLElement& element) {
  std::string path;
  for (const tinyxml2::XMLNode* node = &element; node != nullptr; node = node->Parent()) {
    const XMLElement* ancestor = node->ToElement();
    if (ancestor == nullptr || ancestor->Attribute("name") == nullptr) continue;
    const std::string_view name = ancestor->Name();
    if (name != "model" && name != "link" && name != "collision" && name != "joint") continue;
    path = fmt::format("{} '{}'{}{}", name, ancestor->Attribute("name"), path.empty() ? "" : ", ",
                       path);
  }
  return path;
}

std::string locate(const XMLElement& element, const std::string& source) {
  const std::string path = path_of(element);
  return fmt::format("{}:{}{}{}", source, element.GetLineNum(), path.empty() ? "" : ": ", path);
}

}  // namespace signorini::validation
