#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace signorini::lcp {

/// A text file, read line by line, word by word. Words are separated by blanks and tabs; lines end
/// with LF or CRLF. Everything it throws is an InputError with file and line.
class TextLines {
 public:
  /// Reads the whole file. @throws InputError if it is missing, not a regular file or unreadable.
  explicit TextLines(std::filesystem::path file);

  /// Goes to the next line. @return false at the end of the file.
  bool next();
  /// Goes to the next line with a word on it.
  bool next_nonblank();
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] int line_number() const { return line_number_; }

  /// The next word of the line, empty at its end.
  std::string_view word();
  /// The next word as an integer in [least, most]. @param what names it in errors.
  int integer(std::string_view what, int least, int most);
  /// The next word as a finite number.
  double number(std::string_view what);
  /// The next word as a number or inf, +inf, -inf.
  double number_or_infinity(std::string_view what);
  /// @throws InputError if a word is left on the line.
  void expect_end_of_line(std::string_view after);

  /// @throws InputError at the current line.
  [[noreturn]] void fail(const std::string& message) const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::string text_;
  std::string_view rest_;  // of the file, after the line
  std::string_view line_;
  std::string_view line_rest_;
  int line_number_ = 0;
};

/// A word in quotes for an error message: cut to 40 characters, others than printable ASCII shown
/// as '?'.
[[nodiscard]] std::string in_quotes(std::string_view word);

}  // namespace signorini::lcp
