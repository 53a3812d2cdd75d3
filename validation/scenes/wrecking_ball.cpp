#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

constexpr double kStruck = 0.01;  ///< m/s, of a brick
constexpr double kBroken = 0.25;  ///< m, the way of a brick: half its thickness

/// A ball on a rod without mass about y, let go at rest at an angle a0 from the vertical:
/// w^2 = w0^2 2 (cos a - cos a0), w0^2 = m g L/J; with k = sin(a0/2), sin(a/2) = k sin(phi):
/// t(a) = (F(pi/2, k) - F(phi, k))/w0 on the way down, the first kind of elliptic integral.
struct Swing {
  double length, a0, w0;

  [[nodiscard]] double greatest_speed() const {
    return length * w0 * std::sqrt(2.0 * (1.0 - std::cos(a0)));
  }
  /// When it has passed the lowest point by the angle `beyond`, s.
  [[nodiscard]] double time_at(double beyond) const {
    const double k = std::sin(0.5 * a0);
    return (std::comp_ellint_1(k) + std::ellint_1(k, std::asin(std::sin(0.5 * beyond) / k))) / w0;
  }
};

}  // namespace

/// Closed forms of the swing until the blow; afterwards energy and joints.
void check_wrecking_ball(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const int ball = scene.body("crane");
  const Body& body = scene.bodies[ball];
  const Vec3 pivot = anchor_a(scene.joints.front(), scene.state);
  const Vec3 rod = scene.state[ball].x - pivot;
  const double length = rod.norm();
  const double J = body.inertia(1, 1) + body.mass * length * length;
  const Swing swing{.length = length,
                    .a0 = std::atan2(std::abs(rod.x()), -rod.z()),
                    .w0 = std::sqrt(body.mass * scene.gravity.norm() * length / J)};
  // The face of the wall that the ball meets, and the ball's way beyond its lowest point.
  double wall = std::numeric_limits<double>::infinity();
  double radius = 0.0;
  for (const collision::Collider& collider : scene.colliders) {
    if (collider.body == ball) radius = std::get<collision::Sphere>(collider.shape).radius;
    const auto* brick = std::get_if<collision::Box>(&collider.shape);
    if (brick == nullptr) continue;
    wall = std::min(wall, scene.state[collider.body].x.x() - brick->half_extents.x());
  }
  const double blow = swing.time_at(std::asin((wall - radius - pivot.x()) / length));

  const Runs runs = run_engines(scene, options, report);
  runs.for_each([&](const Track& track) {
    const bool ours = track.engine == "signorini";
    double speed = 0.0;
    double struck = std::nan("");
    int broken = 0;
    for (std::size_t k = 0; k < track.size(); ++k) {
      if (track.time[k] <= blow) {
        speed = std::max(speed, track.bodies[k][ball].velocity.linear.norm());
      }
      for (std::size_t i = 0; std::isnan(struck) && i < scene.bodies.size(); ++i) {
        const bool moves = track.bodies[k][i].velocity.linear.norm() > kStruck;
        if (static_cast<int>(i) != ball && moves) struck = track.time[k];
      }
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Vec3 way = track.bodies.back()[i].pose.position - scene.state[i].x;
      broken += static_cast<int>(i) != ball && way.norm() > kBroken ? 1 : 0;
    }
    const CheckText fast{.name = "speed of the ball before the blow",
                         .engine = track.engine,
                         .unit = "m/s",
                         .reason = "of first order in the step: w0 h"};
    const CheckText when{.name = "time of the blow",
                         .engine = track.engine,
                         .unit = "s",
                         .reason =
                             "the swing's time is of first order, w0 h of it, and a record and a "
                             "step beside it"};
    const CheckText wrecked{.name = "bricks out of their place at the end",
                            .engine = track.engine,
                            .reference = "none",
                            .unit = "1",
                            .reason = "chaos: shown, not judged"};
    const double wh = swing.w0 * track.step;
    report.checks.push_back(ours ? relative(fast, speed, swing.greatest_speed(), wh)
                                 : shown(fast, speed, swing.greatest_speed()));
    report.checks.push_back(ours ? absolute(when, struck, blow, wh * blow + 2.0 * track.step)
                                 : shown(when, struck, blow));
    report.checks.push_back(shown(wrecked, broken, 0.0));
  });
  add_joint_check(scene, runs, report);
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  report.plots.push_back(plot_over_time("Speed of the ball", "|v| [m/s]", runs,
                                        [ball](const Track& track, std::size_t k) {
                                          return track.bodies[k][ball].velocity.linear.norm();
                                        }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
