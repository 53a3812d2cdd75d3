#include <signorini/validation/track.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

constexpr double kMostBodySamples = 2e6;
constexpr double kMostFrames = 300.0;
constexpr double kMostFrameBodySamples = 5e3;
constexpr double kFewestFrames = 30.0;

/// As a state, so that the energies are core's own.
State to_state(const Bodies& bodies, const std::vector<BodySample>& sample) {
  State state(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    state[i].x = sample[i].pose.position;
    state[i].q = sample[i].pose.orientation;
    set_velocity(bodies[i], sample[i].velocity, state[i]);
  }
  return state;
}

}  // namespace

std::vector<BodySample> sample_of(const Bodies& bodies, const State& state) {
  std::vector<BodySample> sample(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    sample[i] = {state[i].pose(), velocity(bodies[i], state[i])};
  }
  return sample;
}

bool is_finite(const State& state) {
  return std::all_of(state.begin(), state.end(), [](const BodyState& body) {
    return body.x.allFinite() && body.q.coeffs().allFinite() && body.p.allFinite() &&
           body.L.allFinite();
  });
}

double Track::deepest_overlap() const {
  return overlap.empty() ? 0.0 : *std::max_element(overlap.begin(), overlap.end());
}

Vec3 momentum(const Bodies& bodies, const std::vector<BodySample>& sample) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].is_dynamic()) sum += bodies[i].mass * sample[i].velocity.linear;
  }
  return sum;
}

TrackRecorder::TrackRecorder(const Bodies& bodies, const Vec3& gravity, long steps, Track& track)
    : bodies_(bodies),
      gravity_(gravity),
      steps_(steps),
      stride_(recording_stride(steps, bodies.size())),
      frame_stride_(frame_stride(steps, bodies.size())),
      track_(track) {}

void TrackRecorder::record(double time, std::vector<BodySample> sample, double overlap,
                           int contacts) {
  const State state = to_state(bodies_, sample);
  track_.time.push_back(time);
  track_.kinetic.push_back(kinetic_energy(bodies_, state));
  track_.potential.push_back(potential_energy(bodies_, state, gravity_));
  track_.overlap.push_back(overlap);
  track_.contacts.push_back(contacts);
  track_.bodies.push_back(std::move(sample));
}

void TrackRecorder::add_contacts(const std::vector<ContactSample>& contacts) {
  ++steps_since_frame_;
  std::map<std::pair<int, int>, int> count;  // of each pair of bodies, in this step
  for (const ContactSample& contact : contacts) {
    const int k = count[{contact.body_a, contact.body_b}]++;
    const auto [sum, is_new] = sums_.try_emplace({contact.body_a, contact.body_b, k}, contact);
    if (is_new) continue;
    sum->second.point = contact.point;
    sum->second.force += contact.force;
  }
}

void TrackRecorder::record_frame() {
  std::vector<ContactSample> contacts;
  contacts.reserve(sums_.size());
  for (auto& [key, contact] : sums_) {
    contact.force /= static_cast<double>(steps_since_frame_);
    contacts.push_back(contact);
  }
  sums_.clear();
  steps_since_frame_ = 0;
  track_.frames.push_back(track_.size() - 1);
  track_.frame_contacts.push_back(std::move(contacts));
}

long recording_stride(long steps, std::size_t body_count) {
  const double samples = static_cast<double>(steps) * static_cast<double>(body_count);
  return std::max(1L, static_cast<long>(std::ceil(samples / kMostBodySamples)));
}

long frame_stride(long steps, std::size_t body_count) {
  const long stride = recording_stride(steps, body_count);
  const double count = static_cast<double>(std::max<std::size_t>(1, body_count));
  const double frames = std::clamp(kMostFrameBodySamples / count, kFewestFrames, kMostFrames);
  const double records = static_cast<double>(steps) / static_cast<double>(stride);
  return stride * std::max(1L, static_cast<long>(std::ceil(records / frames)));
}

}  // namespace signorini::validation
