#pragma once

#include <string>
#include <vector>

namespace tinyxml2 {
class XMLDocument;
}  // namespace tinyxml2

namespace signorini::validation {

/// How many <include>s one scene may expand to, those inside included files counted each time: the
/// memory of libsdformat grows by megabytes with each.
inline constexpr int kMostIncludes = 1000;
/// How deep files may include one another.
inline constexpr int kDeepestInclude = 50;

/// Follows the <include>s of an SDFormat document through the files, as libsdformat will: it
/// follows those of a file that includes itself until memory or stack end. Files that cannot be
/// found or parsed are left to libsdformat's own message.
/// @param file the document's own; empty for text without one
/// @param source how messages name it
/// @return the files that were followed, each as often as it is included
/// @throws InputError naming file and line of an <include> of a file that is being read already, of
/// something that is no regular file or folder, deeper than kDeepestInclude, or one too many
[[nodiscard]] std::vector<std::string> check_includes(const tinyxml2::XMLDocument& document,
                                                      const std::string& file,
                                                      const std::string& source);

}  // namespace signorini::validation
