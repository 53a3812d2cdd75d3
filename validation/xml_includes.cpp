#include <signorini/validation/input_error.h>
#include <signorini/validation/xml_check.h>
#include <signorini/validation/xml_includes.h>

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <sdf/sdf.hh>
#include <string_view>
#include <system_error>
#include <tinyxml2.h>
#include <utility>
#include <vector>

namespace signorini::validation {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

/// The file that libsdformat reads for a <uri>; empty if it finds none.
fs::path included_file(const XMLElement& include) {
  const XMLElement* uri = include.FirstChildElement("uri");
  if (uri == nullptr || uri->GetText() == nullptr) return {};
  std::error_code error;
  fs::path file = sdf::findFile(uri->GetText(), true, false, sdf::ParserConfig());
  if (!file.empty() && fs::is_directory(file, error)) {
    // Without a model.config libsdformat refuses the folder.
    if (!fs::exists(file / "model.config", error)) return {};
    file = sdf::getModelFilePath(file.string());
  }
  return file.empty() ? file : fs::weakly_canonical(file, error);
}

/// Stops at the first <include> that is too much.
class IncludeWalk {
 public:
  explicit IncludeWalk(const std::string& file) {
    std::error_code error;
    if (!file.empty()) open_.push_back(fs::weakly_canonical(file, error));
  }

  [[nodiscard]] std::vector<std::string> take_files() { return std::move(files_); }

  void walk(const XMLElement& element, const std::string& source) {
    if (is_without_physics(element.Name())) return;
    if (std::string_view(element.Name()) == "include") follow(element, source);
    for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      walk(*child, source);
    }
  }

 private:
  void follow(const XMLElement& include, const std::string& source) {
    if (++count_ > kMostIncludes) {
      fail(include, source, fmt::format("at most {} in all", kMostIncludes));
    }
    const fs::path file = included_file(include);
    if (file.empty()) return;
    if (std::find(open_.begin(), open_.end(), file) != open_.end()) {
      fail(include, source, fmt::format("{} includes itself", file.string()));
    }
    if (std::ssize(open_) > kDeepestInclude) {
      fail(include, source, fmt::format("at most {} deep", kDeepestInclude));
    }
    std::error_code error;
    if (!fs::is_regular_file(file, error)) {
      fail(include, source, fmt::format("{} is not a file", file.string()));
    }
    files_.push_back(file.string());
    tinyxml2::XMLDocument document;
    if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) return;
    const XMLElement* root = document.RootElement();
    if (root == nullptr) return;  // comments alone: libsdformat refuses it
    open_.push_back(file);
    walk(*root, file.string());
    open_.pop_back();
  }

  [[noreturn]] static void fail(const XMLElement& include, const std::string& source,
                                const std::string& what) {
    throw InputError(fmt::format("{}: <include>: {}", locate(include, source), what));
  }

  std::vector<std::string> files_;
  std::vector<fs::path> open_;  ///< being read, the outermost first
  int count_ = 0;
};

}  // namespace

std::vector<std::string> check_includes(const tinyxml2::XMLDocument& document,
                                        const std::string& file, const std::string& source) {
  IncludeWalk walk(file);
  walk.walk(*document.RootElement(), source);
  return walk.take_files();
}

}  // namespace signorini::validation
