#pragma once

#include <signorini/collision/feature_id.h>
#include <signorini/collision/shape.h>

#include <array>

namespace signorini::collision {

/// Which feature of a box: on each of its axes the low side (-1), the high side (+1), or neither
/// (0). One axis set: a face. Two: an edge. Three: a vertex.
using BoxSides = std::array<int, 3>;

/// The number of a feature of a box in [0, 26], 13 being the inside.
[[nodiscard]] constexpr Feature box_feature(const BoxSides& sides) {
  return static_cast<Feature>(9 * (sides[0] + 1) + 3 * (sides[1] + 1) + (sides[2] + 1));
}

/// A box in the frame of a query.
struct PlacedBox {
  Vec3 centre;
  Mat3 axes;  ///< columns: the unit axes
  Vec3 half;  ///< half extents, m

  PlacedBox(const Box& box, const Pose& pose)
      : centre(pose.position), axes(pose.orientation.toRotationMatrix()), half(box.half_extents) {}

  [[nodiscard]] Vec3 to_local(const Vec3& point) const {
    return axes.transpose() * (point - centre);
  }
  [[nodiscard]] Vec3 to_world(const Vec3& local) const { return centre + axes * local; }
  /// The corner, edge midpoint or face centre.
  [[nodiscard]] Vec3 at(const BoxSides& sides) const {
    return to_world(half.cwiseProduct(Vec3(sides[0], sides[1], sides[2])));
  }
  /// max n.(x - centre) over the box.
  [[nodiscard]] double support(const Vec3& n) const {
    return (axes.transpose() * n).cwiseAbs().dot(half);
  }
};

/// The face of a box whose outward normal is nearest to -n.
struct BoxFace {
  int axis;
  int sign;

  [[nodiscard]] BoxSides sides() const {
    BoxSides result{0, 0, 0};
    result[axis] = sign;
    return result;
  }
};

/// Of faces that face -n equally to 1e-6 the one of the lowest axis, so that rounding does not
/// choose.
[[nodiscard]] inline BoxFace face_against(const PlacedBox& box, const Vec3& n) {
  constexpr double kTie = 1e-6;
  const Vec3 along = box.axes.transpose() * n;
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(along[k]) > std::abs(along[axis]) + kTie) {
      axis = k;
    }
  }
  return {axis, along[axis] > 0.0 ? -1 : 1};
}

/// The corners of a face in order around it.
[[nodiscard]] inline std::array<BoxSides, 4> face_corners(const BoxFace& face) {
  std::array<BoxSides, 4> corners;
  constexpr int kAround[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int k = 0; k < 4; ++k) {
    corners[k][face.axis] = face.sign;
    corners[k][(face.axis + 1) % 3] = kAround[k][0];
    corners[k][(face.axis + 2) % 3] = kAround[k][1];
  }
  return corners;
}

}  // namespace signorini::collision
