#include <signorini/collision/compound.h>
#include <signorini/collision/compound_pairs.h>
#include <signorini/collision/hull.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace signorini::collision {
namespace {

bool is_convex_and_bounded(const Shape& shape) {
  return !std::holds_alternative<HalfSpace>(shape) &&
         !std::holds_alternative<TriangleMesh>(shape) && !std::holds_alternative<Compound>(shape);
}

void check(const CompoundPart& part) {
  if (!is_convex_and_bounded(part.shape)) {
    throw std::invalid_argument("shape: must be convex and bounded");
  }
  validate(part.shape);
  validate(part.local);
  if (const auto* hull = std::get_if<ConvexHull>(&part.shape)) {
    const HullData& data = *hull->data;
    const std::size_t features = data.vertices.size() + data.edges.size() + data.faces.size();
    if (features >= narrow::kPartFeatures) {
      throw std::invalid_argument("hull: features: must be less than 2^20, got " +
                                  std::to_string(features));
    }
  }
}

}  // namespace

Compound make_compound(std::vector<CompoundPart> parts) {
  constexpr std::size_t kMost = 4096;
  if (parts.empty() || parts.size() > kMost) {
    throw std::invalid_argument("compound: parts: must be 1 to 4096, got " +
                                std::to_string(parts.size()));
  }
  const auto data = std::make_shared<CompoundData>();
  data->parts = std::move(parts);
  std::vector<Bounds> all;
  for (std::size_t i = 0; i < data->parts.size(); ++i) {
    CompoundPart& part = data->parts[i];
    try {
      check(part);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("compound: part " + std::to_string(i) + ": " + error.what());
    }
    part.local.orientation.normalize();
    all.push_back(bounds(part.shape, part.local));
    data->radius = std::max(data->radius, bounding_radius(part.shape, part.local));
  }
  data->tree = BoundsTree(all);
  return {data};
}

}  // namespace signorini::collision
