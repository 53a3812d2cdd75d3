#include <signorini/validation/bullet_file.h>
#include <signorini/validation/bullet_file_chunks.h>
#include <signorini/validation/input_error.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace signorini::validation {
namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  if (!std::filesystem::is_regular_file(path) || !file || !(bytes << file.rdbuf())) {
    throw InputError(path + ": cannot be read");
  }
  return bytes.str();
}

}  // namespace

Scene read_any_scene_file(const std::string& path, const ReadOptions& options) {
  if (!is_bullet_file(path)) return read_scene_file(path, options);
  return read_any_scene_text(bytes_of(path), path, options);
}

Scene read_any_scene_text(const std::string& text, const std::string& source,
                          const ReadOptions& options) {
  if (!is_bullet_file(source)) return read_scene_text(text, source, options);
#ifdef SIGNORINI_HAS_BULLET_FILES
  return read_bullet_bytes(text, source, options);
#else
  throw InputError(source +
                   ": this build reads no .bullet files: Bullet's importer "
                   "(libbullet-extras-dev) was not found");
#endif
}

}  // namespace signorini::validation
