#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/response/event_stepper.h>

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace signorini::validation {

/// A body at one moment.
struct BodySample {
  Pose pose;
  Velocity velocity;
};

/// A state of ours as a track records it.
[[nodiscard]] std::vector<BodySample> sample_of(const Bodies& bodies, const State& state);
/// Is every number of it finite?
[[nodiscard]] bool is_finite(const State& state);

/// A contact of one step, as the engine solved it.
struct ContactSample {
  int body_a;
  int body_b;
  Vec3 point;  ///< halfway between the two bodies' points, at the start of the step, m
  Vec3 force;  ///< on A, mean over the step, friction included, N
};

/// What a run recorded, whichever engine made it. Sample k is the state at time[k]; sample 0 is the
/// initial state. Energies and overlaps are measured from the poses and velocities by the same
/// code for both engines.
struct Track {
  std::string engine;  ///< "signorini" or "bullet"
  double step = 0.0;   ///< s
  std::vector<double> time;
  std::vector<std::vector<BodySample>> bodies;  ///< [sample][body]
  std::vector<double> kinetic;                  ///< J
  std::vector<double> potential;                ///< J, zero where all bodies are at the origin
  std::vector<double> overlap;                  ///< deepest overlap of the scene, >= 0, m
  std::vector<int> contacts;                    ///< contacts with gap <= 0

  /// The samples that are kept for playback, ascending, and the contacts of the steps that ended
  /// there (the first frame, at the start, has none).
  std::vector<std::size_t> frames;
  std::vector<std::vector<ContactSample>> frame_contacts;

  long steps = 0;                       ///< taken
  std::map<std::string, long> endings;  ///< how the contact problems of the steps ended (ours)
  long unsolved_steps = 0;              ///< steps whose contact problem was not solved
  std::string first_unsolved;           ///< when and why the first of them was not
  std::vector<Event> events;            ///< of the event-driven stepper; times from the start
  int blind_pairs = 0;                  ///< that it passed over, see EventReport
  long unsolved_projections = 0;        ///< position projections that were not solved (ours)
  double impulse = 0.0;  ///< sum of the sizes of all contacts' and joints' impulses (ours), N s
  double projection_energy = 0.0;  ///< sum of the potential energy changes by projection (ours), J
  /// Of the steps alone, measuring and recording apart: wall time, or CPU time where that is less
  /// because others had the processor (tools/stopwatch.h).
  double wall_seconds = 0.0;
  double solver_seconds = -1.0;      ///< of that inside the solver of contacts; -1: not measured
  std::vector<std::string> remarks;  ///< how what was run differs from the scene
  bool interrupted = false;          ///< the run was stopped before its end
  bool broke_down = false;           ///< the run ended because a number was no longer finite

  [[nodiscard]] std::size_t size() const { return time.size(); }
  [[nodiscard]] double energy(std::size_t sample) const {
    return kinetic[sample] + potential[sample];
  }
  [[nodiscard]] const BodySample& last(int body) const { return bodies.back()[body]; }
  /// The deepest overlap of all samples, m.
  [[nodiscard]] double deepest_overlap() const;
};

/// Momentum of the dynamic bodies at a sample, kg m/s.
[[nodiscard]] Vec3 momentum(const Bodies& bodies, const std::vector<BodySample>& sample);

/// Writes what a runner sees into a track: poses and velocities as given, energies from them.
class TrackRecorder {
 public:
  /// Keeps every recording_stride()-th of the steps and, for playback, every frame_stride()-th, and
  /// the last step.
  TrackRecorder(const Bodies& bodies, const Vec3& gravity, long steps, Track& track);
  [[nodiscard]] bool wants(long step) const { return step % stride_ == 0 || step == steps_; }
  void record(double time, std::vector<BodySample> sample, double overlap, int contacts);
  [[nodiscard]] bool wants_frame(long step) const {
    return step % frame_stride_ == 0 || step == steps_;
  }
  /// After each step: what acts between two frames is shown at the second one, so that an impact
  /// between them is seen. The k-th contact of two bodies counts as the same in every step.
  void add_contacts(const std::vector<ContactSample>& contacts);
  /// Keeps the sample recorded last for playback, with the contacts since the frame before: each at
  /// its last point, the mean of its force over these steps.
  void record_frame();

 private:
  const Bodies& bodies_;
  Vec3 gravity_;
  long steps_;
  long stride_;
  long frame_stride_;
  Track& track_;
  long steps_since_frame_ = 0;
  std::map<std::tuple<int, int, int>, ContactSample> sums_;  ///< A, B, k
};

/// The stride that keeps a track within about 2 million body samples.
[[nodiscard]] long recording_stride(long steps, std::size_t body_count);
/// A multiple of it that keeps playback within 300 frames, and 12,000 body samples or 30 frames.
[[nodiscard]] long frame_stride(long steps, std::size_t body_count);

}  // namespace signorini::validation
