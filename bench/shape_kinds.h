#pragma once

#include "tests/collision/random_pairs.h"

#include <array>
#include <string>
#include <vector>

namespace signorini::bench {

struct NamedShapeKind {
  collision::testing::ShapeKind kind;
  const char* name;
};

/// The convex shapes that a study draws, and the half-space.
inline constexpr std::array<NamedShapeKind, 8> kShapeKinds{{
    {collision::testing::ShapeKind::kSphere, "sphere"},
    {collision::testing::ShapeKind::kBox, "box"},
    {collision::testing::ShapeKind::kCapsule, "capsule"},
    {collision::testing::ShapeKind::kCylinder, "cylinder"},
    {collision::testing::ShapeKind::kCone, "cone"},
    {collision::testing::ShapeKind::kEllipsoid, "ellipsoid"},
    {collision::testing::ShapeKind::kHull, "hull"},
    {collision::testing::ShapeKind::kHalfSpace, "half-space"},
}};

struct KindPair {
  NamedShapeKind a;
  NamedShapeKind b;
  [[nodiscard]] std::string name() const { return std::string(a.name) + "-" + b.name; }
};

/// Every pair of them, each once, but for two half-spaces.
[[nodiscard]] inline std::vector<KindPair> shape_pairs() {
  std::vector<KindPair> result;
  for (std::size_t i = 0; i + 1 < kShapeKinds.size(); ++i) {
    for (std::size_t j = i; j < kShapeKinds.size(); ++j) {
      result.push_back({kShapeKinds[i], kShapeKinds[j]});
    }
  }
  return result;
}

/// Sphere, box and half-space meet each other in closed forms (two boxes: with a preference for
/// faces); the other pairs by a search.
[[nodiscard]] inline bool has_closed_form(const collision::Shape& shape) {
  return std::holds_alternative<collision::Sphere>(shape) ||
         std::holds_alternative<collision::Box>(shape) ||
         std::holds_alternative<collision::HalfSpace>(shape);
}

}  // namespace signorini::bench
