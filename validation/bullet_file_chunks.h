#pragma once

#include <string>
#include <string_view>

namespace signorini::validation {

/// Does the name end in .bullet?
[[nodiscard]] bool is_bullet_file(std::string_view name);

/// What a .bullet file says before Bullet's loader sees it.
struct BulletFileHeader {
  bool is_double = false;
  int version = 0;  ///< of Bullet, 324 is 3.24
};

/// Walks the file without interpreting it: a header "BULLETf_v324" (f or d: precision; _ or -:
/// pointers of 32 or 64 bits; v: little endian; the version), then chunks of a code, a length, an
/// old pointer, a type and a count, each length inside the file, and the last of them DNA1, the
/// description of the types, which ends it. A file that was cut anywhere does not pass.
/// @throws InputError naming the source, the byte and what is wrong
BulletFileHeader check_bullet_chunks(std::string_view bytes, const std::string& source);

}  // namespace signorini::validation
