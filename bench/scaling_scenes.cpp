#include "bench/scaling_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <random>
#include <stdexcept>

namespace signorini::bench {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"stacks", "pyramid", "pile"};
constexpr Material kSurface{.friction = 0.5, .restitution = 0.0};
constexpr double kStep = 1.0 / 60.0;

/// A ground that reaches so far from the middle.
SteppedScene ground(std::string_view name, double reach) {
  SteppedScene scene;
  scene.name = name;
  scene.step = kStep;
  const Vec3 half(reach + 10.0, reach + 10.0, 10.0);
  add_box(half, 1.0, Vec3(0.0, 0.0, -half.z()), kSurface, scene);
  return scene;
}

/// Place k of `count` in a row with this spacing, the middle at 0.
double in_row(int k, int count, double spacing) {
  return spacing * (k - 0.5 * (count - 1));
}

SteppedScene stacks(int bodies) {
  constexpr int kHeight = 10;
  constexpr double kSpacing = 1.5;
  const int towers = (bodies + kHeight - 1) / kHeight;
  const int side = static_cast<int>(std::ceil(std::sqrt(towers)));
  SteppedScene scene = ground("stacks", kSpacing * side);
  for (int k = 0; k < bodies; ++k) {
    const int tower = k / kHeight;
    add_box(Vec3::Constant(0.5), 1.0,
            Vec3(in_row(tower % side, side, kSpacing), in_row(tower / side, side, kSpacing),
                 0.5 + k % kHeight),
            kSurface, scene);
  }
  return scene;
}

SteppedScene pyramid(int bodies) {
  constexpr double kSpacing = 1.1;
  const int rows =
      std::max(1, static_cast<int>(std::lround((std::sqrt(8.0 * bodies + 1.0) - 1.0) / 2.0)));
  SteppedScene scene = ground("pyramid", kSpacing * rows);
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      add_box(Vec3::Constant(0.5), 1.0, Vec3(in_row(i, rows - row, kSpacing), 0.0, 0.5 + row),
              kSurface, scene);
    }
  }
  return scene;
}

SteppedScene pile(int bodies) {
  constexpr int kLayers = 5;
  constexpr double kSpacing = 1.06;
  constexpr double kShift = 0.03;
  constexpr double kLayer = 1.02;
  const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(bodies / double{kLayers}))));
  SteppedScene scene = ground("pile", kSpacing * side);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int k = 0; k < bodies; ++k) {
    const int cell = k % (side * side);
    const double radius = 0.475 + 0.025 * u(random);
    const Vec3 shift{u(random), u(random), 0.0};  // braces: drawn in this order
    const Vec3 turn{u(random), u(random), u(random)};
    const int layer = k / (side * side);
    const Vec3 position =
        Vec3(in_row(cell % side, side, kSpacing), in_row(cell / side, side, kSpacing), 0.5) +
        kShift * shift + Vec3(0.0, 0.0, kLayer * layer);
    if (k % 2 == 0) {
      add_body(collision::Sphere{radius}, 1.0, 0.4 * radius * radius * Mat3::Identity(), position,
               kSurface, scene);
    } else {
      add_box(Vec3::Constant(radius / std::sqrt(3.0)), 1.0, position, kSurface, scene);
      scene.state.back().q = Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    }
    // Downwards, and a little together.
    scene.state.back().p = Vec3{0.2 * u(random), 0.2 * u(random), -1.0};
  }
  return scene;
}

}  // namespace

std::span<const std::string_view> scaling_scene_names() {
  return kNames;
}

ScalingScene make_scaling_scene(std::string_view name, int bodies) {
  if (bodies < 1) {
    throw std::invalid_argument(fmt::format("bodies: must be at least 1, got {}", bodies));
  }
  if (name == "stacks") return {stacks(bodies), true};
  if (name == "pyramid") return {pyramid(bodies), true};
  if (name == "pile") return {pile(bodies), false};
  throw std::invalid_argument(fmt::format("scene: must be of stacks, pyramid, pile, got {}", name));
}

}  // namespace signorini::bench
