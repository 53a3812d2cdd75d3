#include "tools/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <fmt/format.h>
#include <stdexcept>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace signorini::tools {
namespace {

/// Removes the partial file unless it has been renamed.
class PartialFile {
 public:
  explicit PartialFile(std::filesystem::path path) : path_(std::move(path)) {}
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    std::error_code ignored;
    if (!renamed_) std::filesystem::remove(path_, ignored);
  }

  /// @return 0, or the errno of what failed.
  [[nodiscard]] int write(std::string_view text) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr) return errno;
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const int write_error = errno;
    // A full disk may show only when the buffer is flushed by the closing.
    if (std::fclose(file) != 0) return errno;
    return written ? 0 : write_error;
  }

  [[nodiscard]] std::error_code rename_to(const std::filesystem::path& file) {
    std::error_code error;
    std::filesystem::rename(path_, file, error);
    renamed_ = !error;
    return error;
  }

 private:
  std::filesystem::path path_;
  bool renamed_ = false;
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::error_code& error) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), error.message()));
}

}  // namespace

void write_whole_file(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path partial_path = file;
  partial_path += fmt::format(".partial-{}", getpid());
  PartialFile partial(std::move(partial_path));
  if (const int error = partial.write(text)) fail(file, {error, std::generic_category()});
  if (const std::error_code error = partial.rename_to(file)) fail(file, error);
}

}  // namespace signorini::tools
