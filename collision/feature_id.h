#pragma once

#include <cstdint>

namespace signorini::collision {

/// A feature (face, edge, vertex) of a shape, numbered by the shape: see box_geometry.h. Shapes
/// with one surface (sphere, half-space) have the one feature 0.
using Feature = std::uint32_t;

/// The id of a pair of features; different pairs, different ids.
[[nodiscard]] constexpr std::uint64_t feature_pair_id(Feature a, Feature b) {
  return (std::uint64_t{a} << 32) | b;
}

/// The id of the same pair with A and B exchanged.
[[nodiscard]] constexpr std::uint64_t exchanged(std::uint64_t feature_pair) {
  return (feature_pair << 32) | (feature_pair >> 32);
}

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection that spreads every bit.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// The id of a pair of features of two colliders of a scene. A hash: two of n contacts share an id
/// with probability n^2 / 2^65 (n = 10^5: 3e-10).
[[nodiscard]] constexpr std::uint64_t scene_feature_id(std::uint32_t collider_a,
                                                       std::uint32_t collider_b,
                                                       std::uint64_t feature_pair) {
  return mix(mix(feature_pair_id(collider_a, collider_b)) + 0x9e3779b97f4a7c15ULL + feature_pair);
}

}  // namespace signorini::collision
