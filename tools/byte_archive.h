#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace signorini::tools {

/// A type whose fields are listed once for both directions, beside it:
///
///     void visit_fields(auto& archive, Reflects<Check> auto& check) {
///       archive(check.name, check.error);
///     }
template <typename T, typename Fields>
concept Reflects = std::same_as<std::remove_const_t<T>, Fields>;

/// Values as bytes, for the same program: no byte order, no versions.
class ByteWriter {
 public:
  template <typename... Values>
  void operator()(const Values&... values) {
    (write(values), ...);
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  void write_raw(const void* data, std::size_t count) {
    bytes_.append(static_cast<const char*>(data), count);
  }
  template <typename T>
  void write(const T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      write_raw(&value, sizeof value);
    } else {
      visit_fields(*this, value);
    }
  }
  void write(const std::string& text) {
    write(std::uint64_t{text.size()});
    write_raw(text.data(), text.size());
  }
  template <typename T>
  void write(const std::vector<T>& values) {
    write(std::uint64_t{values.size()});
    if constexpr (std::is_trivially_copyable_v<T>) {
      write_raw(values.data(), values.size() * sizeof(T));
    } else {
      for (const T& value : values) write(value);
    }
  }
  template <typename T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  template <typename Key, typename T>
  void write(const std::map<Key, T>& values) {
    write(std::uint64_t{values.size()});
    for (const auto& [key, value] : values) (*this)(key, value);
  }

  std::string bytes_;
};

/// Reads what ByteWriter wrote, in the same order.
/// @throws std::runtime_error where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  template <typename... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }
  /// All bytes were read.
  [[nodiscard]] bool is_done() const { return bytes_.empty(); }

 private:
  std::string_view next(std::size_t count) {
    if (bytes_.size() < count) {
      throw std::runtime_error("the bytes of an answer are cut off");
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  std::size_t count() {
    std::uint64_t number = 0;
    read(number);
    if (number > bytes_.size()) {  // everything that is counted has at least a byte
      throw std::runtime_error("the bytes of an answer are cut off");
    }
    return number;
  }
  template <typename T>
  void read(T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      std::memcpy(&value, next(sizeof value).data(), sizeof value);
    } else {
      visit_fields(*this, value);
    }
  }
  void read(std::string& text) { text = next(count()); }
  template <typename T>
  void read(std::vector<T>& values) {
    values.resize(count());
    if constexpr (std::is_trivially_copyable_v<T>) {
      const std::string_view bytes = next(values.size() * sizeof(T));
      if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    } else {
      for (T& value : values) read(value);
    }
  }
  template <typename T>
  void read(std::optional<T>& value) {
    bool has_value = false;
    read(has_value);
    value.reset();
    if (has_value) read(value.emplace());
  }
  template <typename Key, typename T>
  void read(std::map<Key, T>& values) {
    values.clear();
    for (std::size_t left = count(); left > 0; --left) {
      Key key;
      read(key);
      read(values[key]);
    }
  }

  std::string_view bytes_;
};

template <typename T>
[[nodiscard]] std::string to_bytes(const T& value) {
  ByteWriter writer;
  writer(value);
  return writer.take();
}

/// @throws std::runtime_error if these are not the bytes of a T.
template <typename T>
[[nodiscard]] T from_bytes(std::string_view bytes) {
  T value;
  ByteReader reader(bytes);
  reader(value);
  if (!reader.is_done()) {
    throw std::runtime_error("the bytes of an answer go on after its end");
  }
  return value;
}

}  // namespace signorini::tools
