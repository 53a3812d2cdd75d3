#include <signorini/validation/scene_contacts.h>
#include <signorini/validation/signorini_runner.h>

#include "tools/stopwatch.h"

#include <algorithm>
#include <fmt/format.h>

namespace signorini::validation {
namespace {

/// Moving bodies up to which the friction pyramid's LCP is solved by pivots, whose time grows as
/// the cube of the rows; above, exact cones by the chain of solvers `auto`.
constexpr int kMostByPivots = 12;

std::vector<ContactSample> contacts_of(const StepReport& report, double step) {
  std::vector<ContactSample> samples(report.contacts.size());
  for (std::size_t c = 0; c < samples.size(); ++c) {
    const Contact& contact = report.contacts[c];
    samples[c] = {contact.body_a, contact.body_b, 0.5 * (contact.point_a + contact.point_b),
                  report.impulses[c] / step};
  }
  return samples;
}

void count_ending(const StepReport& report, double time, Track& track) {
  ++track.endings[std::string(lcp::to_string(report.status))];
  if (report.result.statistics.solve_seconds > 0.0) {
    track.solver_seconds += report.result.statistics.solve_seconds;
  }
  track.projection_energy += report.energy_change_projection;
  for (const Vec3& impulse : report.impulses) track.impulse += impulse.norm();
  for (const Vec3& moment : report.moments) track.impulse += moment.norm();
  for (const JointReport& joint : report.joints) {
    track.impulse += joint.impulse.norm() + joint.moment.norm();
  }
  if (report.projection_status != lcp::Status::kNotRun &&
      !lcp::is_solved(report.projection_status)) {
    ++track.unsolved_projections;
  }
  if (lcp::is_solved(report.status)) return;
  if (track.unsolved_steps++ == 0) {
    track.first_unsolved =
        fmt::format("at t = {:.6g} s: {}, {} contacts, unit-free residual {:.3g}{}{}", time,
                    lcp::to_string(report.status), report.contacts.size(),
                    report.result.certificate.unit_free_residual,
                    report.result.detail.empty() ? "" : "; ", report.result.detail);
  }
}

}  // namespace

TimeStepSettings step_settings(const Scene& scene) {
  TimeStepSettings settings;
  settings.step = scene.step;
  settings.gravity = scene.gravity;
  const auto moving = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                    [](const Body& body) { return body.is_dynamic(); });
  if (moving > kMostByPivots) settings.friction_model = FrictionModel::kCone;
  return settings;
}

Track run_signorini(const Scene& scene, const TimeStepSettings& settings, const StopFlag* stop,
                    const StepWatcher& watch) {
  SceneContacts contacts(scene);
  SceneContacts ruler(scene);
  TimeStepper stepper(scene.bodies, contacts, settings, scene.joints);
  State state = scene.state;
  StepReport report;
  Track track;
  track.engine = "signorini";
  track.step = settings.step;
  track.solver_seconds = 0.0;
  const long steps = scene.step_count();
  TrackRecorder recorder(scene.bodies, scene.gravity, steps, track);
  const auto record = [&](double time) {
    const OverlapMeasure overlap = measure_overlap(ruler, state);
    recorder.record(time, sample_of(scene.bodies, state), overlap.deepest, overlap.contacts);
  };
  record(0.0);
  recorder.record_frame();
  for (long k = 1; k <= steps; ++k) {
    if (stop != nullptr && stop->load()) {
      track.interrupted = true;
      break;
    }
    const tools::Stopwatch stopwatch;
    stepper.step(state, report);
    track.wall_seconds += stopwatch.seconds();
    ++track.steps;
    if (watch) watch(track.engine, k, steps);
    const double time = static_cast<double>(k) * settings.step;
    count_ending(report, time, track);
    if (!is_finite(state)) {
      track.broke_down = true;
      break;
    }
    if (recorder.wants(k)) record(time);
    recorder.add_contacts(contacts_of(report, settings.step));
    if (recorder.wants_frame(k)) recorder.record_frame();
  }
  return track;
}

std::string_view integrator_name(Integrator integrator) {
  switch (integrator) {
    case Integrator::kSemiImplicit: return "semi-implicit";
    case Integrator::kRungeKutta4: return "Runge-Kutta 4";
    case Integrator::kEnergyMomentum: return "energy-momentum";
  }
  return "unknown";
}

std::vector<std::string> describe(const TimeStepSettings& settings) {
  const bool quaternion = settings.orientation == OrientationScheme::kQuaternion;
  const std::string friction = settings.friction_model == FrictionModel::kPyramid
                                   ? fmt::format("pyramid of {} sides", settings.pyramid_sides)
                                   : std::string(to_string(settings.friction_model));
  return {
      fmt::format("Signorini: time stepping, step {:.9g} s, gravity ({:g}, {:g}, {:g}) m/s^2",
                  settings.step, settings.gravity.x(), settings.gravity.y(), settings.gravity.z()),
      fmt::format("Signorini: {} integration, orientation as a {}",
                  integrator_name(settings.integrator),
                  quaternion ? "normalised quaternion" : "matrix with Gram-Schmidt"),
      fmt::format(
          "Signorini: solver {}, tolerance {:g}; friction {}; contact "
          "margin {:g} m; touching below {:g} m; restitution threshold {:g} m/s",
          settings.friction_model == FrictionModel::kCone ? settings.cone_solver : settings.solver,
          settings.lcp.tolerance, friction, settings.margin, settings.touching_tolerance,
          settings.restitution_threshold)};
}

}  // namespace signorini::validation
