#include <signorini/validation/bullet_file.h>
#include <signorini/validation/bullet_runner.h>
#include <signorini/validation/bullet_world.h>
#include <signorini/validation/scene_contacts.h>

#include "tools/stopwatch.h"

#include <fmt/format.h>

namespace signorini::validation {
namespace {

State state_of(const std::vector<BodySample>& sample) {
  State state(sample.size());
  for (std::size_t i = 0; i < sample.size(); ++i) {
    state[i].x = sample[i].pose.position;
    state[i].q = sample[i].pose.orientation;
  }
  return state;
}

bool is_finite(const std::vector<BodySample>& sample) {
  for (const BodySample& body : sample) {
    if (!body.pose.position.allFinite() || !body.velocity.linear.allFinite() ||
        !body.velocity.angular.allFinite()) {
      return false;
    }
  }
  return true;
}

}  // namespace

Track run_bullet(const Scene& scene, const BulletProfile& profile, const StopFlag* stop,
                 const StepWatcher& watch) {
#ifdef SIGNORINI_HAS_BULLET_FILES
  if (scene.is_bullet_file) return run_bullet_file(scene, stop);
#endif
  BulletWorld world(scene, profile);
  SceneContacts ruler(scene);
  Track track;
  track.engine = "bullet";
  track.step = scene.step;
  track.remarks.assign(world.remarks().begin(), world.remarks().end());
  const long steps = scene.step_count();
  TrackRecorder recorder(scene.bodies, scene.gravity, steps, track);
  const auto record = [&](double time, std::vector<BodySample> sample) {
    const OverlapMeasure overlap = measure_overlap(ruler, state_of(sample));
    recorder.record(time, std::move(sample), overlap.deepest, overlap.contacts);
  };
  record(0.0, world.sample());
  recorder.record_frame();
  for (long k = 1; k <= steps; ++k) {
    if (stop != nullptr && stop->load()) {
      track.interrupted = true;
      break;
    }
    const tools::Stopwatch stopwatch;
    world.step(scene.step);
    track.wall_seconds += stopwatch.seconds();
    ++track.steps;
    track.solver_seconds = world.solver_seconds();
    if (watch) watch(track.engine, k, steps);
    std::vector<BodySample> sample = world.sample();
    if (!is_finite(sample)) {
      track.broke_down = true;
      break;
    }
    if (recorder.wants(k)) record(static_cast<double>(k) * scene.step, std::move(sample));
    recorder.add_contacts(world.contacts(scene.step));
    if (recorder.wants_frame(k)) recorder.record_frame();
  }
  return track;
}

std::string bullet_version() {
  return fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100);
}

}  // namespace signorini::validation
