#include "bench/stack_scenes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace signorini::bench {
namespace {

constexpr Material kSurface{.friction = 0.5, .restitution = 0.0};

SteppedScene ground(const std::string& name, double step, double seconds) {
  SteppedScene scene;
  scene.name = name;
  scene.step = step;
  scene.seconds = seconds;
  add_box(Vec3::Constant(kGroundHalfEdge), 1.0, Vec3(0.0, 0.0, -kGroundHalfEdge), kSurface, scene);
  return scene;
}

void add_cube(double mass, const Vec3& position, SteppedScene& scene) {
  add_box(Vec3::Constant(0.5), mass, position, kSurface, scene);
  scene.watched = static_cast<int>(scene.bodies.size()) - 1;
}

std::string step_text(double step) {
  return fmt::format("1/{:.0f} s", 1.0 / step);
}

}  // namespace

void add_body(const collision::Shape& shape, double mass, const Mat3& inertia, const Vec3& position,
              const Material& material, SteppedScene& scene) {
  const int index = static_cast<int>(scene.bodies.size());
  Body body;
  body.kind = index == 0 ? BodyKind::kFixed : BodyKind::kDynamic;
  body.mass = mass;
  body.inertia = inertia;
  body.name = index == 0 ? "ground" : fmt::format("body {}", index);
  BodyState state;
  state.x = position;
  scene.colliders.push_back(
      {.body = index, .shape = shape, .local = {}, .material = material, .name = body.name});
  scene.bodies.push_back(std::move(body));
  scene.state.push_back(state);
}

void add_box(const Vec3& half, double mass, const Vec3& position, const Material& material,
             SteppedScene& scene) {
  const Vec3 square = half.cwiseProduct(half);
  const Vec3 moments = mass / 3.0 * (Vec3::Constant(square.sum()) - square);
  add_body(collision::Box{half}, mass, moments.asDiagonal(), position, material, scene);
}

SteppedScene stack_scene(int count, double step, double seconds) {
  SteppedScene scene =
      ground(fmt::format("stack of {}, {}", count, step_text(step)), step, seconds);
  for (int i = 0; i < count; ++i) {
    add_cube(1.0, Vec3(0.0, 0.0, 0.5 + i), scene);
  }
  return scene;
}

SteppedScene pyramid_scene(int rows, double step, double seconds) {
  constexpr double kSpacing = 1.1;
  SteppedScene scene =
      ground(fmt::format("pyramid of {} rows, {}", rows, step_text(step)), step, seconds);
  for (int row = 0; row < rows; ++row) {
    const int count = rows - row;
    for (int i = 0; i < count; ++i) {
      add_cube(1.0, Vec3(kSpacing * (i - 0.5 * (count - 1)), 0.0, 0.5 + row), scene);
    }
  }
  return scene;
}

SteppedScene heavy_scene(double mass, double step, double seconds) {
  SteppedScene scene =
      ground(fmt::format("1 kg under {:.0e} kg, {}", mass, step_text(step)), step, seconds);
  add_cube(1.0, Vec3(0.0, 0.0, 0.5), scene);
  add_cube(mass, Vec3(0.0, 0.0, 1.5), scene);
  return scene;
}

SteppedScene slope_scene(double tan_angle, double step, double seconds) {
  SteppedScene scene =
      ground(fmt::format("slope of tan {:g}, {}", tan_angle, step_text(step)), step, seconds);
  add_box(Vec3(0.5, 0.5, 0.1), 1.0, Vec3(0.0, 0.0, 0.1), kSurface, scene);
  const double g = scene.gravity.norm();
  const double angle = std::atan(tan_angle);
  scene.gravity = g * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  const double pull = g * (std::sin(angle) - kSurface.friction * std::cos(angle));
  scene.path = [a = std::max(pull, 0.0), step](double t) {
    return Vec3(0.5 * a * t * (t + step), 0.0, 0.0);
  };
  return scene;
}

SteppedScene rolling_scene(double step, double seconds) {
  constexpr double kRadius = 0.5;
  constexpr double kSpeed = 5.0;  // m/s
  SteppedScene scene = ground("sliding ball that rolls, " + step_text(step), step, seconds);
  add_body(collision::Sphere{kRadius}, 1.0, 0.4 * kRadius * kRadius * Mat3::Identity(),
           Vec3(0.0, 0.0, kRadius), kSurface, scene);
  scene.state.back().p = Vec3(kSpeed, 0.0, 0.0);
  const double brake = kSurface.friction * scene.gravity.norm();
  const double rolls = 2.0 * kSpeed / (7.0 * brake);  // s
  scene.path = [=](double t) {
    const double slid = std::min(t, rolls);
    return Vec3(kSpeed * slid - 0.5 * brake * slid * slid + 5.0 / 7.0 * kSpeed * (t - slid), 0.0,
                0.0);
  };
  return scene;
}

}  // namespace signorini::bench
