#pragma once

#include <signorini/collision/shape.h>
#include <signorini/core/model/body.h>

#include <string>
#include <vector>

namespace signorini::bench {

/// A scene that two engines step. SI units, z up, gravity 9.81 m/s^2; body 0 is the ground, whose
/// top is z = 0.
struct SteppedScene {
  std::string name;
  Bodies bodies;
  State state;
  std::vector<collision::Collider> colliders;
  double step = 1.0 / 60.0;  ///< s
  double seconds = 1.0;      ///< how long it should stand
  int watched = 1;           ///< the body whose drift is measured: the top one
};

/// The ground is a box of this half edge: a plane of Bullet's makes one contact with a box.
inline constexpr double kGroundHalfEdge = 100.0;

/// `count` cubes of 1 m and 1 kg on each other, mu = 0.5, no restitution.
[[nodiscard]] SteppedScene stack_scene(int count, double step, double seconds);
/// Rows of rows, rows - 1, ... 1 such cubes, 1.1 m apart, each on two of the row below.
[[nodiscard]] SteppedScene pyramid_scene(int rows, double step, double seconds);
/// A cube of 1 m and `mass` kg on one of 1 kg.
[[nodiscard]] SteppedScene heavy_scene(double mass, double step, double seconds);

}  // namespace signorini::bench
