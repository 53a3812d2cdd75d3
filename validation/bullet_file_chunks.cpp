#include <signorini/validation/bullet_file_chunks.h>
#include <signorini/validation/input_error.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <limits>

namespace signorini::validation {
namespace {

constexpr std::size_t kHeader = 12;
constexpr std::size_t kMostBytes = std::numeric_limits<std::int32_t>::max();

std::int32_t integer_at(std::string_view bytes, std::size_t place) {
  std::int32_t value = 0;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

[[noreturn]] void refuse(const std::string& source, std::size_t place, const std::string& what) {
  throw InputError(fmt::format("{}: byte {}: {}", source, place, what));
}

BulletFileHeader check_header(std::string_view bytes, const std::string& source,
                              std::size_t& pointer_bytes) {
  if (bytes.size() < kHeader || !bytes.starts_with("BULLET")) {
    refuse(source, 0, "expected the header of a .bullet file, \"BULLETf_v324\"");
  }
  if (bytes.size() > kMostBytes) refuse(source, kMostBytes, "larger than 2 GiB");
  const char precision = bytes[6];
  const char pointers = bytes[7];
  const char order = bytes[8];
  if (precision != 'f' && precision != 'd') {
    refuse(source, 6, "the header's precision must be f or d");
  }
  if (pointers != '_' && pointers != '-') {
    refuse(source, 7, "the header's size of pointers must be _ (32 bits) or - (64 bits)");
  }
  if (order == 'V') refuse(source, 8, "big-endian files are not supported");
  if (order != 'v') refuse(source, 8, "the header's byte order must be v or V");
  const std::string_view version = bytes.substr(9, 3);
  if (!std::ranges::all_of(version, [](unsigned char c) { return std::isdigit(c) != 0; })) {
    refuse(source, 9, "the header's version must be three digits");
  }
  pointer_bytes = pointers == '-' ? 8 : 4;
  return {.is_double = precision == 'd', .version = std::stoi(std::string(version))};
}

}  // namespace

bool is_bullet_file(std::string_view name) {
  return name.ends_with(".bullet");
}

BulletFileHeader check_bullet_chunks(std::string_view bytes, const std::string& source) {
  std::size_t pointer_bytes = 0;
  const BulletFileHeader header = check_header(bytes, source, pointer_bytes);
  const std::size_t head = 4 + 4 + pointer_bytes + 4 + 4;
  for (std::size_t place = kHeader; place < bytes.size();) {
    if (bytes.size() - place < head) refuse(source, place, "the file ends inside a chunk's head");
    const std::string_view code = bytes.substr(place, 4);
    const std::int32_t length = integer_at(bytes, place + 4);
    const std::int32_t count = integer_at(bytes, place + head - 4);
    if (length < 0 || static_cast<std::size_t>(length) > bytes.size() - place - head) {
      refuse(source, place + 4,
             fmt::format("a chunk of {} bytes, {} are left", length, bytes.size() - place - head));
    }
    if (count < 0) refuse(source, place + head - 4, fmt::format("a chunk of {} items", count));
    place += head + static_cast<std::size_t>(length);
    if (code != "DNA1") continue;
    if (place != bytes.size()) refuse(source, place, "bytes after the last chunk, DNA1");
    return header;
  }
  refuse(source, bytes.size(), "the file ends before its description of types (chunk DNA1)");
}

}  // namespace signorini::validation
