#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>

namespace signorini::testing {

/// What a fuzzer's bytes mean: numbers, small and hostile.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  [[nodiscard]] bool at_end() const { return at_ >= size_; }
  std::uint8_t byte() { return at_end() ? std::uint8_t{0} : data_[at_++]; }
  /// In [0, count).
  int below(int count) { return byte() % count; }
  /// The rest up to a zero byte, as text.
  std::string text() {
    std::string text;
    while (!at_end()) {
      const std::uint8_t next = byte();
      if (next == 0) {
        break;
      }
      text += static_cast<char>(next);
    }
    return text;
  }
  /// Mostly a small whole number or a sixteenth; sometimes any eight bytes.
  double number() {
    const std::uint8_t kind = byte();
    if (kind == 255) {
      std::uint8_t bits[sizeof(double)];
      for (std::uint8_t& bit : bits) {
        bit = byte();
      }
      double value = 0.0;
      std::memcpy(&value, bits, sizeof value);
      return value;
    }
    const auto value = static_cast<double>(static_cast<std::int8_t>(byte()));
    switch (kind % 8) {
      case 0: return 0.0;
      case 1: return value / 16.0;
      case 2: return value * 1e-9;
      case 3: return value * 1e9;
      case 4: return value / 3.0;
      default: return static_cast<double>(static_cast<int>(value) / 16);
    }
  }
  /// A count that no array of a few numbers can have, or a plausible one.
  std::int64_t count() {
    constexpr std::int64_t kHostile[] = {-1, std::numeric_limits<std::int64_t>::min(),
                                         std::numeric_limits<std::int64_t>::max(),
                                         1'000'000'000'000, std::int64_t{1} << 31};
    const std::uint8_t kind = byte();
    return kind >= 250 ? kHostile[kind % 5] : kind % 8;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

/// Ends the process with a message: a fuzzer's finding.
[[noreturn]] inline void broken(const std::string& promise) {
  std::fprintf(stderr, "broken promise: %s\n", promise.c_str());
  std::abort();
}

inline void require(bool kept, const char* promise) {
  if (!kept) {
    broken(promise);
  }
}

}  // namespace signorini::testing
