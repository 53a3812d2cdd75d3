#pragma once

#include <signorini/collision/shape.h>
#include <signorini/core/model/body.h>

#include <functional>
#include <string>
#include <vector>

namespace signorini::bench {

/// What an engine says of a scene at one time.
struct Moment {
  State poses;  ///< momenta are left out
  std::vector<Velocity> velocities;
};
/// A run: the start and every step.
using Course = std::vector<Moment>;

/// A scene that two engines step. SI units, z up; body 0 is the ground, whose top is z = 0.
struct SteppedScene {
  std::string name;
  Bodies bodies;
  State state;
  std::vector<collision::Collider> colliders;
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);  ///< m/s^2
  double margin = 0.01;      ///< of our stepper, m; its touching tolerance is 1e-4 of it
  double step = 1.0 / 60.0;  ///< s
  double seconds = 1.0;      ///< how long it should stand
  int watched = 1;           ///< the body whose drift is measured: the top one
  /// Where the watched body should be, from its start, after so many seconds; m. Empty: there.
  std::function<Vec3(double time)> path = {};
  /// What a whole run errs by, where that is not the drift of the watched body. Such a scene is as
  /// long as its error needs, and one for the event-driven stepper too.
  std::function<double(const Course& course)> error = {};
  std::string error_name = "drift m";
};

/// The ground is a box of this half edge: a plane of Bullet's makes one contact with a box.
inline constexpr double kGroundHalfEdge = 100.0;

/// Adds a body with one collider, at rest; the first one is the ground: fixed.
void add_body(const collision::Shape& shape, double mass, const Mat3& inertia, const Vec3& position,
              const Material& material, SteppedScene& scene);
/// The same of a solid box, whose inertia follows.
void add_box(const Vec3& half, double mass, const Vec3& position, const Material& material,
             SteppedScene& scene);

/// `count` cubes of 1 m and 1 kg on each other, mu = 0.5, no restitution.
[[nodiscard]] SteppedScene stack_scene(int count, double step, double seconds);
/// Rows of rows, rows - 1, ... 1 such cubes, 1.1 m apart, each on two of the row below.
[[nodiscard]] SteppedScene pyramid_scene(int rows, double step, double seconds);
/// A cube of 1 m and `mass` kg on one of 1 kg.
[[nodiscard]] SteppedScene heavy_scene(double mass, double step, double seconds);
/// A slab of 1 m on a slope (gravity is tilted), mu = 0.5: it stays where tan_angle <= mu, else
/// x = a t (t + h) / 2 with a = g (sin - mu cos): the scheme's path (velocity, then position).
[[nodiscard]] SteppedScene slope_scene(double tan_angle, double step, double seconds);
/// A ball of 1 m pushed over the ground at 5 m/s without spin, mu = 0.5: it slides, and rolls from
/// t = 2 v / (7 mu g) on at 5/7 v; the closed form, which a step meets to first order.
[[nodiscard]] SteppedScene rolling_scene(double step, double seconds);

}  // namespace signorini::bench
