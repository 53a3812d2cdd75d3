#include <signorini/core/response/position_projection.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace signorini::validation {
namespace {

constexpr int kMostPlottedBodies = 3;

double energy_rise(const Track& track) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < track.size(); ++k) most = std::max(most, track.energy(k));
  return most - track.energy(0);
}

/// How far the points of a body's shapes reach from its centre of mass, m.
double reach(const Scene& scene, int body) {
  double most = 0.0;
  for (const collision::Collider& collider : scene.colliders) {
    if (collider.body != body) continue;
    most = std::max(most, collision::bounding_radius(collider.shape, collider.local));
  }
  return most;
}

bool nothing_in_the_way(const Scene& scene) {
  if (!scene.joints.empty()) return false;
  std::vector<int> bodies;
  for (const collision::Collider& collider : scene.colliders) bodies.push_back(collider.body);
  std::sort(bodies.begin(), bodies.end());
  return std::unique(bodies.begin(), bodies.end()) - bodies.begin() <= 1;
}

void check_free_fall(const Scene& scene, const Runs& runs, SceneReport& report) {
  runs.for_each([&](const Track& track) {
    const double h = track.step;
    double worst = 0.0;
    double size = 0.0;
    for (std::size_t k = 0; k < track.size(); ++k) {
      const double t = track.time[k];
      for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].is_dynamic()) continue;
        const Vec3 g = scene.bodies[i].gravity_scale * scene.gravity;
        const Vec3 v0 = track.bodies[0][i].velocity.linear;
        const Vec3 exact = scene.state[i].x + t * v0 + 0.5 * t * (t + h) * g;
        worst = std::max(worst, (track.bodies[k][i].pose.position - exact).norm());
        size = std::max(size, exact.norm());
      }
    }
    const CheckText text{
        .name = "free fall: distance from x0 + v0 t + g t (t + h)/2",
        .engine = track.engine,
        .unit = "m",
        .reason =
            "nothing is in the way; the semi-implicit scheme's own closed form, and rounding "
            "of one sum a step"};
    const double rounding =
        std::numeric_limits<double>::epsilon() * static_cast<double>(track.steps) * (1.0 + size);
    report.checks.push_back(track.engine == "signorini" ? absolute(text, worst, 0.0, rounding)
                                                        : shown(text, worst, 0.0));
  });
}

void compare_with_bullet(const Scene& scene, const Runs& runs, SceneReport& report) {
  if (!runs.signorini || !runs.bullet) return;
  for (const Track* track : {&*runs.signorini, &*runs.bullet}) {
    if (track->broke_down || track->interrupted) return;
  }
  Table table;
  table.title = "Where the bodies end";
  table.header = {"body", "Signorini: position [m]", "Bullet: position [m]", "distance [m]"};
  double farthest = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].is_dynamic()) continue;
    const Vec3 a = runs.signorini->bodies.back()[i].pose.position;
    const Vec3 b = runs.bullet->bodies.back()[i].pose.position;
    farthest = std::max(farthest, (a - b).norm());
    if (table.rows.size() < 50) {
      table.rows.push_back({scene.bodies[i].name, text(a), text(b), text((a - b).norm())});
    }
  }
  report.tables.push_back(table);
  report.checks.push_back(shown({.name = "greatest distance between the engines at the end",
                                 .reference = "bullet",
                                 .unit = "m",
                                 .reason = "two schemes of first order: shown, not judged"},
                                farthest, 0.0));
}

void plot_heights(const Scene& scene, const Runs& runs, SceneReport& report) {
  int plotted = 0;
  for (std::size_t i = 0; i < scene.bodies.size() && plotted < kMostPlottedBodies; ++i) {
    if (!scene.bodies[i].is_dynamic()) continue;
    ++plotted;
    report.plots.push_back(plot_over_time(
        "Height of " + scene.bodies[i].name, "height of the centre of mass [m]", runs,
        [i](const Track& track, std::size_t k) { return track.bodies[k][i].pose.position.z(); }));
  }
}

}  // namespace

double scheme_energy_rise(const Scene& scene, const Track& track) {
  const double h = track.step;
  const double g = scene.gravity.norm();
  const Vec3 down = g > 0.0 ? (scene.gravity / g).eval() : Vec3::Zero().eval();
  double bound = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.is_dynamic()) continue;
    double change = 0.0;
    for (const std::vector<BodySample>& sample : track.bodies) {
      change = std::max(change, std::abs(down.dot(sample[i].velocity.linear -
                                                  track.bodies[0][i].velocity.linear)));
    }
    bound += 0.5 * h * g * std::abs(body.gravity_scale) * body.mass * change;
  }
  // Rounding of the energy itself, one sum a step.
  double size = 0.0;
  for (std::size_t k = 0; k < track.size(); ++k) {
    size = std::max(size, std::abs(track.kinetic[k]) + std::abs(track.potential[k]));
  }
  return bound +
         std::numeric_limits<double>::epsilon() * static_cast<double>(track.steps) * (1.0 + size);
}

double greatest_speed(const Scene& scene, const Track& track) {
  double most = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].is_dynamic()) continue;
    const double arm = reach(scene, static_cast<int>(i));
    for (const std::vector<BodySample>& sample : track.bodies) {
      most = std::max(most,
                      sample[i].velocity.linear.norm() + arm * sample[i].velocity.angular.norm());
    }
  }
  return most;
}

namespace {

/// What the solver's tolerance lets the energy rise by, J: a step's impulses f change it by
/// f.(u- + u+)/2, and where f acts u+, and u- from the step before, are 0 to tolerance |q|.
/// |q| <= h g + twice the greatest relative speed (restitution), that one twice the greatest speed.
double solver_energy_rise(const Scene& scene, const Track& track) {
  const double q = 4.0 * greatest_speed(scene, track) + track.step * scene.gravity.norm();
  return step_settings(scene).lcp.tolerance * q * track.impulse;
}

}  // namespace

void add_energy_check(const Scene& scene, const Runs& runs, SceneReport& report) {
  runs.for_each([&](const Track& track) {
    const CheckText text{
        .name = "energy above its start, at most",
        .engine = track.engine,
        .reference = "conservation law",
        .unit = "J",
        .reason =
            "contacts and friction only take energy; the semi-implicit scheme itself lets it "
            "move by (h/2) |g| m |dv| in flight, the solver by tolerance |q| times the sum of "
            "all impulses, and ending an initial overlap lifts bodies"};
    if (track.engine == "signorini") {
      report.checks.push_back(at_most(text, energy_rise(track),
                                      scheme_energy_rise(scene, track) +
                                          solver_energy_rise(scene, track) +
                                          std::max(0.0, track.projection_energy)));
    } else {
      report.checks.push_back(shown(text, energy_rise(track), 0.0));
    }
  });
}

void add_overlap_check(const Scene& scene, const Runs& runs, SceneReport& report) {
  runs.for_each([&](const Track& track) {
    const CheckText text{.name = "deepest overlap beyond the initial one",
                         .engine = track.engine,
                         .reference = "definition",
                         .unit = "m",
                         .reason =
                             "a step cannot go deeper than it moves: h times the greatest "
                             "relative speed (twice the greatest speed)"};
    const double deeper = track.deepest_overlap() - track.overlap[0];
    if (track.engine == "signorini") {
      // Gravity alone moves a resting body by g h^2 in a step.
      const double motion =
          2.0 * track.step * (greatest_speed(scene, track) + track.step * scene.gravity.norm());
      report.checks.push_back(at_most(text, deeper, motion));
    } else {
      report.checks.push_back(shown(text, deeper, 0.0));
    }
  });
}

namespace {

/// The greatest distance of the anchors of any joint, over all samples, m.
double greatest_joint_error(const Scene& scene, const Track& track) {
  double most = 0.0;
  State state = scene.state;
  for (const std::vector<BodySample>& sample : track.bodies) {
    for (std::size_t i = 0; i < state.size(); ++i) {
      state[i].x = sample[i].pose.position;
      state[i].q = sample[i].pose.orientation;
    }
    for (const Joint& joint : scene.joints) {
      const double error = joint_error(joint, state).position.norm();
      most = std::isnan(error) ? error : std::max(most, error);
    }
  }
  return most;
}

}  // namespace

void add_joint_check(const Scene& scene, const Runs& runs, SceneReport& report) {
  runs.for_each([&](const Track& track) {
    const CheckText text{.name = "greatest error of a joint",
                         .engine = track.engine,
                         .unit = "m",
                         .reason =
                             "the projection of every step closes each coordinate of a "
                             "joint to 1e-10 m"};
    const double error = greatest_joint_error(scene, track);
    report.checks.push_back(track.engine == "signorini"
                                ? absolute(text, error, 0.0, std::sqrt(3.0) * kToleratedJointError)
                                : shown(text, error, 0.0));
  });
}

namespace {

/// Of a scene that may be violent: the projection ends after its passes, closed or not.
void check_joints_of_a_step(const Scene& scene, const Runs& runs, SceneReport& report) {
  runs.for_each([&](const Track& track) {
    double opened = 0.0;  // in a step
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (!scene.bodies[i].is_dynamic()) continue;
      const double arm = reach(scene, static_cast<int>(i));
      for (const std::vector<BodySample>& sample : track.bodies) {
        const double turn = sample[i].velocity.angular.norm() * track.step;
        opened = std::max(opened, turn * turn * arm);
      }
    }
    const CheckText text{.name = "greatest error of a joint",
                         .engine = track.engine,
                         .reference = "definition",
                         .unit = "m",
                         .reason =
                             "a step opens a joint by (w h)^2 r at most, which the projection "
                             "closes to 1e-10 m or, after its last pass, leaves smaller: nothing "
                             "adds up"};
    const double error = greatest_joint_error(scene, track);
    report.checks.push_back(
        track.engine == "signorini"
            ? absolute(text, error, 0.0, opened + std::sqrt(3.0) * kToleratedJointError)
            : shown(text, error, 0.0));
  });
}

}  // namespace

void check_generic(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  if (nothing_in_the_way(scene)) check_free_fall(scene, runs, report);
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  if (!scene.joints.empty()) check_joints_of_a_step(scene, runs, report);
  compare_with_bullet(scene, runs, report);
  plot_heights(scene, runs, report);
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
