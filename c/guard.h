#pragma once

#include <signorini/c/signorini.h>

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace signorini::c {

/// Keeps the text for signorini_last_error(), cut to its room; allocates nothing.
void keep_error(const char* text) noexcept;

/// Thrown where an argument is refused.
[[noreturn]] inline void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

/// @throws std::invalid_argument if `pointer` is null
inline void require(const void* pointer, const char* name) {
  if (pointer == nullptr) {
    refuse(std::string(name) + ": is null");
  }
}

/// An array of `count` things that may be null only if it is empty.
inline void require_array(const void* pointer, std::int64_t count, const char* name) {
  if (count > 0 && pointer == nullptr) {
    refuse(std::string(name) + ": is null, expected " + std::to_string(count) + " values");
  }
}

/// A count that comes from outside. @param most the largest that is allowed
inline void require_count(std::int64_t count, std::int64_t most, const char* name) {
  if (count < 0 || count > most) {
    refuse(std::string(name) + ": must be in [0, " + std::to_string(most) + "], got " +
           std::to_string(count));
  }
}

/// Runs `body`, the inside of one function of the API: whatever it throws becomes a code and a
/// text.
template <typename Body>
signorini_error guard(Body body) noexcept {
  try {
    body();
    return SIGNORINI_OK;
  } catch (const std::invalid_argument& error) {
    keep_error(error.what());
    return SIGNORINI_INVALID_ARGUMENT;
  } catch (const std::bad_alloc&) {
    keep_error("out of memory");
    return SIGNORINI_OUT_OF_MEMORY;
  } catch (const std::length_error&) {
    keep_error("out of memory: a size that cannot be allocated");
    return SIGNORINI_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    keep_error(error.what());
    return SIGNORINI_INTERNAL_ERROR;
  } catch (...) {
    keep_error("an exception of unknown type");
    return SIGNORINI_INTERNAL_ERROR;
  }
}

/// `number` if `items` has such a place. @throws std::invalid_argument if not
template <typename Items>
std::int64_t checked_place(const Items& items, std::int64_t number, const char* name) {
  const auto count = static_cast<std::int64_t>(items.size());
  if (number < 0 || number >= count) {
    refuse(std::string(name) + ": must be in [0, " + std::to_string(count) + "), got " +
           std::to_string(number));
  }
  return number;
}

/// Writes as much of `full` as the caller's struct has room for.
template <typename Struct>
void copy_out(const Struct& full, Struct* out, size_t bytes) {
  require(out, "the struct to fill");
  if (bytes < sizeof(double) || bytes % sizeof(double) != 0) {
    refuse("bytes: must be the sizeof of the struct, got " + std::to_string(bytes));
  }
  std::memcpy(out, &full, bytes < sizeof full ? bytes : sizeof full);
}

}  // namespace signorini::c
