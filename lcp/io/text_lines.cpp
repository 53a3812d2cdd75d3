#include <signorini/lcp/io/input_error.h>
#include <signorini/lcp/io/text_lines.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

namespace signorini::lcp {
namespace {

constexpr std::size_t kMaxShown = 40;
constexpr std::string_view kBlanks = " \t";

std::string read_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(file, 0, "no such file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(file, 0, "not a regular file");
  }
  const auto size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) {
    throw InputError(file, 0, "cannot be opened for reading");
  }
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    throw InputError(file, 0, "cannot be read to its end");
  }
  return text;
}

/// std::from_chars takes no plus sign.
std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

}  // namespace

std::string in_quotes(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, kMaxShown)) {
    text += c >= 0x20 && c < 0x7f ? c : '?';
  }
  return text + (word.size() > kMaxShown ? "...'" : "'");
}

TextLines::TextLines(std::filesystem::path file)
    : file_(std::move(file)), text_(read_file(file_)), rest_(text_) {}

bool TextLines::next() {
  if (rest_.empty()) {
    line_ = line_rest_ = {};
    return false;
  }
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
  if (line_.ends_with('\r')) {
    line_.remove_suffix(1);
  }
  line_rest_ = line_;
  ++line_number_;
  return true;
}

bool TextLines::next_nonblank() {
  while (next()) {
    if (line_.find_first_not_of(kBlanks) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

std::string_view TextLines::word() {
  const std::size_t begin = line_rest_.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    line_rest_ = {};
    return {};
  }
  line_rest_.remove_prefix(begin);
  const std::string_view found = line_rest_.substr(0, line_rest_.find_first_of(kBlanks));
  line_rest_.remove_prefix(found.size());
  return found;
}

int TextLines::integer(std::string_view what, int least, int most) {
  const std::string_view found = word();
  const std::string_view digits = without_plus(found);
  long long value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_integer = !digits.empty() && end == digits.data() + digits.size() &&
                          error != std::errc::invalid_argument;
  if (!is_integer || error == std::errc::result_out_of_range || value < least || value > most) {
    fail(std::string(what) + ": expected an integer from " + std::to_string(least) + " to " +
         std::to_string(most) + ", found " +
         (found.empty() ? "the end of the line" : in_quotes(found)));
  }
  return static_cast<int>(value);
}

double TextLines::number_or_infinity(std::string_view what) {
  const std::string_view found = word();
  const std::string_view digits = without_plus(found);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_number = !digits.empty() && end == digits.data() + digits.size() &&
                         error != std::errc::invalid_argument;
  if (!is_number) {
    fail(std::string(what) + ": expected a number, found " +
         (found.empty() ? "the end of the line" : in_quotes(found)));
  }
  if (error == std::errc::result_out_of_range || std::isnan(value)) {
    fail(std::string(what) + ": expected a finite number in the range of double, found " +
         in_quotes(found));
  }
  return value;
}

double TextLines::number(std::string_view what) {
  const std::string_view rest = line_rest_;
  const double value = number_or_infinity(what);
  if (!std::isfinite(value)) {
    line_rest_ = rest;
    fail(std::string(what) + ": expected a finite number in the range of double, found " +
         in_quotes(word()));
  }
  return value;
}

void TextLines::expect_end_of_line(std::string_view after) {
  if (const std::string_view found = word(); !found.empty()) {
    fail("expected the end of the line after " + std::string(after) + ", found " +
         in_quotes(found));
  }
}

void TextLines::fail(const std::string& message) const {
  throw InputError(file_, line_number_, message);
}

}  // namespace signorini::lcp
