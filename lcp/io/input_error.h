#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace signorini::lcp {

/// A file that cannot be read. what() is "FILE:LINE: what was found and what was expected", without
/// ":LINE" where no line is to blame. Programs end with exit code 65.
class InputError : public std::runtime_error {
 public:
  /// @param line counted from 1; 0: no line
  InputError(std::filesystem::path file, int line, const std::string& message);

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] int line() const { return line_; }

 private:
  std::filesystem::path file_;
  int line_;
};

}  // namespace signorini::lcp
