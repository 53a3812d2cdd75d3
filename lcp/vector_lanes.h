#pragma once

#include <cstring>

// What the kernels are written in: one source for every instruction set, templates over a vector
// type, inlined into functions that are compiled for the set (gcc and clang vector extensions).
#define SIGNORINI_INLINE [[gnu::always_inline]] inline
#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are returned by inlined functions only

namespace signorini::lcp::vector_lanes {

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));
using Eight = double __attribute__((vector_size(64)));

template <typename V>
constexpr int kLanes = static_cast<int>(sizeof(V) / sizeof(double));

// Data are aligned like a double. (An alignment in V's own attributes would not reach a template.)
template <typename V>
SIGNORINI_INLINE V load(const double* from) {
  V value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <typename V>
SIGNORINI_INLINE void store(const V& value, double* to) {
  std::memcpy(to, &value, sizeof value);
}

}  // namespace signorini::lcp::vector_lanes
