#include "bench/extreme_scenes.h"

#include <signorini/collision/hull.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace signorini::bench {
namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr double kStep = 1.0 / 60.0;

/// Cubes (or prisms) on each other on a ground that may slope, or falling on it as one.
struct Pile {
  double edge = 1.0;  // m; 1 kg at 1 m
  int count = 2;
  std::function<double(int)> relative_mass = {};  // of body i, from the bottom
  double slope = 0.0;                             // tangent of the angle
  double friction = 0.5;
  double restitution = 0.0;
  double falling = 0.0;  // m/s at the start, touching if restitution > 0, else half a step before
  double step = kStep;
  double away = 0.0;           // of the origin, along each axis, m
  double inertia_ratio = 1.0;  // largest over smallest moment
  int sides = 0;               // of the prism; 0: a cube
  int steps = 10;
};

/// Upright, as high as wide, about the origin.
collision::ConvexHull prism(int sides, double edge) {
  std::vector<Eigen::Vector2d> corners;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / sides;
    corners.emplace_back(0.5 * edge * std::cos(angle), 0.5 * edge * std::sin(angle));
  }
  return collision::make_prism(corners, -0.5 * edge, 0.5 * edge);
}

Mat3 moments(double mass, double edge, double ratio) {
  const double largest = mass * edge * edge / 6.0;
  return Vec3(largest, largest, largest / ratio).asDiagonal();
}

/// Sliding or resting on the slope: v = k a h, and x by the scheme, h times the sum of v.
ExtremeScene::Motion slide(double acceleration, double step, int k) {
  const double v = k * acceleration * step;
  return {.shift = Vec3(0.5 * (k + 1) * v * step, 0.0, 0.0), .velocity = Vec3(v, 0.0, 0.0)};
}

ExtremeScene pile_scene(const Pile& pile, bool friction) {
  const Material surface{.friction = friction ? pile.friction : 0.0,
                         .restitution = pile.restitution};
  const double angle = std::atan(pile.slope);
  const double gap =
      pile.falling > 0.0 && pile.restitution == 0.0 ? 0.5 * pile.falling * pile.step : 0.0;
  const double ground = kGroundHalfEdge * pile.edge;
  ExtremeScene extreme;
  extreme.steps = pile.steps;
  SteppedScene& scene = extreme.scene;
  scene.step = pile.step;
  scene.margin = std::max(0.01 * pile.edge, 4.0 * gap);
  scene.gravity = kGravity * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  const Vec3 origin = Vec3::Constant(pile.away);
  add_box(Vec3::Constant(ground), 1.0, origin - Vec3(0.0, 0.0, ground), surface, scene);
  collision::Shape shape = collision::Box{Vec3::Constant(0.5 * pile.edge)};
  if (pile.sides > 0) {
    shape = prism(pile.sides, pile.edge);
  }
  for (int i = 0; i < pile.count; ++i) {
    const double mass = std::pow(pile.edge, 3) * (pile.relative_mass ? pile.relative_mass(i) : 1.0);
    add_body(shape, mass, moments(mass, pile.edge, pile.inertia_ratio),
             origin + Vec3(0.0, 0.0, gap + (0.5 + i) * pile.edge), surface, scene);
    set_velocity(scene.bodies.back(), {Vec3(0.0, 0.0, -pile.falling), Vec3::Zero()},
                 scene.state.back());
  }
  extreme.length = pile.edge;
  extreme.speed = std::max(pile.falling, std::sqrt(kGravity * pile.edge));
  extreme.impulse = std::max(pile.falling, kGravity * pile.step);
  const double pull = kGravity * (std::sin(angle) - surface.friction * std::cos(angle));
  const double acceleration = std::max(0.0, pull);
  extreme.motion = [=](int k) {
    ExtremeScene::Motion motion = slide(acceleration, pile.step, k);
    if (pile.restitution > 0.0) {
      motion.velocity.z() = pile.restitution * pile.falling;
      motion.shift.z() = pile.step * motion.velocity.z();
    } else if (gap > 0.0) {
      motion.velocity.z() = k == 1 ? -gap / pile.step : 0.0;
      motion.shift.z() = -gap;
    }
    return motion;
  };
  return extreme;
}

/// A ball of 1 kg in a groove between two planes, whose normals are this far from the vertical, and
/// a heavier one on it.
ExtremeScene groove_scene(double tilt, double mass_ratio, bool friction) {
  constexpr double kRadius = 0.5;
  const Material surface{.friction = friction ? 0.5 : 0.0};
  ExtremeScene extreme;
  SteppedScene& scene = extreme.scene;
  scene.step = kStep;
  for (const double sign : {1.0, -1.0}) {
    const Quat turn(Eigen::AngleAxisd(sign * tilt, Vec3::UnitY()));
    add_box(Vec3::Constant(kGroundHalfEdge), 1.0, turn * Vec3(0.0, 0.0, -kGroundHalfEdge), surface,
            scene);
    scene.bodies.back().kind = BodyKind::kFixed;
    scene.state.back().q = turn;
  }
  double height = kRadius / std::cos(tilt);
  for (const double mass : {1.0, mass_ratio}) {
    add_body(collision::Sphere{kRadius}, mass, 0.4 * mass * kRadius * kRadius * Mat3::Identity(),
             Vec3(0.0, 0.0, height), surface, scene);
    height += 2.0 * kRadius;
  }
  extreme.speed = std::sqrt(kGravity * extreme.length);
  extreme.impulse = kGravity * kStep;
  extreme.motion = [](int) { return ExtremeScene::Motion{}; };
  return extreme;
}

/// The cells of one axis.
class Axis {
 public:
  Axis(std::string name, std::vector<ExtremeCell>& cells) : name_(std::move(name)), cells_(cells) {}

  /// @param change makes the pile of a value; one with the heavy body on top for each mass ratio
  void piles(const std::vector<double>& values,
             const std::function<void(double value, Pile& pile)>& change,
             bool takes_no_friction = true) {
    for (const double value : values) {
      for (const double ratio : {1.0, 1e4, 1e9}) {
        Pile pile;
        change(value, pile);
        pile.relative_mass = [top = pile.count - 1, ratio](int i) {
          return i == top ? ratio : 1.0;
        };
        add(value, pile.count > 1 ? ratio : 1.0, takes_no_friction,
            [pile](bool friction) { return pile_scene(pile, friction); });
      }
    }
  }
  void mass_ratios(int count, const std::function<bool(int i)>& is_heavy) {
    for (const double ratio : {1.0, 1e2, 1e4, 1e6, 1e9, 1e12}) {
      Pile pile{.count = count};
      pile.relative_mass = [=](int i) { return is_heavy(i) ? ratio : 1.0; };
      add(ratio, ratio, true, [pile](bool friction) { return pile_scene(pile, friction); });
    }
  }
  void add(double value, double ratio, bool takes_no_friction,
           std::function<ExtremeScene(bool)> make) {
    cells_.push_back({.axis = name_,
                      .value = value,
                      .mass_ratio = ratio,
                      .takes_no_friction = takes_no_friction,
                      .make = std::move(make)});
  }

 private:
  std::string name_;
  std::vector<ExtremeCell>& cells_;
};

}  // namespace

double scene_error(const ExtremeScene& extreme, int k, const State& poses,
                   const std::vector<Velocity>& velocities) {
  const ExtremeScene::Motion wanted = extreme.motion(k);
  double worst = 0.0;
  Vec3 momentum = Vec3::Zero();  // too much, of the bodies from i up
  double mass = 0.0;
  for (std::size_t i = poses.size(); i-- > 0;) {
    const Body& body = extreme.scene.bodies[i];
    if (!body.is_dynamic()) {
      continue;
    }
    const BodyState& start = extreme.scene.state[i];
    const Vec3 too_fast = velocities[i].linear - wanted.velocity;
    momentum += body.mass * too_fast;
    mass += body.mass;
    for (const double error : {(poses[i].x - start.x - wanted.shift).norm() / extreme.length,
                               poses[i].q.angularDistance(start.q), too_fast.norm() / extreme.speed,
                               velocities[i].angular.norm() * extreme.length / extreme.speed,
                               momentum.norm() / (mass * extreme.impulse)}) {
      worst = error <= worst ? worst : error;  // NaN stays
    }
  }
  return worst;
}

std::vector<ExtremeCell> extreme_cells() {
  std::vector<ExtremeCell> cells;
  Axis("mass ratio, heavy on light", cells).mass_ratios(2, [](int i) { return i == 1; });
  Axis("mass ratio, light on heavy", cells).mass_ratios(2, [](int i) { return i == 0; });
  Axis("mass ratio, tower of 10, every other one heavy", cells).mass_ratios(10, [](int i) {
    return i % 2 == 1;
  });
  Axis("size, m", cells)
      .piles({1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6},
             [](double value, Pile& pile) { pile.edge = value; });
  Axis("time step, s, sliding", cells)
      .piles({1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}, [](double value, Pile& pile) {
        pile.step = value;
        pile.slope = 0.2;
        pile.friction = 0.1;
      });
  Axis("landing at, m/s", cells).piles({1.0, 1e2, 1e4, 1e6}, [](double value, Pile& pile) {
    pile.falling = value;
  });
  Axis("restitution, landing at 3 m/s", cells)
      .piles({0.0, 0.1, 0.5, 0.9, 0.999, 1.0}, [](double value, Pile& pile) {
        pile.restitution = value;
        pile.falling = 3.0;
        pile.steps = value > 0.0 ? 1 : pile.steps;
      });
  Axis("friction, on a slope of 0.2", cells)
      .piles(
          {0.0, 1e-6, 1e-3, 0.1, 0.5, 1.0, 10.0, 1e3},
          [](double value, Pile& pile) {
            pile.slope = 0.2;
            pile.friction = value;
          },
          false);
  Axis("stack height", cells).piles({1, 3, 10, 30, 100, 300}, [](double value, Pile& pile) {
    pile.count = static_cast<int>(value);
  });
  Axis("contacts a face", cells).piles({4, 20, 50, 100, 200}, [](double value, Pile& pile) {
    pile.sides = static_cast<int>(value);
  });
  Axis("inertia ratio, on a slope of 0.2", cells)
      .piles({1.0, 1e2, 1e4, 1e6}, [](double value, Pile& pile) {
        pile.inertia_ratio = value;
        pile.slope = 0.2;
      });
  Axis("far from the origin, m", cells)
      .piles({0.0, 1.0, 1e3, 1e5, 1e7}, [](double value, Pile& pile) { pile.away = value; });
  Axis parallel("groove of normals at, rad", cells);
  for (const double tilt : {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0}) {
    for (const double ratio : {1.0, 1e4, 1e9}) {
      parallel.add(tilt, ratio, true,
                   [=](bool friction) { return groove_scene(tilt, ratio, friction); });
    }
  }
  return cells;
}

}  // namespace signorini::bench
