#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

constexpr int kRod = 0;

/// The lower of the rod's edges along y, on the ground.
Vec3 foot_of(const Pose& pose, const Vec3& half) {
  Vec3 lowest = pose * Vec3(-half.x(), 0.0, -half.z());
  for (const double x : {-half.x(), half.x()}) {
    const Vec3 corner = pose * Vec3(x, 0.0, -half.z());
    if (corner.z() < lowest.z()) lowest = corner;
  }
  return lowest;
}

struct Jam {
  double spin = 0.0;           ///< about y, after it, rad/s
  double energy = 0.0;         ///< after it, J
  double energy_before = 0.0;  ///< J
  Vec3 local_foot = Vec3::Zero();
};

/// The foot stops: angular momentum about it stays, w = (J w- + m (r x v-)_y)/(J + m r^2).
Jam closed_form(const Scene& scene) {
  const Body& body = scene.bodies[kRod];
  const Pose pose = scene.state[kRod].pose();
  const Vec3 half = std::get<collision::Box>(scene.colliders.front().shape).half_extents;
  const Vec3 foot = foot_of(pose, half);
  const Vec3 r = pose.position - foot;
  const Velocity before = velocity(body, scene.state[kRod]);
  const double J = body.inertia(1, 1);
  const double pivot = J + body.mass * r.squaredNorm();
  Jam jam;
  jam.spin = (J * before.angular.y() + body.mass * r.cross(before.linear).y()) / pivot;
  const double potential = -body.mass * scene.gravity.dot(pose.position);
  jam.energy = 0.5 * pivot * jam.spin * jam.spin + potential;
  jam.energy_before = 0.5 * body.mass * before.linear.squaredNorm() +
                      0.5 * J * before.angular.squaredNorm() + potential;
  jam.local_foot = pose.inverse() * foot;
  return jam;
}

void check_events(const Track& track, SceneReport& report) {
  const auto is_jam = [](const Event& event) {
    return event.kind == EventKind::kImpactWithoutCollision;
  };
  report.checks.push_back(absolute(
      {.name = "impacts without collision", .unit = "1", .reason = "the jam, and nothing after it"},
      static_cast<double>(std::count_if(track.events.begin(), track.events.end(), is_jam)), 1.0,
      0.0));
  const auto jam = std::find_if(track.events.begin(), track.events.end(), is_jam);
  const bool is_proved =
      jam != track.events.end() && (jam->forces_status == lcp::Status::kInfeasible ||
                                    jam->forces_status == lcp::Status::kNoSolutionBelow);
  report.checks.push_back(absolute({.name = "proofs that no forces exist before the jam",
                                    .reference = "certificate",
                                    .unit = "1",
                                    .reason = "a ray of the forces' problem, judged on its data"},
                                   is_proved ? 1.0 : 0.0, 1.0, 0.0));
}

}  // namespace

/// The foot stops at once; from then on the rod turns about it with constant energy.
void check_painleve_rod(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Runs runs = run_engines(scene, options, report);
  const Jam jam = closed_form(scene);
  runs.for_each([&](const Track& track) {
    const bool ours = track.engine == "signorini";
    // The sample that is farthest from the closed form counts.
    double energy = jam.energy;
    double slid = 0.0;
    for (std::size_t k = 1; k < track.size(); ++k) {
      if (!(std::abs(track.energy(k) - jam.energy) <= std::abs(energy - jam.energy))) {
        energy = track.energy(k);
      }
      const Vec3 foot = track.bodies[k][kRod].pose * jam.local_foot;
      const Vec3 start = track.bodies[0][kRod].pose * jam.local_foot;
      slid = std::max(slid, (foot - start).norm());
    }
    // By time steps: the jam's step moves the foot h |v-| at most; w is that of the pose before the
    // step, and the energy of a rod that turns about its foot moves by (h/2) |g| m |dv|.
    const double dv = 2.0 * std::abs(jam.spin) * std::abs(scene.state[kRod].x.z());
    const bool by_events = ours && !track.events.empty();
    const double energy_bound = by_events ? 1e-6
                                          : 0.5 * track.step * scene.gravity.norm() *
                                                scene.bodies[kRod].mass * dv / jam.energy;
    const double foot_bound = by_events ? 1e-6 : track.step * 2.0;
    const CheckText kept{
        .name = "energy after the jam",
        .engine = track.engine,
        .unit = "J",
        .reason = by_events ? "the jam is exact; segments of motion are good to 1e-9 m each, their "
                              "forces to second order"
                            : "the scheme lets the energy move by (h/2) |g| m |dv|"};
    const CheckText still{.name = "way of the foot",
                          .engine = track.engine,
                          .unit = "m",
                          .reason = by_events ? "it sticks; segments are good to 1e-9 m each"
                                              : "it moves in the step of the jam alone"};
    report.checks.push_back(ours ? relative(kept, energy, jam.energy, energy_bound)
                                 : shown(kept, energy, jam.energy));
    report.checks.push_back(ours ? absolute(still, slid, 0.0, foot_bound)
                                 : shown(still, slid, 0.0));
    if (by_events) check_events(track, report);
  });
  report.plots.push_back(plot_over_time("Spin of the rod", "w about y [rad/s]", runs,
                                        [](const Track& track, std::size_t k) {
                                          return track.bodies[k][kRod].velocity.angular.y();
                                        }));
  report.settings.push_back("closed form: energy " + text(jam.energy_before) +
                            " J before the jam, " + text(jam.energy) +
                            " J after it, w = " + text(jam.spin) + " rad/s");
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
