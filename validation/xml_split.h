#pragma once

#include <map>
#include <string>
#include <vector>

namespace tinyxml2 {
class XMLDocument;
}

namespace signorini::validation {

/// A world of very many models in pieces: libsdformat copies a description of every element that a
/// link could have into every link, gigabytes for thousands of models at once.
struct SplitWorld {
  std::string world;                           ///< the document without the world's models
  std::vector<std::string> models;             ///< documents of a world of some of its models alone
  std::map<std::string, int> without_physics;  ///< elements left out (xml_check.h), and how many
};

/// True for an SDFormat world of more than `most` models that do not depend on one another: nothing
/// is included, the world has no frames or joints, and no model's pose is relative to anything.
[[nodiscard]] bool can_be_split(const tinyxml2::XMLDocument& document, int most);

/// The pieces, of `models_each` models or less. Every element keeps its line number.
/// @throws InputError: two models of one name.
[[nodiscard]] SplitWorld split_world(const tinyxml2::XMLDocument& document,
                                     const std::string& source, int models_each);

}  // namespace signorini::validation
