#include "bench/masonry_scenes.h"

#include <signorini/collision/hull.h>

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

namespace signorini::bench {
namespace {

constexpr double kDensity = 1000.0;  // kg/m^3
constexpr double kHalfDepth = 0.3;   // m, along y
constexpr double kMargin = 0.004;    // m, of our stepper
constexpr double kCardHeight = 1.0;  // m, of a leaning card
constexpr double kThickness = 0.04;  // m
constexpr double kBetween = 0.01;    // m, between neighbours of a floor
constexpr double kInner = 1.0;       // m, radii of the arch
constexpr double kOuter = 1.3;

using Outline = std::vector<Eigen::Vector2d>;  // x and z, counter-clockwise seen against y

SteppedScene masonry(const std::string& name, double friction, double step, double seconds) {
  SteppedScene scene;
  scene.name = fmt::format("{}, 1/{:.0f} s", name, 1.0 / step);
  scene.step = step;
  scene.seconds = seconds;
  scene.margin = kMargin;
  add_box(Vec3::Constant(kGroundHalfEdge), 1.0, Vec3(0.0, 0.0, -kGroundHalfEdge),
          {.friction = friction}, scene);
  return scene;
}

collision::MassProperties solid(const Outline& outline) {
  return mass_properties(collision::make_prism(outline, -kHalfDepth, kHalfDepth), kDensity);
}

/// A body with this outline, moved by (x, z); its axes are the principal ones. @return its number
int add_stone(Outline outline, double x, double z, double friction, SteppedScene& scene) {
  const collision::MassProperties given = solid(outline);
  const Eigen::Vector2d centre = given.centre.head<2>();
  const Mat3& J = given.inertia;
  const Eigen::Rotation2Dd turn(0.5 * std::atan2(2.0 * J(0, 1), J(0, 0) - J(1, 1)));
  for (Eigen::Vector2d& corner : outline) {
    corner = turn.inverse() * (corner - centre);
  }
  add_body(collision::make_prism(outline, -kHalfDepth, kHalfDepth), given.mass,
           solid(outline).inertia.diagonal().asDiagonal(),
           Vec3(x + centre.x(), 0.0, z + centre.y()), {.friction = friction}, scene);
  const Quat upright(std::numbers::sqrt2 / 2.0, std::numbers::sqrt2 / 2.0, 0.0, 0.0);
  scene.state.back().q = upright * Eigen::AngleAxisd(turn.angle(), Vec3::UnitZ());
  return static_cast<int>(scene.bodies.size()) - 1;
}

Outline mirrored(const Outline& outline) {
  Outline other;
  for (auto corner = outline.rbegin(); corner != outline.rend(); ++corner) {
    other.emplace_back(-corner->x(), corner->y());
  }
  return other;
}

}  // namespace

SteppedScene card_house_scene(int floors, double friction, double step, double seconds) {
  const double lean = std::numbers::pi / 9.0;
  const double across = kThickness / std::cos(lean);  // of a card, level
  const double top = 0.5 * across;                    // half of the flat top of a pair
  const double reach = top + kCardHeight * std::tan(lean);
  const double cut = kCardHeight - (across - top) / std::tan(lean);
  const Outline left{
      {-reach, 0.0}, {across - reach, 0.0}, {0.0, cut}, {0.0, kCardHeight}, {-top, kCardHeight}};
  const Outline right = mirrored(left);
  const double spacing = 2.0 * reach + kBetween;
  const double half = 0.5 * (spacing - kBetween);
  const Outline lying{{-half, 0.0}, {half, 0.0}, {half, kThickness}, {-half, kThickness}};

  SteppedScene scene =
      masonry(fmt::format("card house of {} floors", floors), friction, step, seconds);
  for (int floor = 0; floor < floors; ++floor) {
    const double z = floor * (kCardHeight + kThickness);
    const int pairs = floors - floor;
    for (int i = 0; i < pairs; ++i) {
      const double x = spacing * (i - 0.5 * (pairs - 1));
      add_stone(left, x, z, friction, scene);
      scene.watched = add_stone(right, x, z, friction, scene);
    }
    for (int i = 0; i + 1 < pairs; ++i) {
      add_stone(lying, spacing * (i - 0.5 * (pairs - 2)), z + kCardHeight, friction, scene);
    }
  }
  return scene;
}

SteppedScene arch_scene(int stones, double friction, double step, double seconds) {
  SteppedScene scene = masonry(fmt::format("arch of {} stones", stones), friction, step, seconds);
  const auto corner = [](double radius, double angle) {
    return Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle));
  };
  for (int i = 0; i < stones; ++i) {
    const double from = std::numbers::pi * i / stones;
    const double to = std::numbers::pi * (i + 1) / stones;
    const int stone = add_stone(
        {corner(kInner, from), corner(kOuter, from), corner(kOuter, to), corner(kInner, to)}, 0.0,
        0.0, friction, scene);
    if (2 * i + 1 == stones || (stones % 2 == 0 && 2 * i == stones)) {
      scene.watched = stone;
    }
  }
  return scene;
}

}  // namespace signorini::bench
