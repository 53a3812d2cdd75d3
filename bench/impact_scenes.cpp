#include "bench/impact_scenes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <random>

namespace signorini::bench {
namespace {

constexpr double kRadius = 0.5;  // m, of every ball; 1 kg
constexpr int kApexes = 3;

SteppedScene ground(const std::string& name, const Material& material, double step,
                    double seconds) {
  SteppedScene scene;
  scene.name = fmt::format("{}, 1/{:.0f} s", name, 1.0 / step);
  scene.step = step;
  scene.seconds = seconds;
  add_box(Vec3::Constant(kGroundHalfEdge), 1.0, Vec3(0.0, 0.0, -kGroundHalfEdge), material, scene);
  return scene;
}

void add_ball(const Vec3& position, const Vec3& velocity, const Material& material,
              SteppedScene& scene) {
  add_body(collision::Sphere{kRadius}, 1.0, 0.4 * kRadius * kRadius * Mat3::Identity(), position,
           material, scene);
  scene.state.back().p = velocity;
}

double greatest_spin(const Course& course) {
  double most = 0.0;
  for (const Moment& moment : course) {
    for (const Velocity& velocity : moment.velocities) {
      most = std::max(most, velocity.angular.norm());
    }
  }
  return most;
}

/// The highest points of body 1 between its bounces, m above its place at rest on the ground.
std::vector<double> apexes_of(const Course& course) {
  const auto height = [&](std::size_t k) { return course[k].poses[1].x.z() - kRadius; };
  std::vector<double> apexes;
  for (std::size_t k = 1; k + 1 < course.size(); ++k) {
    const double rise = height(k) - height(k - 1);
    const double fall = height(k) - height(k + 1);
    if (rise > 0.0 && fall >= 0.0) {  // not at the start, which is no apex
      const double bend = 0.5 * (rise + fall);
      const double off = 0.25 * (rise - fall);  // of the vertex, in steps, times bend
      apexes.push_back(height(k) + off * off / bend);
    }
  }
  return apexes;
}

double apex_error(const Course& course, double restitution) {
  const std::vector<double> apexes = apexes_of(course);
  double worst = 0.0;
  for (int n = 1; n <= kApexes; ++n) {
    const double exact = std::pow(restitution, 2 * n);
    const double apex = n <= static_cast<int>(apexes.size()) ? apexes[n - 1] : 0.0;
    worst = std::max(worst, std::abs(apex - exact) / exact);
  }
  return worst;
}

double energy_of(const Bodies& bodies, const Moment& moment) {
  State state = moment.poses;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    set_velocity(bodies[k], moment.velocities[k], state[k]);
  }
  return kinetic_energy(bodies, state);
}

}  // namespace

SteppedScene landing_scene(double restitution, double step) {
  const Material material{.friction = 0.5, .restitution = restitution};
  SteppedScene scene =
      ground(fmt::format("flat landing, e = {:g}", restitution), material, step, 2.0);
  add_box(Vec3::Constant(0.5), 1.0, Vec3(0.0, 0.0, 1.0), material, scene);
  scene.error_name = "spin rad/s";
  scene.error = greatest_spin;
  return scene;
}

SteppedScene cradle_scene(double step) {
  constexpr int kBalls = 5;
  const Material material{.friction = 0.0, .restitution = 1.0};
  SteppedScene scene = ground("touching cradle", material, step, 0.5);
  scene.gravity.setZero();
  for (int k = 0; k < kBalls; ++k) {
    add_ball(Vec3(2.0 * kRadius * k, 0.0, 5.0), Vec3(k == 0 ? 1.0 : 0.0, 0.0, 0.0), material,
             scene);
  }
  scene.error_name = "speeds off m/s";
  scene.error = [](const Course& course) {
    double worst = 0.0;
    for (int k = 1; k <= kBalls; ++k) {
      const Vec3 exact(k == kBalls ? 1.0 : 0.0, 0.0, 0.0);
      worst = std::max(worst, (course.back().velocities[k].linear - exact).norm());
    }
    return worst;
  };
  return scene;
}

SteppedScene bounce_scene(double restitution, double step) {
  constexpr double kHeight = 1.0;  // m
  const Material material{.friction = 0.5, .restitution = restitution};
  SteppedScene scene =
      ground(fmt::format("bouncing ball, e = {:g}", restitution), material, step, 0.0);
  const double fall = std::sqrt(2.0 * kHeight / scene.gravity.norm());
  double lands = fall;  // after the last apex
  for (int n = 1; n <= kApexes; ++n) {
    lands += 2.0 * fall * std::pow(restitution, n);
  }
  scene.seconds = 1.25 * lands;  // for those that bounce higher
  add_ball(Vec3(0.0, 0.0, kRadius + kHeight), Vec3::Zero(), material, scene);
  scene.error_name = "apexes off";
  scene.error = [restitution](const Course& course) { return apex_error(course, restitution); };
  return scene;
}

SteppedScene elastic_balls_scene(int edge, double step) {
  constexpr double kSpacing = 1.2;  // m
  constexpr double kInwards = 1.0;  // 1/s
  const Material material{.friction = 0.0, .restitution = 1.0};
  SteppedScene scene =
      ground(fmt::format("{} elastic balls", edge * edge * edge), material, step, 1.0);
  scene.gravity.setZero();
  std::mt19937_64 random(20261126);
  const auto number = [&] {  // in [-1, 1)
    return 2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0;
  };
  for (int i = 0; i < edge * edge * edge; ++i) {
    const int row = i / edge % edge;
    const int layer = i / (edge * edge);
    const Vec3 cell(i % edge, row, layer);
    const Vec3 off_centre = kSpacing * (cell - Vec3::Constant(0.5 * (edge - 1)));
    const double x = number();  // one after the other: the order is part of the scene
    const double y = number();
    const double z = number();
    add_ball(off_centre + Vec3(0.0, 0.0, 20.0), -kInwards * off_centre + Vec3(x, y, z), material,
             scene);
  }
  scene.error_name = "energy off";
  scene.error = [bodies = scene.bodies](const Course& course) {
    const double start = energy_of(bodies, course.front());
    double worst = 0.0;
    for (const Moment& moment : course) {
      worst = std::max(worst, std::abs(energy_of(bodies, moment) - start));
    }
    return worst / start;
  };
  return scene;
}

}  // namespace signorini::bench
