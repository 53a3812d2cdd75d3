#include <signorini/validation/event_runner.h>
#include <signorini/validation/scene_contacts.h>

#include "tools/stopwatch.h"

#include <fmt/format.h>

namespace signorini::validation {
namespace {

std::vector<ContactSample> contacts_of(const EventReport& report) {
  std::vector<ContactSample> samples;
  for (std::size_t c = 0; c < report.resting_contacts.size(); ++c) {
    const Contact& contact = report.resting_contacts[c];
    // With friction the forces are vectors, without numbers along the normals.
    const Vec3 force =
        c < report.resting_contact_forces.size()
            ? report.resting_contact_forces[c]
            : (report.resting_forces[static_cast<Eigen::Index>(c)] * contact.normal).eval();
    samples.push_back(
        {contact.body_a, contact.body_b, 0.5 * (contact.point_a + contact.point_b), force});
  }
  return samples;
}

/// @param start of the advance, s
void take_events(const EventReport& report, double start, Track& track) {
  ++track.endings[std::string(lcp::to_string(report.status))];
  track.blind_pairs += report.blind_pairs;
  for (Event event : report.events) {
    event.time += start;
    track.events.push_back(event);
  }
  if (lcp::is_solved(report.status)) return;
  ++track.unsolved_steps;
  track.first_unsolved =
      fmt::format("at t = {:.6g} s: {}{}{}", start + report.time, lcp::to_string(report.status),
                  report.detail.empty() ? "" : "; ", report.detail);
}

}  // namespace

EventSettings event_settings(const Scene& scene) {
  EventSettings settings;
  settings.gravity = scene.gravity;
  return settings;
}

Track run_by_events(const Scene& scene, const EventSettings& settings, const StopFlag* stop,
                    const StepWatcher& watch) {
  SceneContacts contacts(scene);
  SceneContacts ruler(scene);
  EventStepper stepper(scene.bodies, contacts, settings);
  State state = scene.state;
  EventReport report;
  Track track;
  track.engine = "signorini";
  track.step = scene.step;
  const long records = scene.step_count();
  TrackRecorder recorder(scene.bodies, scene.gravity, records, track);
  const auto record = [&](double time) {
    const OverlapMeasure overlap = measure_overlap(ruler, state);
    recorder.record(time, sample_of(scene.bodies, state), overlap.deepest, overlap.contacts);
  };
  record(0.0);
  recorder.record_frame();
  for (long k = 1; k <= records && track.unsolved_steps == 0; ++k) {
    if (stop != nullptr && stop->load()) {
      track.interrupted = true;
      break;
    }
    const double start = static_cast<double>(k - 1) * scene.step;
    const tools::Stopwatch stopwatch;
    stepper.advance(state, scene.step, report);
    track.wall_seconds += stopwatch.seconds();
    ++track.steps;
    if (watch) watch(track.engine, k, records);
    take_events(report, start, track);
    if (!is_finite(state)) {
      track.broke_down = true;
      break;
    }
    const bool is_whole = track.unsolved_steps == 0;
    if (recorder.wants(k) || !is_whole) {
      record(is_whole ? static_cast<double>(k) * scene.step : start + report.time);
    }
    recorder.add_contacts(contacts_of(report));
    if (recorder.wants_frame(k) || !is_whole) recorder.record_frame();
  }
  return track;
}

std::vector<std::string> describe(const EventSettings& settings) {
  return {fmt::format("Signorini: event-driven, gravity ({:g}, {:g}, {:g}) m/s^2",
                      settings.gravity.x(), settings.gravity.y(), settings.gravity.z()),
          fmt::format("Signorini: segments to {:g} m and rad, at most {:g} s; touching below {:g} "
                      "m; slower approaches than {:g} m/s come to rest",
                      settings.tolerance, settings.longest_segment, settings.touching,
                      settings.resting_speed)};
}

}  // namespace signorini::validation
