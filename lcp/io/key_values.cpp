#include <signorini/lcp/io/key_values.h>
#include <signorini/lcp/io/text_lines.h>

#include <limits>

namespace signorini::lcp {

KeyValues::KeyValues(const std::filesystem::path& file) : file_(file) {
  TextLines lines(file);
  while (lines.next_nonblank()) {
    const std::string key(lines.word());
    const std::string value(lines.word());
    if (value.empty()) {
      lines.fail(key + ": expected a value, found the end of the line");
    }
    lines.expect_end_of_line("the value of " + key);
    if (!values_.emplace(key, Value{value, lines.line_number()}).second) {
      lines.fail(key + ": was given before, in line " + std::to_string(values_[key].line));
    }
  }
}

const std::string& KeyValues::text(const std::string& key) const {
  const auto found = values_.find(key);
  if (found == values_.end()) {
    throw InputError(file_, 0, key + ": expected this key, found none");
  }
  return found->second.text;
}

int KeyValues::count(const std::string& key) const {
  constexpr int kMost = std::numeric_limits<int>::max();
  const std::string& value = text(key);
  const bool digits = value.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || value.size() > 10 || std::stoll(value) > kMost) {
    fail(key,
         "expected an integer from 0 to " + std::to_string(kMost) + ", found " + in_quotes(value));
  }
  return std::stoi(value);
}

int KeyValues::count(const std::string& key, int otherwise) const {
  return has(key) ? count(key) : otherwise;
}

void KeyValues::fail(const std::string& key, const std::string& message) const {
  const auto found = values_.find(key);
  throw InputError(file_, found == values_.end() ? 0 : found->second.line, key + ": " + message);
}

}  // namespace signorini::lcp
