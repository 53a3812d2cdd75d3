#pragma once

#include <string>
#include <string_view>

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace signorini::validation {

enum class SceneFormat : unsigned char { kSdf, kUrdf };

/// Parses text and says what it is by its root element.
/// @param source how messages name it
/// @throws InputError: not XML (with the line), or a root that is neither <sdf> nor <robot>.
SceneFormat parse_xml(const std::string& text, const std::string& source,
                      tinyxml2::XMLDocument& document);

/// Checks, before any other reader sees them, every number that a run uses: finite, as many as the
/// element needs, mass > 0, lengths and steps > 0, friction >= 0, restitution in [0, 1]. Elements
/// inside <visual>, <sensor>, <plugin>, <gui>, <light>, <state> and <actor> are not looked at.
/// @throws InputError naming file, line, model or link, element, its text and the bound.
void check_numbers(const tinyxml2::XMLDocument& document, SceneFormat format,
                   const std::string& source);

/// Empty for a collision shape that this build reads, else "collision shape <heightmap> is not
/// supported (supported: ...)".
[[nodiscard]] std::string unsupported_shape(std::string_view shape, SceneFormat format);

/// Elements whose content a run does not use: <visual>, <sensor>, <plugin> ...
[[nodiscard]] bool is_without_physics(std::string_view element);

/// "model 'm', link 'l', collision 'c'": the named elements around an element, itself included.
[[nodiscard]] std::string path_of(const tinyxml2::XMLElement& element);

/// "FILE:12: model 'm', link 'l', collision 'c'": where an element lies.
[[nodiscard]] std::string locate(const tinyxml2::XMLElement& element, const std::string& source);

}  // namespace signorini::validation
