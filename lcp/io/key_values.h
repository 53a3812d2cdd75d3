#pragma once

#include <signorini/lcp/io/input_error.h>

#include <filesystem>
#include <map>
#include <string>

namespace signorini::lcp {

/// A file of lines `key value`, each key once.
class KeyValues {
 public:
  /// @throws InputError if the file cannot be read, a line is not `key value`, or a key comes twice
  explicit KeyValues(const std::filesystem::path& file);

  [[nodiscard]] bool has(const std::string& key) const { return values_.contains(key); }
  /// @throws InputError if the key is absent
  [[nodiscard]] const std::string& text(const std::string& key) const;
  /// An integer >= 0. @throws InputError if the key is absent or its value is something else
  [[nodiscard]] int count(const std::string& key) const;
  /// The same, or `otherwise` where the key is absent.
  [[nodiscard]] int count(const std::string& key, int otherwise) const;

  /// @throws InputError at the line of the key
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

 private:
  struct Value {
    std::string text;
    int line;
  };
  std::filesystem::path file_;
  std::map<std::string, Value> values_;
};

}  // namespace signorini::lcp
